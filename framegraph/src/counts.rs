//! What a plan costs, counted: the words that tests, budgets and reports use.
//!
//! An **unresolve** is a load of an attachment from memory into the tile at the start of a step; a **resolve** is a store
//! from the tile to memory at its end. An attachment with depth and stencil counts once. A multisampled attachment that
//! is averaged into a single-sample target makes one resolve, that of the target; the samples themselves are stored only
//! if a pass or the frame needs them.

use crate::decision::Reason;
use crate::format::Aspect;
use crate::graph::PassKind;
use crate::id::StepId;
use crate::plan::{Attachment, Join, LoadOp, Placement, Plan, StoreOp};
use std::ops::AddAssign;

/// Counts over a plan, or one step of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct Counts {
    /// Attachments loaded from memory.
    pub unresolves: u32,
    /// Attachments stored to memory, targets of multisample resolves included.
    pub resolves: u32,
    /// Attachments that start with a clear value.
    pub clears: u32,
    /// Attachments whose contents are dropped at the end of their step.
    pub discards: u32,
    /// Multisampled attachments averaged into a single-sample target.
    pub multisample_resolves: u32,
    /// Textures that take no memory.
    pub memoryless: u32,
    /// Textures that never exist because their reader was inlined.
    pub inlined: u32,
    /// Raster, compute and copy steps.
    pub steps: u32,
    /// Raster steps: render passes.
    pub render_passes: u32,
    /// Passes that run.
    pub passes: u32,
    /// Passes that were culled.
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
    /// Loaded at the start of steps: unresolves.
    pub loaded_bytes: u64,
    /// Stored at the end of steps: resolves, multisample resolves included.
    pub stored_bytes: u64,
    /// The share of `stored_bytes` that targets of multisample resolves are.
    pub multisample_resolve_bytes: u64,
}

impl Traffic {
    /// Loaded and stored together.
    pub const fn total_bytes(&self) -> u64 {
        self.loaded_bytes.saturating_add(self.stored_bytes)
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

    /// Counts over one step; what belongs to no step (memoryless, inlined, culled) is 0.
    ///
    /// # Panics
    /// When `step` is not of this plan.
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
            // An average that is not needed is not made: a resolve target is written to memory, or there is none.
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

    /// Bytes between tile and memory over the whole plan, as if the frame were `frame` texels.
    pub fn traffic(&self, frame: [u32; 2]) -> Traffic {
        let mut sum = Traffic::default();
        for step in self.step_ids() {
            let Traffic { loaded_bytes, stored_bytes, multisample_resolve_bytes } = self.step_traffic(step, frame);
            sum.loaded_bytes = sum.loaded_bytes.saturating_add(loaded_bytes);
            sum.stored_bytes = sum.stored_bytes.saturating_add(stored_bytes);
            sum.multisample_resolve_bytes = sum.multisample_resolve_bytes.saturating_add(multisample_resolve_bytes);
        }
        sum
    }

    /// Bytes between tile and memory over one step, as if the frame were `frame` texels.
    ///
    /// # Panics
    /// When `step` is not of this plan.
    pub fn step_traffic(&self, step: StepId, frame: [u32; 2]) -> Traffic {
        let mut sum = Traffic::default();
        for attachment in self.attachments_of(step) {
            let (loaded, stored) = self.attachment_bytes(attachment, frame);
            sum.loaded_bytes = sum.loaded_bytes.saturating_add(loaded);
            sum.stored_bytes = sum.stored_bytes.saturating_add(stored);
            if attachment.role.is_resolve() {
                sum.multisample_resolve_bytes = sum.multisample_resolve_bytes.saturating_add(stored);
            }
        }
        sum
    }

    /// Bytes loaded and bytes stored by one attachment.
    pub(crate) fn attachment_bytes(&self, attachment: &Attachment, frame: [u32; 2]) -> (u64, u64) {
        let declared = &self.graph().resources()[attachment.resource.index()].desc;
        let (Some(texture), Some(format)) = (declared.texture(), self.format(attachment.resource)) else {
            return (0, 0);
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
        (loaded, stored)
    }

    /// Why a pass was culled, or why it was kept.
    pub fn verdict(&self, pass: crate::id::PassId) -> Option<Reason> {
        self.reasons(crate::decision::Subject::Pass(pass)).next()
    }
}
