//! Finding reads of what nobody wrote: contents that may be anything are made loud.
//!
//! With [`ExecutorOptions::poison`](super::ExecutorOptions), an attachment that starts with don't-care contents is filled
//! first, and one whose contents are dropped is filled after its step: with NaN where the format can hold it, magenta
//! where it holds colors, and half-way values for depth and stencil. A frame whose passes keep their promises, and whose
//! plan is right, looks the same with and without. What lives in the tile alone is filled at its start only; storage
//! textures and buffers are left alone.

use super::attachments::Attached;
use super::realize::{Physical, Realized};
use super::views::{ViewCache, ViewShape};
use framegraph::{Aspect, Attachment, Format, Numeric, Plan, Range, StepId, StoreOp};
use wgpu::{Color, CommandEncoder, LoadOp, Operations, RenderPassDescriptor, TextureUsages};

/// A depth that is neither the near plane nor the far one.
const DEPTH: f32 = 0.5;
/// Every other bit.
const STENCIL: u32 = 0xAA;

/// What a color format is filled with.
fn color(format: Format) -> Color {
    use Format::*;
    match format.numeric() {
        Numeric::Uint | Numeric::Sint => Color { r: 85.0, g: 85.0, b: 85.0, a: 85.0 },
        _ if matches!(
            format,
            R16Float | Rg16Float | Rgba16Float | R32Float | Rg32Float | Rgba32Float | Rg11b10Ufloat
        ) =>
        {
            Color { r: f64::NAN, g: f64::NAN, b: f64::NAN, a: f64::NAN }
        }
        _ => Color { r: 1.0, g: 0.0, b: 1.0, a: 1.0 },
    }
}

fn fill<V>(ops: &mut Operations<V>, value: V) {
    if matches!(ops.load, LoadOp::DontCare(_)) {
        ops.load = LoadOp::Clear(value);
    }
}

/// Fills don't-care contents at the start of the step.
pub(crate) fn at_start(attached: &mut Attached, plan: &Plan, step: StepId) {
    let formats = super::targets::Targets::of(plan, step).colors;
    for (target, format) in attached.colors.iter_mut().zip(formats) {
        if let (Some(target), Some(format)) = (target, format) {
            fill(&mut target.ops, color(format));
        }
    }
    if let Some(depth) = &mut attached.depth {
        depth.depth.iter_mut().for_each(|ops| fill(ops, DEPTH));
        depth.stencil.iter_mut().for_each(|ops| fill(ops, STENCIL));
    }
}

/// Fills dropped contents after the step.
pub(crate) fn at_end(
    plan: &Plan,
    step: StepId,
    realized: &Realized,
    views: &mut ViewCache,
    encoder: &mut CommandEncoder,
) {
    for attachment in plan.attachments_of(step) {
        let Physical::Texture { texture, shape, .. } = realized.get(attachment.resource) else {
            continue;
        };
        if shape.is_memoryless() {
            continue;
        }
        let format = plan.format(attachment.resource).unwrap_or(shape.format);
        // A plane is dropped alone, beside one that is stored or that no pass touches.
        let drops = |aspect| attachment.ops(format, aspect).is_some_and(|(_, store)| store == StoreOp::Discard);
        let is_depth = format.is_depth_stencil();
        let (depth, stencil) = (drops(Aspect::Depth), drops(Aspect::Stencil));
        if !(depth || stencil || !is_depth && drops(Aspect::All)) {
            continue;
        }
        let Attachment { mip, layer, layers, .. } = *attachment;
        let range = Range { mip, mips: 1, layer, layers, aspect: Aspect::All };
        let part = ViewShape::new(format, shape.dimension, range, (shape.mips, shape.size[2]), true);
        let view = views.get(texture, part.used_as(TextureUsages::RENDER_ATTACHMENT));
        let store = wgpu::StoreOp::Store;
        let color = wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: (shape.dimension == framegraph::Dimension::D3).then_some(0),
            resolve_target: None,
            ops: Operations { load: LoadOp::Clear(color(format)), store },
        };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: depth.then_some(Operations { load: LoadOp::Clear(DEPTH), store }),
            stencil_ops: stencil.then_some(Operations { load: LoadOp::Clear(STENCIL), store }),
        };
        let colors = [Some(color)];
        drop(encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("poison"),
            color_attachments: if is_depth { &[] } else { &colors },
            depth_stencil_attachment: is_depth.then_some(depth),
            ..Default::default()
        }));
    }
}
