//! Filling resources outside of the passes that use them: a storage texture or buffer that a pass declares as cleared.

use super::error::ExecuteError;
use super::realize::{Physical, Realized};
use super::views::{ViewCache, ViewShape};
use framegraph::{Access, AccessKind, Aspect, ClearValue, Dimension, Format, Join, Mode, Plan, Range, StepId};
use wgpu::{
    Color, CommandEncoder, Features, ImageSubresourceRange, LoadOp, Operations, RenderPassColorAttachment,
    RenderPassDepthStencilAttachment, RenderPassDescriptor, StoreOp, TextureUsages, TextureView,
};

/// Clears everything that the passes of `step` declare as cleared and do not attach, before the step is opened.
///
/// # Errors
/// When the device has no way to fill a texture with the value.
pub(crate) fn clear_stored(
    plan: &Plan,
    step: StepId,
    realized: &Realized,
    views: &mut ViewCache,
    encoder: &mut CommandEncoder,
    features: Features,
) -> Result<(), ExecuteError> {
    let graph = plan.graph();
    for member in plan.passes_of(step).iter().filter(|m| m.join != Join::Inlined) {
        let stored = |a: &&Access| matches!(a.kind, AccessKind::StorageWrite | AccessKind::CopyTarget);
        for access in graph.accesses_of(member.pass).iter().filter(stored).filter(|a| a.mode == Mode::Clear) {
            let value = graph.clears().get(access.clear as usize).copied().unwrap_or(ClearValue::Zero);
            let filled = match realized.get(access.resource) {
                Physical::Buffer { buffer, bytes } => {
                    let zero = is_zero(value);
                    if zero {
                        encoder.clear_buffer(buffer, 0, Some(bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT)));
                    }
                    zero
                }
                Physical::Texture { .. } => fill_texture(plan, access, value, realized, views, encoder, features),
                Physical::Absent(_) => true,
            };
            if !filled {
                return Err(ExecuteError::Clear { resource: graph.resource_name(access.resource).to_owned() });
            }
        }
    }
    Ok(())
}

/// All bits zero; for a color the fourth channel too.
fn is_zero(value: ClearValue) -> bool {
    match value {
        ClearValue::Zero => true,
        ClearValue::Color(c) => c.iter().all(|x| x.to_bits() == 0),
        ClearValue::DepthStencil(d, s) => d.to_bits() == 0 && s == 0,
    }
}

/// Fills the range of `access`, with a render pass for each level and layer, or with wgpu's own clear where the value is
/// zero. Returns false when neither can.
fn fill_texture(
    plan: &Plan,
    access: &Access,
    value: ClearValue,
    realized: &Realized,
    views: &mut ViewCache,
    encoder: &mut CommandEncoder,
    features: Features,
) -> bool {
    let Physical::Texture { texture, shape, .. } = realized.get(access.resource) else {
        return false;
    };
    let layers = access.range.layer_range(if shape.dimension == Dimension::D3 { 1 } else { shape.size[2] });
    let mips = access.range.mip_range(shape.mips);
    let format = plan.format(access.resource).unwrap_or(shape.format);
    // wgpu's own clear takes both planes whatever it is asked for.
    let whole = format.planes() == 1 || access.range.aspect == Aspect::All;
    if whole && is_zero(value) && features.contains(Features::CLEAR_TEXTURE) {
        let range = ImageSubresourceRange {
            aspect: wgpu::TextureAspect::All,
            base_mip_level: mips.start,
            mip_level_count: Some(mips.len() as u32),
            base_array_layer: layers.start,
            array_layer_count: Some(layers.len() as u32),
        };
        encoder.clear_texture(texture, &range);
        return true;
    }
    let attachable = shape.usage.contains(TextureUsages::RENDER_ATTACHMENT) && shape.dimension == Dimension::D2;
    if !attachable {
        return false;
    }
    for (mip, layer) in mips.flat_map(|mip| layers.clone().map(move |layer| (mip, layer))) {
        let range = Range { mip: mip as u8, mips: 1, layer: layer as u16, layers: 1, ..Range::ALL };
        let part = ViewShape::new(format, shape.dimension, range, (shape.mips, shape.size[2]), true);
        let view = views.get(texture, part.used_as(TextureUsages::RENDER_ATTACHMENT));
        fill_view(&view, format, access.range.aspect, value, encoder);
    }
    true
}

/// Fills the planes of one level of one layer with a render pass; a plane without operations stays as it is.
fn fill_view(view: &TextureView, format: Format, aspect: Aspect, value: ClearValue, encoder: &mut CommandEncoder) {
    let (depth, stencil) = match value {
        ClearValue::DepthStencil(depth, stencil) => (depth, stencil),
        ClearValue::Zero | ClearValue::Color(_) => (0.0, 0),
    };
    let color = match value {
        ClearValue::Color([r, g, b, a]) => Color { r, g, b, a },
        ClearValue::Zero | ClearValue::DepthStencil(..) => Color::TRANSPARENT,
    };
    let color = RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops: cleared(color) };
    let planes = RenderPassDepthStencilAttachment {
        view,
        depth_ops: (format.has_depth() && aspect != Aspect::Stencil).then_some(cleared(depth)),
        stencil_ops: (format.has_stencil() && aspect != Aspect::Depth).then_some(cleared(stencil)),
    };
    let (colors, is_depth) = ([Some(color)], format.is_depth_stencil());
    drop(encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("fill"),
        color_attachments: if is_depth { &[] } else { &colors },
        depth_stencil_attachment: is_depth.then_some(planes),
        ..Default::default()
    }));
}

const fn cleared<V>(value: V) -> Operations<V> {
    Operations { load: LoadOp::Clear(value), store: StoreOp::Store }
}
