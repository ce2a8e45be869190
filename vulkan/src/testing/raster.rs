//! Raster pipelines.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::draw::{DepthTest, Draw};
use crate::cx::Cx;
use ash::vk;

/// Creates the pipeline of a draw, for the subpass that `cx` records.
pub(super) fn raster(
    raw: &ash::Device,
    cx: &Cx<'_>,
    draw: &Draw<'_>,
    module: vk::ShaderModule,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline, vk::Result> {
    let stage = |stage, name| vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(name);
    let mut stages = vec![stage(vk::ShaderStageFlags::VERTEX, c"vs_main")];
    if draw.has_fragment {
        stages.push(stage(vk::ShaderStageFlags::FRAGMENT, c"fs_main"));
    }
    let input = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(cx.samples());
    let DepthTest { compare, write, stencil, stencil_write, .. } = draw.depth;
    let replace = if stencil_write { vk::StencilOp::REPLACE } else { vk::StencilOp::KEEP };
    let face = vk::StencilOpState {
        pass_op: replace,
        compare_op: stencil.unwrap_or(vk::CompareOp::ALWAYS),
        compare_mask: 0xFF,
        write_mask: if stencil_write { 0xFF } else { 0 },
        ..Default::default()
    };
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(write || compare != vk::CompareOp::ALWAYS)
        .depth_write_enable(write)
        .depth_compare_op(compare)
        .stencil_test_enable(stencil.is_some() || stencil_write)
        .front(face)
        .back(face);
    let blends: Vec<_> = (0..cx.color_slots())
        .map(|slot| {
            let written = draw.slots & (1 << slot) != 0;
            let mask = if written { vk::ColorComponentFlags::RGBA } else { vk::ColorComponentFlags::empty() };
            vk::PipelineColorBlendAttachmentState::default().color_write_mask(mask)
        })
        .collect();
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR, vk::DynamicState::STENCIL_REFERENCE];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&rasterization)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .render_pass(cx.render_pass())
        .subpass(cx.subpass());
    // SAFETY: the module has the entry points, every structure lives as long as the call, and the render pass is alive.
    let made = unsafe { raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    Ok(made.map_err(|(_, error)| error)?[0])
}
