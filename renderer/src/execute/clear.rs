//! Clears outside of render passes, for storage textures and buffers that a pass declares as cleared.

use crate::execute::error::ExecuteError;
use crate::execute::prepared::Prepared;
use crate::named::Named;
use crate::resources::realize::Physical;
use crate::resources::views::ViewDesc;
use framegraph::{Access, AccessKind, Aspect, ClearValue, Dimension, Format, Join, Mode, Plan, Range, StepId};
use wgpu::{
    Color, CommandEncoder, Features, ImageSubresourceRange, LoadOp, Operations, RenderPassColorAttachment,
    RenderPassDepthStencilAttachment, RenderPassDescriptor, StoreOp, TextureUsages, TextureView,
};

/// Returns whether a pass of `step` declares a resource as cleared without attaching it.
pub(crate) fn clears_stored(plan: &Plan, step: StepId) -> bool {
    stored_clears(plan, step).next().is_some()
}

fn stored_clears(plan: &Plan, step: StepId) -> impl Iterator<Item = &Access> {
    let members = plan.passes_of(step).iter().filter(|m| !matches!(m.join, Join::Inlined | Join::Resolve));
    let stored = |a: &&Access| matches!(a.kind, AccessKind::StorageWrite | AccessKind::CopyTarget);
    members.flat_map(|member| plan.graph().accesses_of(member.pass)).filter(move |a| stored(a) && a.mode == Mode::Clear)
}

/// Clears every resource that the passes of `step` declare as cleared without attaching it, before the step begins.
///
/// # Errors
/// Fails if the device cannot fill the texture with the value.
pub(crate) fn clear_stored(
    frame: &Prepared<'_>,
    step: StepId,
    encoder: &mut CommandEncoder,
) -> Result<(), ExecuteError> {
    let Prepared { plan, realized, .. } = *frame;
    let graph = plan.graph();
    for access in stored_clears(plan, step) {
        let value = graph.clears().get(access.clear as usize).copied().unwrap_or(ClearValue::Zero);
        let filled = match realized.get(access.resource) {
            Physical::Buffer { buffer, bytes } => {
                let whole = bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
                let (offset, bytes) = graph.bytes_of(access).map_or((0, whole), |b| (b.offset, b.bytes));
                let aligned = (offset | bytes) % wgpu::COPY_BUFFER_ALIGNMENT == 0;
                let can = is_zero(value) && aligned;
                if can {
                    encoder.clear_buffer(buffer, offset, Some(bytes));
                }
                can
            }
            Physical::Texture { .. } => fill_texture(frame, access, value, encoder),
            Physical::Absent(_) => true,
        };
        if !filled {
            return Err(ExecuteError::Clear { resource: Named::resource(plan, access.resource) });
        }
    }
    Ok(())
}

/// Returns whether all components are zero, including alpha.
fn is_zero(value: ClearValue) -> bool {
    match value {
        ClearValue::Zero => true,
        ClearValue::Color(c) => c.iter().all(|x| x.to_bits() == 0),
        ClearValue::DepthStencil(d, s) => d.to_bits() == 0 && s == 0,
    }
}

/// Fills the range of `access`. Zero values use wgpu's clear, others one render pass per level and layer or slice. Returns false
/// if neither is possible.
fn fill_texture(frame: &Prepared<'_>, access: &Access, value: ClearValue, encoder: &mut CommandEncoder) -> bool {
    let Prepared { plan, realized, .. } = *frame;
    let Physical::Texture { texture, shape, .. } = realized.get(access.resource) else {
        return false;
    };
    let volume = shape.dimension == Dimension::D3;
    let layers = access.range.layer_range(if volume { 1 } else { shape.size[2] });
    let mips = access.range.mip_range(shape.mips);
    let format = access.range.view.or(plan.format(access.resource)).unwrap_or(shape.format);
    // wgpu's clear always clears both planes.
    let whole = format.planes() == 1 || access.range.aspect == Aspect::All;
    let placed = realized.placed_at(access.resource).is_some();
    if !placed && whole && is_zero(value) && frame.gpu.device.features().contains(Features::CLEAR_TEXTURE) {
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
    if !shape.usage.contains(TextureUsages::RENDER_ATTACHMENT) {
        return false;
    }
    // A level of a volume has as many slices as its depth.
    let slices = |mip: u32| if volume { 0..(shape.size[2] >> mip).max(1) } else { layers.clone() };
    for (mip, layer) in mips.flat_map(|mip| slices(mip).map(move |layer| (mip, layer))) {
        let range = Range { mip: mip as u8, mips: 1, layer: layer as u16, layers: 1, ..Range::ALL };
        let part = ViewDesc::new(format, shape.dimension, range, (shape.mips, shape.size[2]), true);
        let name = plan.graph().resource_name(access.resource);
        let part = part.used_as(TextureUsages::RENDER_ATTACHMENT);
        let Ok(view) = frame.caches.views.get(&frame.gpu.device, texture, part, name) else { return false };
        fill_view("clear", (&view, volume.then_some(layer)), (format, access.range.aspect), value.into(), encoder);
    }
    true
}

/// Clear values for a color or depth-stencil format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Values {
    pub(crate) color: Color,
    pub(crate) depth: f32,
    pub(crate) stencil: u32,
}

impl From<ClearValue> for Values {
    fn from(value: ClearValue) -> Self {
        let zero = Self { color: Color::TRANSPARENT, depth: 0.0, stencil: 0 };
        match value {
            ClearValue::Zero => zero,
            ClearValue::Color([r, g, b, a]) => Self { color: Color { r, g, b, a }, ..zero },
            ClearValue::DepthStencil(depth, stencil) => Self { depth, stencil, ..zero },
        }
    }
}

/// Fills one level of one layer (or slice of a 3D texture) with a render pass. Planes outside of `aspect` are not
/// changed.
pub(crate) fn fill_view(
    label: &str,
    (view, depth_slice): (&TextureView, Option<u32>),
    (format, aspect): (Format, Aspect),
    values: Values,
    encoder: &mut CommandEncoder,
) {
    let Values { color, depth, stencil } = values;
    let color = RenderPassColorAttachment { view, depth_slice, resolve_target: None, ops: cleared(color) };
    let planes = RenderPassDepthStencilAttachment {
        view,
        depth_ops: (format.has_depth() && aspect != Aspect::Stencil).then_some(cleared(depth)),
        stencil_ops: (format.has_stencil() && aspect != Aspect::Depth).then_some(cleared(stencil)),
    };
    let (colors, is_depth) = ([Some(color)], format.is_depth_stencil());
    drop(encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some(label),
        color_attachments: if is_depth { &[] } else { &colors },
        depth_stencil_attachment: is_depth.then_some(planes),
        ..Default::default()
    }));
}

const fn cleared<V>(value: V) -> Operations<V> {
    Operations { load: LoadOp::Clear(value), store: StoreOp::Store }
}
