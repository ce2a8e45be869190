//! Attachments of one step, from the plan's words to wgpu's: views, load and store operations, resolve targets.
//!
//! The only unsafe call of the crate's portable part is here: the token of wgpu's `LoadOp::DontCare`.

use super::error::ExecuteError;
use super::format::texture_format;
use super::realize::{Physical, Realized};
use super::views::{ViewCache, ViewShape};
use framegraph::{
    Aspect, Attachment, ClearValue, Counts, Dimension, Format, LoadOp, MAX_COLORS, Plan, Range,
    Role, StepId, StoreOp,
};
use wgpu::{
    Color, Operations, RenderPassColorAttachment, RenderPassDepthStencilAttachment, TextureUsages,
    TextureView,
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

/// The load operation that lets the old contents be anything.
fn dont_care<V>() -> wgpu::LoadOp<V> {
    #[allow(
        unsafe_code,
        reason = "the token of LoadOp::DontCare has no safe constructor"
    )]
    // SAFETY: wgpu asks that every texel is written before it is read or stored. The plan gives `DontCare` only to
    // attachments whose first pass declares `Intent::Overwrite`, which is that promise, and that nobody reads before. A
    // pass that breaks its promise leaves texels undefined, never memory: every driver hands out memory of this device.
    let token = unsafe { wgpu::LoadOpDontCare::enabled() };
    wgpu::LoadOp::DontCare(token)
}

fn load<V>(op: LoadOp, clear: V) -> wgpu::LoadOp<V> {
    match op {
        LoadOp::Load => wgpu::LoadOp::Load,
        LoadOp::Clear => wgpu::LoadOp::Clear(clear),
        LoadOp::DontCare => dont_care(),
    }
}

/// What was only read stays in memory; wgpu has no word for that where an attachment may be written, and storing the
/// unchanged contents comes to the same.
const fn store(op: StoreOp) -> wgpu::StoreOp {
    match op {
        StoreOp::Store | StoreOp::None => wgpu::StoreOp::Store,
        StoreOp::Discard => wgpu::StoreOp::Discard,
    }
}

/// The operations of a color attachment.
pub(crate) fn color_ops(attachment: &Attachment, clear: ClearValue) -> Operations<Color> {
    let value = match clear {
        ClearValue::Color([r, g, b, a]) => Color { r, g, b, a },
        ClearValue::Zero | ClearValue::DepthStencil(..) => Color::TRANSPARENT,
    };
    Operations {
        load: load(attachment.load, value),
        store: store(attachment.store),
    }
}

/// The operations of both planes of a depth-stencil attachment; `None` for a plane that is read only or not there.
///
/// A plane that is read and then not needed any more is discarded, unless a pass of the step samples it (`sampled`): then
/// it must be read only. When one plane is stored, so is the other: wgpu clears a plane that is discarded alone at once.
pub(crate) fn depth_ops(
    attachment: &Attachment,
    format: Format,
    clear: ClearValue,
    sampled: bool,
) -> (Option<Operations<f32>>, Option<Operations<u32>>) {
    let (depth_value, stencil_value) = match clear {
        ClearValue::DepthStencil(depth, stencil) => (depth, stencil),
        ClearValue::Zero | ClearValue::Color(_) => (0.0, 0),
    };
    let both_discarded = [Aspect::Depth, Aspect::Stencil]
        .into_iter()
        .filter_map(|aspect| attachment.ops(format, aspect))
        .all(|(_, store)| store == StoreOp::Discard);
    let read_only = attachment.role == Role::DepthReadOnly;
    let plane = |aspect| {
        let (load_op, store_op) = attachment.ops(format, aspect)?;
        let kept = match store_op {
            StoreOp::None => return None,
            StoreOp::Discard if read_only && (sampled || !both_discarded) => return None,
            StoreOp::Discard if !both_discarded => wgpu::StoreOp::Store,
            other => store(other),
        };
        Some((load_op, kept))
    };
    let depth = plane(Aspect::Depth).map(|(l, store)| Operations {
        load: load(l, depth_value),
        store,
    });
    let stencil = plane(Aspect::Stencil).map(|(l, store)| Operations {
        load: load(l, stencil_value),
        store,
    });
    (depth, stencil)
}

impl Attached {
    /// The attachments of `step`; `sampled` says whether a pass of the step reads a resource otherwise.
    ///
    /// # Errors
    /// When several layers are attached at once.
    pub(crate) fn of(
        plan: &Plan,
        step: StepId,
        realized: &Realized,
        views: &mut ViewCache,
        sampled: impl Fn(&Attachment) -> bool,
    ) -> Result<Self, ExecuteError> {
        let mut attached = Self::default();
        for attachment in plan.attachments_of(step) {
            let (view, depth_slice) = view_of(plan, attachment, realized, views)?;
            let clear = plan
                .graph()
                .clears()
                .get(attachment.clear as usize)
                .copied()
                .unwrap_or(ClearValue::Zero);
            match attachment.role {
                Role::Color(slot) => {
                    let ops = color_ops(attachment, clear);
                    attached.colors[usize::from(slot)] = Some(ColorTarget {
                        view,
                        resolve: None,
                        ops,
                        depth_slice,
                    });
                }
                Role::Resolve(slot) => {
                    if let Some(color) = &mut attached.colors[usize::from(slot)] {
                        color.resolve = Some(view);
                    }
                }
                Role::Depth | Role::DepthReadOnly => {
                    let format = plan
                        .format(attachment.resource)
                        .unwrap_or(Format::Depth32Float);
                    let (depth, stencil) =
                        depth_ops(attachment, format, clear, sampled(attachment));
                    attached.depth = Some(DepthTarget {
                        view,
                        depth,
                        stencil,
                    });
                }
            }
        }
        Ok(attached)
    }

    /// Calls `begin` with the descriptor's parts, which borrow from here.
    pub(crate) fn with_descriptor<T>(
        &self,
        begin: impl FnOnce(
            &[Option<RenderPassColorAttachment<'_>>],
            Option<RenderPassDepthStencilAttachment<'_>>,
        ) -> T,
    ) -> T {
        let last = self
            .colors
            .iter()
            .rposition(Option::is_some)
            .map_or(0, |slot| slot + 1);
        let colors = self.colors.each_ref().map(|c| {
            c.as_ref().map(|c| RenderPassColorAttachment {
                view: &c.view,
                depth_slice: c.depth_slice,
                resolve_target: c.resolve.as_ref(),
                ops: c.ops,
            })
        });
        let depth = self
            .depth
            .as_ref()
            .map(|d| RenderPassDepthStencilAttachment {
                view: &d.view,
                depth_ops: d.depth,
                stencil_ops: d.stencil,
            });
        begin(&colors[..last], depth)
    }

    /// Adds what the descriptor tells wgpu to the counts of what was executed.
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
                let loads = [
                    depth.depth_ops.map(|o| kind(&o.load)),
                    depth.stencil_ops.map(|o| kind(&o.load)),
                ];
                let stores = [
                    depth.depth_ops.map(|o| o.store),
                    depth.stencil_ops.map(|o| o.store),
                ];
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

/// The view to attach, and the slice of a three-dimensional texture.
fn view_of(
    plan: &Plan,
    attachment: &Attachment,
    realized: &Realized,
    views: &mut ViewCache,
) -> Result<(TextureView, Option<u32>), ExecuteError> {
    let name = || plan.graph().resource_name(attachment.resource).to_owned();
    let Physical::Texture { texture, shape, .. } = realized.get(attachment.resource) else {
        unreachable!("the plan attaches `{}`, which has no texture", name());
    };
    if attachment.layers != 1 {
        return Err(ExecuteError::Layers {
            resource: name(),
            layers: attachment.layers,
        });
    }
    let format = plan.format(attachment.resource).unwrap_or(shape.format);
    let Attachment { mip, layer, .. } = *attachment;
    let range = Range {
        mip,
        mips: 1,
        layer,
        layers: 1,
        aspect: Aspect::All,
    };
    let view = ViewShape::new(
        format,
        shape.dimension,
        range,
        (shape.mips, shape.size[2]),
        true,
    );
    let memoryless = shape.usage & TextureUsages::TRANSIENT_ATTACHMENT;
    debug_assert_eq!(
        shape.format.linear_twin(),
        format.linear_twin(),
        "views differ in the transfer function alone"
    );
    let view = if texture.format() == texture_format(format) {
        view
    } else {
        view.used_as(TextureUsages::RENDER_ATTACHMENT | memoryless)
    };
    let slice = (shape.dimension == Dimension::D3).then_some(0);
    Ok((views.get(texture, view), slice))
}
