//! Phase 4, the sampled alternative of the current step: the step that would exist if same-pixel reads were sampled.
//!
//! Step and alternative begin together. They diverge when a pass joins the step that could not join if it sampled; a
//! new alternative begins there. Steps are unions of alternatives as long as each pass that joins the alternative also
//! joins the step. `merge` splits a step otherwise.

use super::join::{Candidate, Touch, Touched, join_kind, touch};
use super::open::Open;
use super::step_attachments::StepAttachments;
use crate::plan::{Join, StepPass};

/// The sampled alternative; see the [module](self).
#[derive(Debug)]
pub(super) struct Rival {
    /// The alternative differs from the current step.
    apart: bool,
    /// State of the alternative, and length of the log before it began.
    pub(super) open: Open,
    pub(super) log: usize,
    touches: Vec<Touch>,
    number: u32,
    attached: StepAttachments,
}

impl Default for Rival {
    fn default() -> Self {
        let (touches, attached) = (Vec::new(), StepAttachments::default());
        Self { apart: false, open: Open::NONE, log: 0, touches, number: 0, attached }
    }
}

impl Rival {
    /// Returns `true` if the alternative differs from the current step.
    #[inline]
    pub(super) const fn is_apart(&self) -> bool {
        self.apart
    }

    /// Makes the alternative identical to the current step.
    #[inline]
    pub(super) const fn end(&mut self) {
        self.apart = false;
    }

    /// Begins an alternative with a pass that is not logged yet.
    pub(super) fn begin(&mut self, candidate: &Candidate<'_>, open: Open, log: usize) {
        if self.number == 0 {
            self.touches.clear();
        }
        (self.apart, self.open, self.log) = (true, open, log);
        self.number += 1;
        self.touches.resize(candidate.graph.resources.len(), Touch::default());
        self.attached.open(candidate.accesses, open.framebuffer.samples());
        self.note(candidate);
    }

    /// Checks if a pass can join, and adds it if so. `passes` are the passes of all steps. The caller has checked the
    /// objections that do not depend on attachments.
    pub(super) fn takes(&mut self, candidate: &Candidate<'_>, passes: &[StepPass]) -> bool {
        let Self { open, touches, number, attached, .. } = self;
        let members = &passes[open.first..];
        let step = Touched { touches, number: *number, members, inlined_into: &[], sampled: true };
        let takes = join_kind(candidate, step, attached).is_ok();
        if takes {
            self.note(candidate);
        }
        takes
    }

    fn note(&mut self, candidate: &Candidate<'_>) {
        touch(&mut self.touches, self.number, candidate.accesses, Join::First, &self.attached, &[]);
    }

    /// Forgets recorded accesses, because resources may have changed.
    pub(super) const fn reset(&mut self) {
        (self.apart, self.number) = (false, 0);
    }
}
