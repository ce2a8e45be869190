//! Execution of steps and passes: render passes by the plan's attachments, and draws, dispatches and copies that
//! perform the declared accesses.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use crate::vulkan::device::{Device, Object, Trouble};
use crate::vulkan::memory::{Objects, Thing, known};
use crate::vulkan::pipeline;
use crate::vulkan::shader::{Bound, PassShader, shader};
use crate::vulkan::states::planes;
use ash::vk;
use framegraph::{
    Access, AccessKind, Aspect, Attachment, ClearValue, Desc, Dimension, Join, PassId, PassKind, Plan, Range,
    ResourceId, StepId,
};
use std::collections::BTreeMap;

/// Cached objects of steps and passes.
#[derive(Debug, Default)]
pub struct Works {
    render_passes: BTreeMap<usize, vk::RenderPass>,
    pipelines: BTreeMap<PassId, (pipeline::Pipeline, Vec<Bound>)>,
}

/// Function that returns the current layout of an image's part.
pub trait Layouts: Fn(Thing, u32) -> vk::ImageLayout {}
impl<F: Fn(Thing, u32) -> vk::ImageLayout> Layouts for F {}

impl Works {
    /// Returns true if the step is a render pass.
    pub fn ends(&self, plan: &Plan, step: StepId) -> bool {
        plan.steps()[step.index()].kind == PassKind::Raster
    }

    pub fn begin(
        &mut self,
        device: &Device,
        plan: &Plan,
        objects: &Objects,
        step: StepId,
        commands: vk::CommandBuffer,
        layouts: impl Layouts,
    ) -> Result<(), Trouble> {
        let row = &plan.steps()[step.index()];
        if row.kind != PassKind::Raster {
            return Ok(());
        }
        let attachments = plan.attachments_of(step);
        let (mut views, mut states, mut clears) = (Vec::new(), Vec::new(), Vec::new());
        for attachment in attachments {
            let thing = objects.of(plan, attachment.resource)?;
            let range = range_of(attachment);
            views.push(view(device, plan, objects, attachment.resource, &range, attachment.layers > 1, true)?);
            states.push(layouts(thing, first_part(plan, attachment.resource, &range)));
            clears.push(clear(plan, attachment));
        }
        let pass = match self.render_passes.get(&step.index()) {
            Some(known) => *known,
            None => {
                let made = pipeline::render_pass(device, plan, step, &states)?;
                self.render_passes.insert(step.index(), made);
                made
            }
        };
        let [width, height] = row.extent.map(|side| side.max(1));
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pass)
            .attachments(&views)
            .width(width)
            .height(height)
            .layers(row.layers.max(1));
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        // SAFETY: the views and the render pass are of this device and live until it is cleared.
        unsafe {
            let framebuffer = device.raw.create_framebuffer(&info, None)?;
            device.keep(Object::Framebuffer(framebuffer));
            let info = vk::RenderPassBeginInfo::default()
                .render_pass(pass)
                .framebuffer(framebuffer)
                .render_area(area)
                .clear_values(&clears);
            device.raw.cmd_begin_render_pass(commands, &info, vk::SubpassContents::INLINE);
        }
        Ok(())
    }

    pub fn pass(
        &mut self,
        device: &Device,
        plan: &Plan,
        objects: &Objects,
        (step, pass, join): (usize, PassId, Join),
        commands: vk::CommandBuffer,
        layouts: impl Layouts,
    ) -> Result<(), Trouble> {
        if matches!(join, Join::Resolve | Join::SamePixel) {
            return Err(format!("{} in a step is not replayed", join.word()).into());
        }
        let kind = plan.graph().passes()[pass.index()].kind;
        if kind == PassKind::Copy {
            let accesses = plan.graph().accesses_of(pass).iter();
            return accesses.into_iter().try_for_each(|access| copy(device, plan, objects, access, commands));
        }
        if !self.pipelines.contains_key(&pass) {
            let PassShader { text, bound } = shader(plan, pass)?;
            let render_pass = self.render_passes.get(&step).copied();
            let made = pipeline::pipeline(device, plan, (StepId::at(step), pass), &text, &bound, render_pass)?;
            self.pipelines.insert(pass, (made, bound));
        }
        let (pipeline, bound) = &self.pipelines[&pass];
        let set = self.descriptors(device, plan, objects, pipeline, bound, layouts)?;
        let point = match kind {
            PassKind::Compute => vk::PipelineBindPoint::COMPUTE,
            _ => vk::PipelineBindPoint::GRAPHICS,
        };
        let own = plan.graph().accesses_of(pass);
        let buffer = |kind| own.iter().find(|a| a.kind == kind).map(|a| buffer(plan, objects, a));
        let indirect = buffer(AccessKind::Indirect).transpose()?;
        let (vertices, indices) = (buffer(AccessKind::Vertex).transpose()?, buffer(AccessKind::Index).transpose()?);
        // SAFETY: all that is bound is of this device and lives until it is cleared; `begin` began the render pass.
        unsafe {
            device.raw.cmd_bind_pipeline(commands, point, pipeline.raw);
            device.raw.cmd_bind_descriptor_sets(commands, point, pipeline.layout, 0, &[set], &[]);
            if let Some((buffer, offset, _)) = vertices {
                device.raw.cmd_bind_vertex_buffers(commands, 0, &[buffer], &[offset]);
            }
            if let Some((buffer, offset, _)) = indices {
                device.raw.cmd_bind_index_buffer(commands, buffer, offset, vk::IndexType::UINT32);
            }
            match (kind, indirect, indices) {
                (PassKind::Compute, None, _) => device.raw.cmd_dispatch(commands, 1, 1, 1),
                (PassKind::Compute, Some((buffer, offset, bytes)), _) if bytes >= 12 => {
                    device.raw.cmd_dispatch_indirect(commands, buffer, offset);
                }
                (PassKind::Raster, Some((buffer, offset, bytes)), None) if bytes >= 16 => {
                    device.raw.cmd_draw_indirect(commands, buffer, offset, 1, 16);
                }
                (PassKind::Raster, None, Some(_)) => device.raw.cmd_draw_indexed(commands, 1, 1, 0, 0, 0),
                (PassKind::Raster, None, None) => device.raw.cmd_draw(commands, 3, 1, 0, 0),
                _ => return Err("such an indirect draw is not replayed".into()),
            }
        }
        Ok(())
    }

    fn descriptors(
        &self,
        device: &Device,
        plan: &Plan,
        objects: &Objects,
        pipeline: &pipeline::Pipeline,
        bound: &[Bound],
        layouts: impl Layouts,
    ) -> Result<vk::DescriptorSet, Trouble> {
        let sizes: Vec<_> = bound.iter().map(|b| vk::DescriptorPoolSize { ty: b.kind, descriptor_count: 1 }).collect();
        let sizes = match sizes.is_empty() {
            true => vec![vk::DescriptorPoolSize { ty: vk::DescriptorType::SAMPLED_IMAGE, descriptor_count: 1 }],
            false => sizes,
        };
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: the layout is of this device; the pool is new and has room for one set.
        let set = unsafe {
            let pool = device.raw.create_descriptor_pool(&info, None)?;
            device.keep(Object::Descriptors(pool));
            let layouts = [pipeline.set];
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            device.raw.allocate_descriptor_sets(&info)?[0]
        };
        for (number, row) in (0..).zip(bound) {
            let write = vk::WriteDescriptorSet::default().dst_set(set).dst_binding(number).descriptor_type(row.kind);
            let thing = objects.of(plan, row.resource)?;
            let (mut images, mut buffers) =
                ([vk::DescriptorImageInfo::default()], [vk::DescriptorBufferInfo::default()]);
            let write = match thing {
                Thing::Image(_) => {
                    images[0].image_view = view(device, plan, objects, row.resource, &row.range, row.arrayed, false)?;
                    images[0].image_layout = layouts(thing, first_part(plan, row.resource, &row.range));
                    write.image_info(&images)
                }
                Thing::Buffer(buffer) => {
                    let (offset, range) = bytes_of(plan, row.resource, &row.range);
                    buffers[0] = vk::DescriptorBufferInfo { buffer, offset, range };
                    write.buffer_info(&buffers)
                }
            };
            // SAFETY: the set is new, so no commands use it.
            unsafe { device.raw.update_descriptor_sets(&[write], &[]) };
        }
        Ok(set)
    }
}

fn range_of(attachment: &Attachment) -> Range {
    Range {
        mip: attachment.mip,
        mips: 1,
        layer: attachment.layer,
        layers: attachment.layers,
        view: attachment.view,
        ..Range::ALL
    }
}

fn first_part(plan: &Plan, id: ResourceId, range: &Range) -> u32 {
    let Desc::Texture(desc) = plan.graph().resources()[id.index()].desc else { return 0 };
    u32::from(range.layer) * desc.mip_count(plan.frame()) + u32::from(range.mip)
}

fn bytes_of(plan: &Plan, id: ResourceId, range: &Range) -> (u64, u64) {
    let graph = plan.graph();
    match range.bytes.some() {
        Some(bytes) => {
            let row = graph.byte_ranges()[bytes.index()];
            (row.offset, row.bytes)
        }
        None => (0, graph.resources()[id.index()].desc.bytes(plan.frame()).max(4)),
    }
}

fn buffer(plan: &Plan, objects: &Objects, access: &Access) -> Result<(vk::Buffer, u64, u64), Trouble> {
    let (offset, bytes) = bytes_of(plan, access.resource, &access.range);
    match objects.of(plan, access.resource)? {
        Thing::Buffer(buffer) => Ok((buffer, offset, bytes)),
        Thing::Image(_) => Err("an image is not a buffer".into()),
    }
}

fn clear(plan: &Plan, attachment: &Attachment) -> vk::ClearValue {
    let value = match attachment.clear {
        Attachment::ZERO => None,
        index => plan.graph().clears().get(index as usize),
    };
    match value {
        Some(ClearValue::DepthStencil(depth, stencil)) => {
            vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: *depth, stencil: *stencil } }
        }
        Some(ClearValue::Color(color)) => {
            vk::ClearValue { color: vk::ClearColorValue { float32: color.map(|channel| channel as f32) } }
        }
        _ => vk::ClearValue::default(),
    }
}

/// Creates a view of exactly these parts. Attachments include every plane, sampled views one.
fn view(
    device: &Device,
    plan: &Plan,
    objects: &Objects,
    id: ResourceId,
    range: &Range,
    arrayed: bool,
    attached: bool,
) -> Result<vk::ImageView, Trouble> {
    let (Thing::Image(image), Desc::Texture(desc)) = (objects.of(plan, id)?, plan.graph().resources()[id.index()].desc)
    else {
        return Err("a buffer has no views".into());
    };
    let format = plan.format(id).unwrap_or(desc.format);
    let (mips, layers) = (range.mip_range(desc.mip_count(plan.frame())), range.layer_range(desc.tracked_layers()));
    let kind = match (desc.dimension, arrayed) {
        (Dimension::D3, _) if !attached => vk::ImageViewType::TYPE_3D,
        (_, true) => vk::ImageViewType::TYPE_2D_ARRAY,
        _ => vk::ImageViewType::TYPE_2D,
    };
    let info = vk::ImageViewCreateInfo::default()
        .image(image)
        .view_type(kind)
        .format(known(range.view.unwrap_or(format))?)
        .subresource_range(vk::ImageSubresourceRange {
            aspect_mask: planes(format, if attached { Aspect::All } else { range.aspect }),
            base_mip_level: mips.start,
            level_count: mips.len() as u32,
            base_array_layer: layers.start,
            layer_count: layers.len() as u32,
        });
    // SAFETY: the image is of this device and lives as long.
    let made = unsafe { device.raw.create_image_view(&info, None)? };
    device.keep(Object::View(made));
    Ok(made)
}

/// Copies a pass's sources into a scratch buffer, and fills its destinations.
fn copy(
    device: &Device,
    plan: &Plan,
    objects: &Objects,
    access: &Access,
    commands: vk::CommandBuffer,
) -> Result<(), Trouble> {
    let (id, writes) = (access.resource, access.kind == AccessKind::CopyTarget);
    let resource = &plan.graph().resources()[id.index()];
    let aside = |bytes: u64| -> Result<vk::Buffer, Trouble> {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(vk::BufferUsageFlags::TRANSFER_DST);
        // SAFETY: the buffer is new; its memory is of this device.
        unsafe {
            let made = device.raw.create_buffer(&info, None)?;
            device.keep(Object::Buffer(made));
            let needs = device.raw.get_buffer_memory_requirements(made);
            device.raw.bind_buffer_memory(made, device.allocate(needs.size, needs.memory_type_bits)?, 0)?;
            Ok(made)
        }
    };
    match (objects.of(plan, id)?, resource.desc) {
        (Thing::Buffer(raw), _) => {
            let (offset, bytes) = bytes_of(plan, id, &access.range);
            // SAFETY: the buffers are of this device and have these bytes.
            unsafe {
                match writes {
                    true => device.raw.cmd_fill_buffer(commands, raw, offset, bytes, 0),
                    false => {
                        let region = vk::BufferCopy { src_offset: offset, dst_offset: 0, size: bytes };
                        device.raw.cmd_copy_buffer(commands, raw, aside(bytes)?, &[region]);
                    }
                }
            }
        }
        (Thing::Image(image), Desc::Texture(desc)) => {
            let (mips, layers) =
                (access.range.mip_range(desc.mip_count(plan.frame())), access.range.layer_range(desc.tracked_layers()));
            let aspect = planes(plan.format(id).unwrap_or(desc.format), access.range.aspect);
            let range = vk::ImageSubresourceRange {
                aspect_mask: aspect,
                base_mip_level: mips.start,
                level_count: mips.len() as u32,
                base_array_layer: layers.start,
                layer_count: layers.len() as u32,
            };
            let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            // SAFETY: the image is of this device and has these parts.
            unsafe {
                match (writes, aspect == vk::ImageAspectFlags::COLOR) {
                    (true, true) => {
                        let zero = vk::ClearColorValue::default();
                        device.raw.cmd_clear_color_image(commands, image, target, &zero, &[range]);
                    }
                    (true, false) => {
                        let zero = vk::ClearDepthStencilValue::default();
                        device.raw.cmd_clear_depth_stencil_image(commands, image, target, &zero, &[range]);
                    }
                    (false, _) if desc.samples > 1 => return Err("samples are not copied into buffers".into()),
                    (false, _) => {
                        let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
                        let depth = |mip: u32| match desc.dimension {
                            Dimension::D2 => 1,
                            Dimension::D3 => (u32::from(desc.layers) >> mip).max(1),
                        };
                        let (mut offset, mut regions) = (0, Vec::new());
                        for mip in mips {
                            let [width, height] = desc.mip_extent(plan.frame(), mip);
                            regions.push(vk::BufferImageCopy {
                                buffer_offset: offset,
                                image_subresource: vk::ImageSubresourceLayers {
                                    aspect_mask: aspect,
                                    mip_level: mip,
                                    base_array_layer: layers.start,
                                    layer_count: layers.len() as u32,
                                },
                                image_extent: vk::Extent3D { width, height, depth: depth(mip) },
                                ..Default::default()
                            });
                            let bytes = desc.mip_bytes(plan.frame(), mip) * layers.len() as u64;
                            offset = (offset + bytes * u64::from(depth(mip))).next_multiple_of(16);
                        }
                        device.raw.cmd_copy_image_to_buffer(commands, image, source, aside(offset)?, &regions);
                    }
                }
            }
        }
        _ => return Err("a texture is no buffer".into()),
    }
    Ok(())
}
