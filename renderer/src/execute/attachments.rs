//! Conversion of a step's attachments to wgpu: views, operations and resolve targets.

use crate::device::format::texture_format;
use crate::execute::attached::{Attached, ColorTarget, DepthTarget};
use crate::execute::error::ExecuteError;
use crate::execute::load_store::{color_ops, depth_ops};
use crate::execute::prepared::Prepared;
use crate::named::Named;
use crate::resources::realize::Physical;
use crate::resources::views::ViewDesc;
use framegraph::{Attachment, ClearValue, Dimension, Format, Range, ResolveMode, Role, StepId, StoreOp, Usage};
use wgpu::{TextureUsages, TextureView};

impl Attached {
    /// Adds the attachments of `step` to an empty value.
    ///
    /// # Errors
    /// Fails if more layers are attached at once than the device supports, or a resolve mode is not supported in the
    /// store operation.
    pub(crate) fn gather(&mut self, frame: &Prepared<'_>, step: StepId) -> Result<(), ExecuteError> {
        let plan = frame.plan;
        for attachment in plan.attachments_of(step) {
            let (view, depth_slice) = view_of(frame, attachment)?;
            let attachment = &kept_initialized(frame, step, attachment);
            let clear = plan.graph().clears().get(attachment.clear as usize).copied().unwrap_or(ClearValue::Zero);
            match attachment.role {
                Role::Color(slot) => {
                    let (slot, ops) = (usize::from(slot), color_ops(attachment, clear));
                    let slots = self.colors.len().max(slot + 1);
                    self.colors.resize_with(slots, || None);
                    self.colors[slot] = Some(ColorTarget { view, resolve: None, ops, depth_slice });
                }
                // wgpu always stores a resolve target, so an unused one is left out.
                Role::ResolveTarget(..) if attachment.store == StoreOp::Discard => {}
                Role::ResolveTarget(slot, ResolveMode::Average) => {
                    if let Some(Some(color)) = self.colors.get_mut(usize::from(slot)) {
                        color.resolve = Some(view);
                    }
                }
                Role::ResolveTarget(_, mode) | Role::ResolveDepth(mode) => {
                    let resource = Named::resource(plan, attachment.resource);
                    return Err(ExecuteError::StoreResolve { resource, mode });
                }
                Role::Depth | Role::DepthReadOnly => {
                    let format = plan.format(attachment.resource).unwrap_or(Format::Depth32Float);
                    let (depth, stencil) = depth_ops(attachment, format, clear);
                    self.depth = Some(DepthTarget { view, depth, stencil });
                }
            }
        }
        Ok(())
    }
}

/// Returns the attachment with store instead of discard where wgpu would otherwise zero-fill later contents. There are
/// two cases:
///
/// - The frame has aliased memory and therefore several command buffers, and the texture is used again in this frame. A
///   discard takes effect when its command buffer is submitted, after wgpu has checked the writes of later command
///   buffers.
/// - The texture is placed and next written by a shader. wgpu would zero-fill it first, which does not work for placed
///   textures.
fn kept_initialized(frame: &Prepared<'_>, step: StepId, attachment: &Attachment) -> Attachment {
    let row = &frame.plan.resources()[attachment.resource.index()];
    let again = frame.realized.shares_memory() && row.last != step;
    let placed = frame.realized.placed_at(attachment.resource).is_some();
    let kept = again || placed && row.usage.contains(Usage::STORAGE);
    let store = |op| if kept && op == StoreOp::Discard { StoreOp::Store } else { op };
    let (color, stencil) = (store(attachment.store), store(attachment.stencil_store));
    Attachment { store: color, stencil_store: stencil, ..*attachment }
}

/// Returns the view to attach, and the slice of a 3D texture.
fn view_of(frame: &Prepared<'_>, attachment: &Attachment) -> Result<(TextureView, Option<u32>), ExecuteError> {
    let Prepared { plan, gpu, realized, caches, .. } = *frame;
    let Physical::Texture { texture, shape, .. } = realized.get(attachment.resource) else {
        unreachable!("the plan attaches `{}`, which has no texture", Named::resource(plan, attachment.resource));
    };
    let layers = attachment.layers;
    let max = if layers == 1 || shape.samples > 1 { 1 } else { gpu.max_attached_layers()? };
    if u32::from(layers) > max {
        let (resource, adapter) = (Named::resource(plan, attachment.resource), gpu.info().clone().into());
        return Err(ExecuteError::Layers { resource, layers, max, adapter });
    }
    let format = attachment.view.or(plan.format(attachment.resource)).unwrap_or(shape.format);
    let Attachment { mip, layer, .. } = *attachment;
    let range = Range { mip, mips: 1, layer, layers, ..Range::ALL };
    let view = ViewDesc::new(format, shape.dimension, range, (shape.mips, shape.size[2]), true);
    let memoryless = shape.usage & TextureUsages::TRANSIENT_ATTACHMENT;
    debug_assert_eq!(shape.format.without_srgb(), format.without_srgb(), "views may only differ in the sRGB suffix");
    let view = if texture.format() == texture_format(format) {
        view
    } else {
        view.used_as(TextureUsages::RENDER_ATTACHMENT | memoryless)
    };
    let slice = (shape.dimension == Dimension::D3).then_some(layer.into());
    let name = plan.graph().resource_name(attachment.resource);
    Ok((caches.views.get(&gpu.device, texture, view, name)?, slice))
}
