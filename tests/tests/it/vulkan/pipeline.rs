//! Render passes of steps and pipelines of passes.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use crate::vulkan::device::{Device, Object, Trouble};
use crate::vulkan::memory::known;
use crate::vulkan::shader::{Bound, spirv};
use crate::vulkan::states::{color_slot, load, planes, store};
use ash::vk;
use framegraph::{AccessKind, Aspect, PassId, PassKind, Plan, Role, StepId};

/// A pipeline with its layouts.
#[derive(Clone, Copy, Debug)]
pub struct Pipeline {
    pub raw: vk::Pipeline,
    pub layout: vk::PipelineLayout,
    pub set: vk::DescriptorSetLayout,
}

/// Creates the render pass of a step. Attachments keep these layouts before, in and after it, since only the stream's
/// barriers change them.
pub fn render_pass(
    device: &Device,
    plan: &Plan,
    step: StepId,
    layouts: &[vk::ImageLayout],
) -> Result<vk::RenderPass, Trouble> {
    let attachments = plan.attachments_of(step);
    let slots = attachments.iter().filter_map(|a| color_slot(a.role)).max().map_or(0, |slot| usize::from(slot) + 1);
    let unused = vk::AttachmentReference2::default().attachment(vk::ATTACHMENT_UNUSED);
    let (mut colors, mut resolves) = (vec![unused; slots], vec![unused; slots]);
    let (mut depth, mut resolved_depth) = (None, None);
    let mut rows = Vec::new();
    for ((index, attachment), layout) in (0..).zip(attachments).zip(layouts) {
        let resource = attachment.resource;
        let desc = plan.graph().resources()[resource.index()].desc;
        let desc = desc.texture().ok_or("a buffer is attached")?;
        let format = plan.format(resource).unwrap_or(desc.format);
        let aspect = planes(format, Aspect::All);
        rows.push(
            vk::AttachmentDescription2::default()
                .format(known(attachment.view.unwrap_or(format))?)
                .samples(vk::SampleCountFlags::from_raw(desc.samples.into()))
                .load_op(load(attachment.load))
                .store_op(store(attachment.store))
                .stencil_load_op(load(attachment.stencil_load))
                .stencil_store_op(store(attachment.stencil_store))
                .initial_layout(*layout)
                .final_layout(*layout),
        );
        let reference = vk::AttachmentReference2::default().attachment(index).layout(*layout).aspect_mask(aspect);
        match attachment.role {
            Role::Color(slot) => colors[usize::from(slot)] = reference,
            Role::ResolveTarget(slot, _) => resolves[usize::from(slot)] = reference,
            Role::Depth | Role::DepthReadOnly => depth = Some(reference),
            Role::ResolveDepth(_) => resolved_depth = Some(reference),
        }
    }
    let mut resolve = vk::SubpassDescriptionDepthStencilResolve::default()
        .depth_resolve_mode(vk::ResolveModeFlags::SAMPLE_ZERO)
        .stencil_resolve_mode(vk::ResolveModeFlags::NONE);
    let mut subpass = vk::SubpassDescription2::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colors)
        .resolve_attachments(&resolves);
    if let Some(depth) = &depth {
        subpass = subpass.depth_stencil_attachment(depth);
    }
    if let Some(target) = &resolved_depth {
        resolve = resolve.depth_stencil_resolve_attachment(target);
        subpass = subpass.push_next(&mut resolve);
    }
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo2::default().attachments(&rows).subpasses(&subpasses);
    // SAFETY: every structure lives as long as the call.
    let made = unsafe { device.raw.create_render_pass2(&info, None)? };
    device.keep(Object::RenderPass(made));
    Ok(made)
}

/// Creates the pipeline of a pass; raster passes use the render pass of their step.
pub fn pipeline(
    device: &Device,
    plan: &Plan,
    (step, pass): (StepId, PassId),
    text: &str,
    bound: &[Bound],
    render_pass: Option<vk::RenderPass>,
) -> Result<Pipeline, Trouble> {
    let words = spirv(text)?;
    let stages = vk::ShaderStageFlags::ALL_GRAPHICS | vk::ShaderStageFlags::COMPUTE;
    let binding = |(number, row): (u32, &Bound)| {
        let one = vk::DescriptorSetLayoutBinding::default().binding(number).descriptor_type(row.kind);
        one.descriptor_count(1).stage_flags(stages)
    };
    let bindings: Vec<_> = (0..).zip(bound).map(binding).collect();
    // SAFETY: every structure lives as long as the call that reads it, and what is made is kept until the device is cleared.
    unsafe {
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        let module = device.raw.create_shader_module(&info, None)?;
        device.keep(Object::Module(module));
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let set = device.raw.create_descriptor_set_layout(&info, None)?;
        device.keep(Object::SetLayout(set));
        let sets = [set];
        let layout =
            device.raw.create_pipeline_layout(&vk::PipelineLayoutCreateInfo::default().set_layouts(&sets), None)?;
        device.keep(Object::Layout(layout));
        let raw = match (plan.graph().passes()[pass.index()].kind, render_pass) {
            (PassKind::Raster, Some(render_pass)) => raster(device, plan, (step, pass), module, layout, render_pass)?,
            _ => {
                let stage = vk::PipelineShaderStageCreateInfo::default()
                    .stage(vk::ShaderStageFlags::COMPUTE)
                    .module(module)
                    .name(c"main");
                let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
                let made = device.raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
                made.map_err(|(_, error)| error)?[0]
            }
        };
        device.keep(Object::Pipeline(raw));
        Ok(Pipeline { raw, layout, set })
    }
}

fn raster(
    device: &Device,
    plan: &Plan,
    (step, pass): (StepId, PassId),
    module: vk::ShaderModule,
    layout: vk::PipelineLayout,
    render_pass: vk::RenderPass,
) -> Result<vk::Pipeline, Trouble> {
    let own = plan.graph().accesses_of(pass);
    let of = |kind| own.iter().any(|a| a.kind == kind);
    let stage = |stage, name| vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(name);
    let stages = [stage(vk::ShaderStageFlags::VERTEX, c"vs"), stage(vk::ShaderStageFlags::FRAGMENT, c"fs")];
    let bindings = [vk::VertexInputBindingDescription { binding: 0, stride: 4, ..Default::default() }];
    let attributes = [vk::VertexInputAttributeDescription { format: vk::Format::R32_SFLOAT, ..Default::default() }];
    let mut input = vk::PipelineVertexInputStateCreateInfo::default();
    if of(AccessKind::Vertex) {
        input = input.vertex_binding_descriptions(&bindings).vertex_attribute_descriptions(&attributes);
    }
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    // A few texels, since synchronization does not depend on their number.
    let side = 4;
    let viewports = [vk::Viewport { width: side as f32, height: side as f32, max_depth: 1.0, ..Default::default() }];
    let scissors = [vk::Rect2D { extent: vk::Extent2D { width: side, height: side }, ..Default::default() }];
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewports(&viewports).scissors(&scissors);
    let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let samples = vk::SampleCountFlags::from_raw(plan.steps()[step.index()].samples.max(1).into());
    let multisample = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(samples);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(of(AccessKind::Depth) || of(AccessKind::DepthReadOnly))
        .depth_write_enable(of(AccessKind::Depth))
        .depth_compare_op(vk::CompareOp::GREATER_OR_EQUAL);
    let attachments = plan.attachments_of(step);
    let slots = attachments.iter().filter_map(|a| color_slot(a.role)).max().map_or(0, |slot| slot + 1);
    let blends: Vec<_> = (0..slots)
        .map(|slot| {
            let written = own.iter().any(|a| a.kind == AccessKind::Color && a.slot == slot);
            let mask = if written { vk::ColorComponentFlags::RGBA } else { vk::ColorComponentFlags::empty() };
            vk::PipelineColorBlendAttachmentState::default().color_write_mask(mask)
        })
        .collect();
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&rasterization)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .layout(layout)
        .render_pass(render_pass);
    // SAFETY: the module has both entry points, and every structure lives as long as the call.
    let made = unsafe { device.raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    Ok(made.map_err(|(_, error)| error)?[0])
}
