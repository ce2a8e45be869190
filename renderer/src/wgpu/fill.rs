//! Filling resources outside of the passes that use them: a storage texture or buffer that a pass declares as cleared.

use super::error::ExecuteError;
use super::realize::{Physical, Realized};
use super::views::{ViewCache, ViewShape};
use framegraph::{Access, AccessKind, ClearValue, Dimension, Join, Mode, Plan, Range, StepId};
use wgpu::{CommandEncoder, Features, ImageSubresourceRange, TextureUsages};

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
    if is_zero(value) && features.contains(Features::CLEAR_TEXTURE) {
        let whole = ImageSubresourceRange {
            aspect: wgpu::TextureAspect::All,
            base_mip_level: mips.start,
            mip_level_count: Some(mips.len() as u32),
            base_array_layer: layers.start,
            array_layer_count: Some(layers.len() as u32),
        };
        encoder.clear_texture(texture, &whole);
        return true;
    }
    let attachable = shape.usage.contains(TextureUsages::RENDER_ATTACHMENT) && shape.dimension == Dimension::D2;
    let color = match value {
        ClearValue::Color([r, g, b, a]) => wgpu::Color { r, g, b, a },
        ClearValue::Zero | ClearValue::DepthStencil(..) => wgpu::Color::TRANSPARENT,
    };
    if !attachable || shape.format.is_depth_stencil() {
        return false;
    }
    let format = plan.format(access.resource).unwrap_or(shape.format);
    for (mip, layer) in mips.flat_map(|mip| layers.clone().map(move |layer| (mip, layer))) {
        let range = Range { mip: mip as u8, mips: 1, layer: layer as u16, layers: 1, ..Range::ALL };
        let part = ViewShape::new(format, shape.dimension, range, (shape.mips, shape.size[2]), true);
        let view = views.get(texture, part.used_as(TextureUsages::RENDER_ATTACHMENT));
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store };
        drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("fill"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops,
            })],
            ..Default::default()
        }));
    }
    true
}
