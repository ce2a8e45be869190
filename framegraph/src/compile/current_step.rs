//! Phase 4: the current step, to which the next pass may be added.

use super::framebuffer::Framebuffer;
use crate::decision::Refusal;
use crate::graph::PassFlags;
use crate::id::PassId;

/// The current step.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurrentStep {
    /// The step is a raster step.
    pub(super) raster: bool,
    /// A pass of the step is declared `never_merge`.
    pub(super) alone: bool,
    pub(super) framebuffer: Framebuffer,
    /// Index of its first pass in `step_passes`.
    pub(super) first: usize,
    /// Its last pass; none before the first step.
    pub(super) last: PassId,
}

impl CurrentStep {
    /// State before the first step.
    pub(super) const NONE: Self =
        Self { raster: false, alone: false, framebuffer: Framebuffer::NONE, first: 0, last: PassId::NONE };

    /// Returns the objection against a pass that does not depend on its attachments, if any.
    #[inline]
    pub(super) fn basic_objection(&self, merging: bool, flags: PassFlags, framebuffer: Framebuffer) -> Option<Refusal> {
        if !merging {
            Some(Refusal::Disabled)
        } else if self.alone || flags.has(PassFlags::NEVER_MERGE) {
            Some(Refusal::NeverMerge)
        } else if framebuffer != self.framebuffer {
            Some(framebuffer.difference(self.framebuffer))
        } else {
            None
        }
    }
}
