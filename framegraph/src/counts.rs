//! The cost of a plan in numbers, for tests, budgets and reports.
//!
//! The names follow the documentation of tile-based GPUs:
//!
//! - An **unresolve** is a *load*: an attachment is read from memory into the tile at the start of a step
//!   (`LoadOp::Load`).
//! - A **resolve** is a *store*: an attachment is written from the tile to memory at the end of a step
//!   (`StoreOp::Store`).
//! - A **multisample resolve** reduces a multisampled attachment to a single-sample target.
//!
//! An attachment with depth and stencil counts once. A multisample resolve also counts as one resolve, that of its
//! target. The samples themselves are stored only if a pass or the frame needs them.

use crate::decision::Reason;
use crate::format::Aspect;
use crate::graph::PassKind;
use crate::id::StepId;
use crate::plan::{Attachment, Join, LoadOp, Placement, Plan, StoreOp};
use std::ops::AddAssign;

/// Counts of loads, stores, passes and steps, of a plan or of one step.
///
/// ```
/// use framegraph::{Caps, ClearValue, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, compile};
///
/// let mut graph = Graph::new();
/// let color = graph.add_fn("background", |pass| {
///     let color = pass.texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
///     pass.color(color, Intent::Clear(ClearValue::BLACK))
/// })?;
/// graph.export(color)?;
///
/// let mut plan = Plan::new();
/// compile(&graph, &Caps::wgpu(), &Options::default(), &mut Scratch::new(), &mut plan)?;
/// let counts = plan.counts();
/// assert_eq!(counts.unresolves, 0); // loads
/// assert_eq!(counts.resolves, 1); // stores
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct Counts {
    /// Number of attachments loaded from memory.
    pub unresolves: u32,
    /// Number of attachments stored to memory, including targets of multisample resolves.
    pub resolves: u32,
    /// Number of attachments that start with a clear value.
    pub clears: u32,
    /// Number of attachments whose contents are dropped at the end of their step.
    pub discards: u32,
    /// Number of multisample resolves performed while storing.
    pub multisample_resolves: u32,
    /// Number of memoryless textures.
    pub memoryless: u32,
    /// Number of textures that do not exist because their reader was inlined.
    pub inlined: u32,
    /// Number of raster, compute and copy steps.
    pub steps: u32,
    /// Number of raster steps, each one a render pass.
    pub render_passes: u32,
    /// Number of passes that run.
    pub passes: u32,
    /// Number of culled passes.
    pub culled: u32,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.unresolves += other.unresolves;
        self.resolves += other.resolves;
        self.clears += other.clears;
        self.discards += other.discards;
        self.multisample_resolves += other.multisample_resolves;
        self.memoryless += other.memoryless;
        self.inlined += other.inlined;
        self.steps += other.steps;
        self.render_passes += other.render_passes;
        self.passes += other.passes;
        self.culled += other.culled;
    }
}

/// Bytes that move between tile and memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct Traffic {
    /// Bytes loaded at the start of steps.
    pub loaded_bytes: u64,
    /// Bytes stored at the end of steps, including multisample resolves.
    pub stored_bytes: u64,
    /// Part of `stored_bytes` that is written to targets of multisample resolves.
    pub multisample_resolve_bytes: u64,
}

impl Traffic {
    /// Sum of loaded and stored bytes. Saturates.
    pub const fn total_bytes(&self) -> u64 {
        self.loaded_bytes.saturating_add(self.stored_bytes)
    }
}

impl AddAssign for Traffic {
    /// Adds and saturates.
    fn add_assign(&mut self, other: Self) {
        let Self { loaded_bytes, stored_bytes, multisample_resolve_bytes } = other;
        self.loaded_bytes = self.loaded_bytes.saturating_add(loaded_bytes);
        self.stored_bytes = self.stored_bytes.saturating_add(stored_bytes);
        self.multisample_resolve_bytes = self.multisample_resolve_bytes.saturating_add(multisample_resolve_bytes);
    }
}

impl Plan {
    /// Counts over the whole plan.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for step in self.step_ids() {
            counts += self.step_counts(step);
        }
        let placed = |wanted| self.resources().iter().filter(|r| r.placement == wanted).count() as u32;
        counts.memoryless = placed(Placement::Memoryless);
        counts.inlined = placed(Placement::Inlined);
        counts.culled = self.pass_steps().iter().filter(|s| s.is_none()).count() as u32;
        counts
    }

    /// Counts of one step. Memoryless, inlined and culled are 0, because they belong to no step.
    ///
    /// # Panics
    /// Panics if `step` does not belong to this plan.
    pub fn step_counts(&self, step: StepId) -> Counts {
        let row = &self.steps()[step.index()];
        let mut counts = Counts {
            steps: 1,
            render_passes: u32::from(row.kind == PassKind::Raster),
            passes: self.passes_of(step).iter().filter(|m| m.join != Join::Resolve).count() as u32,
            ..Counts::default()
        };
        for attachment in self.attachments_of(step) {
            let resolve = attachment.role.is_resolve();
            // Resolves that are not needed are not performed: their target is not stored.
            if resolve && !attachment.stores() {
                continue;
            }
            let either = |load: LoadOp| attachment.load == load || attachment.stencil_load == load;
            counts.unresolves += u32::from(attachment.loads());
            counts.resolves += u32::from(attachment.stores());
            counts.clears += u32::from(either(LoadOp::Clear));
            let dropped = |store: StoreOp| store == StoreOp::Discard;
            let discards = dropped(attachment.store) || dropped(attachment.stencil_store);
            counts.discards += u32::from(discards && !attachment.stores());
            counts.multisample_resolves += u32::from(resolve);
        }
        counts
    }

    /// Bytes moved between tile and memory by the whole plan, for a frame of `frame` texels.
    pub fn traffic(&self, frame: [u32; 2]) -> Traffic {
        let mut sum = Traffic::default();
        for step in self.step_ids() {
            sum += self.step_traffic(step, frame);
        }
        sum
    }

    /// Bytes moved between tile and memory by one step, for a frame of `frame` texels.
    ///
    /// # Panics
    /// Panics if `step` does not belong to this plan.
    pub fn step_traffic(&self, step: StepId, frame: [u32; 2]) -> Traffic {
        let mut sum = Traffic::default();
        for attachment in self.attachments_of(step) {
            sum += self.attachment_traffic(attachment, frame);
        }
        sum
    }

    /// Bytes moved between tile and memory by one attachment of this plan, for a frame of `frame` texels.
    pub fn attachment_traffic(&self, attachment: &Attachment, frame: [u32; 2]) -> Traffic {
        let declared = &self.graph().resources()[attachment.resource.index()].desc;
        let (Some(texture), Some(format)) = (declared.texture(), self.format(attachment.resource)) else {
            return Traffic::default();
        };
        let [w, h] = texture.mip_extent(frame, attachment.mip.into());
        let texels = u64::from(w) * u64::from(h);
        let samples = texels.saturating_mul(u64::from(texture.samples) * u64::from(attachment.layers));
        let planes: &[Aspect] =
            if format.has_depth() && format.has_stencil() { &[Aspect::Depth, Aspect::Stencil] } else { &[Aspect::All] };
        let (mut loaded, mut stored) = (0u64, 0u64);
        for &plane in planes {
            let Some((load, store)) = attachment.ops(format, plane) else {
                continue;
            };
            let bytes = samples.saturating_mul(format.texel_bytes(plane).into());
            loaded = loaded.saturating_add(if load == LoadOp::Load { bytes } else { 0 });
            stored = stored.saturating_add(if store == StoreOp::Store { bytes } else { 0 });
        }
        let multisample_resolve_bytes = if attachment.role.is_resolve() { stored } else { 0 };
        Traffic { loaded_bytes: loaded, stored_bytes: stored, multisample_resolve_bytes }
    }

    /// Returns the reason why a pass was culled or kept.
    pub fn verdict(&self, pass: crate::id::PassId) -> Option<Reason> {
        self.reasons(crate::decision::Subject::Pass(pass)).next()
    }
}
