//! Phase 4, the open step: what all of its passes have in common.

use super::framebuffer::Framebuffer;
use crate::decision::Refusal;
use crate::graph::PassFlags;
use crate::id::PassId;

/// The open step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    /// Whether it draws.
    pub(super) raster: bool,
    /// One of its passes asks to stay alone.
    pub(super) alone: bool,
    pub(super) framebuffer: Framebuffer,
    /// Where its passes begin in `step_passes`.
    pub(super) first: usize,
    /// Its last pass; none before the first step.
    pub(super) last: PassId,
}

impl Open {
    /// Before the first step.
    pub(super) const NONE: Self =
        Self { raster: false, alone: false, framebuffer: Framebuffer::NONE, first: 0, last: PassId::NONE };

    /// What stands against a pass whatever the step's attachments are.
    #[inline]
    pub(super) fn plain_objection(&self, merging: bool, flags: PassFlags, framebuffer: Framebuffer) -> Option<Refusal> {
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
