//! Pipelines and descriptor sets from WGSL, for recorders of examples and tests.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::draw::{Bound, DepthTest, Dispatch, Draw};
use super::raster::raster;
use super::spirv::{InputAttachment, spirv};
use crate::cx::{BoundImage, Cx, RecordError};
use crate::driver::{Dependencies, Driver, Object, Scope};
use crate::error::Error;
use crate::gpu::Gpu;
use ash::vk;
use std::collections::BTreeMap;

/// Identity of a pipeline.
type Key = (String, vk::RenderPass, u32, Vec<vk::DescriptorType>, Vec<InputAttachment>, u32, DepthTest, bool);

#[derive(Clone, Copy)]
struct Pipeline {
    raw: vk::Pipeline,
    layout: vk::PipelineLayout,
    set: vk::DescriptorSetLayout,
}

/// Objects that recorders create. Everything lives until [`Kit::reset`] or until the kit is dropped.
pub struct Kit {
    pub(super) gpu: Gpu,
    pub(super) objects: Vec<Object>,
    pub(super) mapped: Vec<(vk::Buffer, vk::DeviceMemory)>,
    pipelines: BTreeMap<Key, Pipeline>,
    modules: BTreeMap<(String, Vec<InputAttachment>), vk::ShaderModule>,
    pools: Vec<vk::DescriptorPool>,
}

impl Kit {
    /// Creates an empty kit.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            gpu: gpu.clone(),
            objects: Vec::new(),
            mapped: Vec::new(),
            pipelines: BTreeMap::new(),
            modules: BTreeMap::new(),
            pools: Vec::new(),
        }
    }

    /// Waits for the device and destroys everything except shader modules. Call it before another plan is prepared:
    /// pipelines belong to the render passes of the earlier plan.
    pub fn reset(&mut self) {
        let driver = &self.gpu.shared.driver;
        // SAFETY: the device has finished, objects belong to it, and each is destroyed once.
        unsafe {
            // After a lost device, everything counts as finished.
            let _ = driver.raw.device_wait_idle();
            for pool in self.pools.drain(..) {
                driver.raw.destroy_descriptor_pool(pool, None);
            }
            for pipeline in std::mem::take(&mut self.pipelines).into_values() {
                driver.raw.destroy_pipeline(pipeline.raw, None);
                driver.raw.destroy_pipeline_layout(pipeline.layout, None);
                driver.raw.destroy_descriptor_set_layout(pipeline.set, None);
            }
        }
        self.mapped.clear();
        self.objects.drain(..).rev().for_each(|object| driver.destroy(object));
    }

    /// Records a draw.
    ///
    /// # Errors
    /// Fails if the source does not compile or the device is out of memory.
    pub fn draw(&mut self, cx: &Cx<'_>, draw: &Draw<'_>) -> Result<(), RecordError> {
        let pipeline = self.pipeline(cx, draw.wgsl, draw.bindings, Some(draw))?;
        let set = self.descriptors(&pipeline, draw.bindings)?;
        let (raw, commands) = (cx.device(), cx.commands());
        let point = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: everything bound belongs to the device and lives until `reset`; the executor began the render pass.
        unsafe {
            raw.cmd_bind_pipeline(commands, point, pipeline.raw);
            raw.cmd_bind_descriptor_sets(commands, point, pipeline.layout, 0, &[set], &[]);
            raw.cmd_set_stencil_reference(commands, vk::StencilFaceFlags::FRONT_AND_BACK, draw.depth.reference);
            match draw.indirect {
                Some(arguments) => raw.cmd_draw_indirect(commands, arguments.buffer, arguments.offset, 1, 16),
                None => raw.cmd_draw(commands, draw.vertices, 1, 0, 0),
            }
        }
        Ok(())
    }

    /// Records a dispatch.
    ///
    /// # Errors
    /// Fails if the source does not compile or the device is out of memory.
    pub fn dispatch(&mut self, cx: &Cx<'_>, dispatch: &Dispatch<'_>) -> Result<(), RecordError> {
        let pipeline = self.pipeline(cx, dispatch.wgsl, dispatch.bindings, None)?;
        let set = self.descriptors(&pipeline, dispatch.bindings)?;
        let (raw, commands) = (cx.device(), cx.commands());
        let point = vk::PipelineBindPoint::COMPUTE;
        let [x, y, z] = dispatch.groups;
        // SAFETY: everything bound belongs to the device and lives until `reset`; no render pass is open.
        unsafe {
            raw.cmd_bind_pipeline(commands, point, pipeline.raw);
            raw.cmd_bind_descriptor_sets(commands, point, pipeline.layout, 0, &[set], &[]);
            match dispatch.indirect {
                Some(arguments) => raw.cmd_dispatch_indirect(commands, arguments.buffer, arguments.offset),
                None => raw.cmd_dispatch(commands, x, y, z),
            }
        }
        Ok(())
    }

    /// Records commands, submits them to the first queue, and waits. The CPU can then read what they wrote.
    pub(super) fn once(&mut self, record: impl FnOnce(&Driver, vk::CommandBuffer)) -> Result<(), Error> {
        let (driver, queue) = (&self.gpu.shared.driver, self.gpu.shared.queues[0]);
        let pool = driver.command_pool(queue.family)?;
        self.objects.push(Object::CommandPool(pool));
        let commands = driver.begin_commands(pool)?;
        record(driver, commands);
        driver.barriers(commands, &Dependencies { memory: vec![Scope::TO_HOST], ..Dependencies::default() });
        driver.end_commands(commands)?;
        let buffers = [commands];
        let info = vk::SubmitInfo::default().command_buffers(&buffers);
        // SAFETY: the commands are complete, and the queue is used by this thread only (`Gpu::new`).
        unsafe {
            driver.raw.queue_submit(queue.raw, &[info], vk::Fence::null()).map_err(Error::of("a submission"))?;
            driver.raw.queue_wait_idle(queue.raw).map_err(Error::of("waiting for the GPU"))
        }
    }

    fn module(&mut self, wgsl: &str, inputs: &[InputAttachment]) -> Result<vk::ShaderModule, RecordError> {
        if let Some(module) = self.modules.get(&(wgsl.to_owned(), inputs.to_vec())) {
            return Ok(*module);
        }
        let words = spirv(wgsl, inputs)?;
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the words are valid SPIR-V: naga validated the source, and `with_inputs` keeps types consistent.
        let module = unsafe { self.gpu.shared.driver.raw.create_shader_module(&info, None)? };
        self.modules.insert((wgsl.to_owned(), inputs.to_vec()), module);
        Ok(module)
    }

    fn pipeline(
        &mut self,
        cx: &Cx<'_>,
        wgsl: &str,
        bindings: &[Bound],
        draw: Option<&Draw<'_>>,
    ) -> Result<Pipeline, RecordError> {
        let kinds: Vec<_> = bindings.iter().map(Bound::kind).collect();
        let input = |(binding, bound): (u32, &Bound)| match bound {
            Bound::Texture(BoundImage { input: Some(index), .. }) => Some(InputAttachment { binding, index: *index }),
            _ => None,
        };
        let inputs: Vec<_> = (0..).zip(bindings).filter_map(input).collect();
        let (depth, slots) = draw.map_or((DepthTest::NONE, 0), |draw| (draw.depth, draw.slots));
        let static_depth = DepthTest { reference: 0, ..depth };
        let fragment = draw.is_some_and(|draw| draw.has_fragment);
        let key: Key = (
            wgsl.to_owned(),
            cx.render_pass(),
            cx.subpass(),
            kinds.clone(),
            inputs.clone(),
            slots,
            static_depth,
            fragment,
        );
        if let Some(known) = self.pipelines.get(&key) {
            return Ok(*known);
        }
        let module = self.module(wgsl, &inputs)?;
        let rows: Vec<_> = (0..)
            .zip(&kinds)
            .map(|(number, kind)| {
                // Input attachments exist in fragment shaders only.
                let stages = match (draw.is_some(), *kind) {
                    (false, _) => vk::ShaderStageFlags::COMPUTE,
                    (true, vk::DescriptorType::INPUT_ATTACHMENT) => vk::ShaderStageFlags::FRAGMENT,
                    (true, _) => vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT,
                };
                let row = vk::DescriptorSetLayoutBinding::default().binding(number).descriptor_type(*kind);
                row.descriptor_count(1).stage_flags(stages)
            })
            .collect();
        let raw = &self.gpu.shared.driver.raw;
        // SAFETY: every structure lives as long as the call that reads it. What is created is kept until `reset`.
        let made = unsafe {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&rows);
            let set = raw.create_descriptor_set_layout(&info, None)?;
            let sets = [set];
            let layout =
                raw.create_pipeline_layout(&vk::PipelineLayoutCreateInfo::default().set_layouts(&sets), None)?;
            let made = match draw {
                Some(draw) => raster(raw, cx, draw, module, layout)?,
                None => {
                    let stage = vk::PipelineShaderStageCreateInfo::default()
                        .stage(vk::ShaderStageFlags::COMPUTE)
                        .module(module)
                        .name(c"main");
                    let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
                    let made = raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
                    made.map_err(|(_, error)| error)?[0]
                }
            };
            Pipeline { raw: made, layout, set }
        };
        self.pipelines.insert(key, made);
        Ok(made)
    }

    fn descriptors(&mut self, pipeline: &Pipeline, bindings: &[Bound]) -> Result<vk::DescriptorSet, RecordError> {
        let mut sizes: Vec<_> =
            bindings.iter().map(|b| vk::DescriptorPoolSize { ty: b.kind(), descriptor_count: 1 }).collect();
        sizes.push(vk::DescriptorPoolSize { ty: vk::DescriptorType::SAMPLED_IMAGE, descriptor_count: 1 });
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        let raw = &self.gpu.shared.driver.raw;
        // SAFETY: the layout belongs to the device, and the new pool has room for one set of it.
        let (pool, set) = unsafe {
            let pool = raw.create_descriptor_pool(&info, None)?;
            let layouts = [pipeline.set];
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            (pool, raw.allocate_descriptor_sets(&info)?[0])
        };
        self.pools.push(pool);
        for (number, bound) in (0..).zip(bindings) {
            let (mut images, mut buffers) =
                ([vk::DescriptorImageInfo::default()], [vk::DescriptorBufferInfo::default()]);
            let write =
                vk::WriteDescriptorSet::default().dst_set(set).dst_binding(number).descriptor_type(bound.kind());
            let write = match bound {
                Bound::Texture(image) | Bound::Storage(image) => {
                    images[0] = vk::DescriptorImageInfo::default().image_view(image.view).image_layout(image.layout);
                    write.image_info(&images)
                }
                Bound::Buffer(part) | Bound::Uniform(part) => {
                    buffers[0] =
                        vk::DescriptorBufferInfo { buffer: part.buffer, offset: part.offset, range: part.bytes };
                    write.buffer_info(&buffers)
                }
            };
            // SAFETY: no command uses the new set, and the views and buffers belong to the device.
            unsafe { raw.update_descriptor_sets(&[write], &[]) };
        }
        Ok(set)
    }
}

impl Drop for Kit {
    fn drop(&mut self) {
        self.reset();
        for module in std::mem::take(&mut self.modules).into_values() {
            // SAFETY: pipelines are destroyed; each module is destroyed once.
            unsafe { self.gpu.shared.driver.raw.destroy_shader_module(module, None) };
        }
    }
}
