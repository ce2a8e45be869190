//! Attachments of one step, from the plan's to wgpu's: views, operations, resolve targets.

use crate::device::format::texture_format;
use crate::execute::error::ExecuteError;
use crate::execute::load_store::{color_ops, depth_ops};
use crate::execute::prepared::Prepared;
use crate::named::Named;
use crate::resources::realize::Physical;
use crate::resources::views::ViewDesc;
use framegraph::{
    Attachment, ClearValue, Counts, Dimension, Format, LoadOp, MAX_COLORS, Range, ResolveMode, Role, StepId, StoreOp,
    Usage,
};
use wgpu::{
    Color, Operations, RenderPassColorAttachment, RenderPassDepthStencilAttachment, TextureUsages, TextureView,
};

/// The attachments of one render pass, owned.
#[derive(Debug, Default)]
pub(crate) struct Attached {
    pub(crate) colors: [Option<ColorTarget>; MAX_COLORS as usize],
    pub(crate) depth: Option<DepthTarget>,
}

/// One color attachment.
#[derive(Clone, Debug)]
pub(crate) struct ColorTarget {
    pub(crate) view: TextureView,
    pub(crate) resolve: Option<TextureView>,
    pub(crate) ops: Operations<Color>,
    pub(crate) depth_slice: Option<u32>,
}

/// The depth-stencil attachment; a plane without operations is read only.
#[derive(Clone, Debug)]
pub(crate) struct DepthTarget {
    pub(crate) view: TextureView,
    pub(crate) depth: Option<Operations<f32>>,
    pub(crate) stencil: Option<Operations<u32>>,
}

impl Attached {
    /// The attachments of `step`.
    ///
    /// # Errors
    /// When more layers are attached at once than the device offers, and for resolves in the store that wgpu has not.
    pub(crate) fn of(frame: &Prepared<'_>, step: StepId) -> Result<Self, ExecuteError> {
        let plan = frame.plan;
        let mut attached = Self::default();
        for attachment in plan.attachments_of(step) {
            let (view, depth_slice) = view_of(frame, attachment)?;
            let attachment = &kept_initialized(frame, step, attachment);
            let clear = plan.graph().clears().get(attachment.clear as usize).copied().unwrap_or(ClearValue::Zero);
            match attachment.role {
                Role::Color(slot) => {
                    let ops = color_ops(attachment, clear);
                    attached.colors[usize::from(slot)] = Some(ColorTarget { view, resolve: None, ops, depth_slice });
                }
                // wgpu always stores a resolve target, so one that no later pass reads is left out.
                Role::ResolveTarget(..) if attachment.store == StoreOp::Discard => {}
                Role::ResolveTarget(slot, ResolveMode::Average) => {
                    if let Some(color) = &mut attached.colors[usize::from(slot)] {
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
                    attached.depth = Some(DepthTarget { view, depth, stencil });
                }
            }
        }
        Ok(attached)
    }

    /// Calls `begin` with the descriptor's parts, which borrow from here.
    pub(crate) fn with_descriptor<T>(
        &self,
        begin: impl FnOnce(&[Option<RenderPassColorAttachment<'_>>], Option<RenderPassDepthStencilAttachment<'_>>) -> T,
    ) -> T {
        let last = self.colors.iter().rposition(Option::is_some).map_or(0, |slot| slot + 1);
        let colors = self.colors.each_ref().map(|c| {
            c.as_ref().map(|c| RenderPassColorAttachment {
                view: &c.view,
                depth_slice: c.depth_slice,
                resolve_target: c.resolve.as_ref(),
                ops: c.ops,
            })
        });
        let depth = self.depth.as_ref().map(|d| RenderPassDepthStencilAttachment {
            view: &d.view,
            depth_ops: d.depth,
            stencil_ops: d.stencil,
        });
        begin(&colors[..last], depth)
    }

    /// Adds the operations of the descriptor to the counts of what was executed.
    pub(crate) fn count(&self, counts: &mut Counts) {
        counts.render_passes += 1;
        self.with_descriptor(|colors, depth| {
            for color in colors.iter().flatten() {
                counts.unresolves += u32::from(matches!(color.ops.load, wgpu::LoadOp::Load));
                counts.clears += u32::from(matches!(color.ops.load, wgpu::LoadOp::Clear(_)));
                counts.resolves += u32::from(color.ops.store == wgpu::StoreOp::Store);
                counts.discards += u32::from(color.ops.store == wgpu::StoreOp::Discard);
                counts.resolves += u32::from(color.resolve_target.is_some());
                counts.multisample_resolves += u32::from(color.resolve_target.is_some());
            }
            if let Some(depth) = depth {
                let loads = [depth.depth_ops.map(|o| kind(&o.load)), depth.stencil_ops.map(|o| kind(&o.load))];
                let stores = [depth.depth_ops.map(|o| o.store), depth.stencil_ops.map(|o| o.store)];
                let any_load = |wanted| loads.iter().flatten().any(|l| *l == wanted);
                let read_only = stores.iter().all(Option::is_none);
                let stored = stores.iter().flatten().any(|s| *s == wgpu::StoreOp::Store);
                counts.unresolves += u32::from(read_only || any_load(LoadOp::Load));
                counts.clears += u32::from(any_load(LoadOp::Clear));
                counts.resolves += u32::from(stored);
                counts.discards += u32::from(!read_only && !stored);
            }
        });
    }
}

const fn kind<V>(op: &wgpu::LoadOp<V>) -> LoadOp {
    match op {
        wgpu::LoadOp::Load => LoadOp::Load,
        wgpu::LoadOp::Clear(_) => LoadOp::Clear,
        wgpu::LoadOp::DontCare(_) => LoadOp::DontCare,
    }
}

/// The attachment, stored in place of discarded where wgpu would take later contents for missing and fill them with zero:
///
/// - Memory is shared, so that a frame has several command buffers, and the texture is used again in this frame. wgpu notes a
///   discard when the first of them is submitted, after it looked at what the next ones write.
/// - It is placed itself and next written by a shader: wgpu fills first, and cannot fill what is placed.
fn kept_initialized(frame: &Prepared<'_>, step: StepId, attachment: &Attachment) -> Attachment {
    let row = &frame.plan.resources()[attachment.resource.index()];
    let again = frame.realized.shares_memory() && row.last != step;
    let placed = frame.realized.placed_at(attachment.resource).is_some();
    let kept = again || placed && row.usage.contains(Usage::STORAGE);
    let store = |op| if kept && op == StoreOp::Discard { StoreOp::Store } else { op };
    let (color, stencil) = (store(attachment.store), store(attachment.stencil_store));
    Attachment { store: color, stencil_store: stencil, ..*attachment }
}

/// The view to attach, and the slice of a three-dimensional texture.
fn view_of(frame: &Prepared<'_>, attachment: &Attachment) -> Result<(TextureView, Option<u32>), ExecuteError> {
    let Prepared { plan, gpu, realized, caches, .. } = *frame;
    let Physical::Texture { texture, shape, .. } = realized.get(attachment.resource) else {
        unreachable!("the plan attaches `{}`, which has no texture", Named::resource(plan, attachment.resource));
    };
    let layers = attachment.layers;
    let most = if layers == 1 || shape.samples > 1 { 1 } else { gpu.max_attached_layers()? };
    if u32::from(layers) > most {
        let (resource, adapter) = (Named::resource(plan, attachment.resource), gpu.info().clone().into());
        return Err(ExecuteError::Layers { resource, layers, most, adapter });
    }
    let format = attachment.view.or(plan.format(attachment.resource)).unwrap_or(shape.format);
    let Attachment { mip, layer, .. } = *attachment;
    let range = Range { mip, mips: 1, layer, layers, ..Range::ALL };
    let view = ViewDesc::new(format, shape.dimension, range, (shape.mips, shape.size[2]), true);
    let memoryless = shape.usage & TextureUsages::TRANSIENT_ATTACHMENT;
    debug_assert_eq!(shape.format.without_srgb(), format.without_srgb(), "views differ in the transfer function alone");
    let view = if texture.format() == texture_format(format) {
        view
    } else {
        view.used_as(TextureUsages::RENDER_ATTACHMENT | memoryless)
    };
    let slice = (shape.dimension == Dimension::D3).then_some(0);
    let name = plan.graph().resource_name(attachment.resource);
    Ok((caches.views.get(&gpu.device, texture, view, name)?, slice))
}
