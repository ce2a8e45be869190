//! Phase 4, the rival of the open step: the step that would be open if same-pixel reads were sampled.
//!
//! Steps of both kinds begin together. They part where a pass joins the step that would not join it if it sampled; there
//! the rival begins anew. As long as each pass that joins the rival joins the step too, steps are unions of what the
//! rivals are. `merge` cuts a step where that would not hold.

use super::join::{Candidate, Touch, Touched, join_kind, touch};
use super::open::Open;
use super::step_attachments::StepAttachments;
use crate::plan::{Join, StepPass};

/// See the [module](self).
#[derive(Debug)]
pub(super) struct Rival {
    /// It differs from the open step.
    apart: bool,
    /// Where it begins in the order, and how long the log was before.
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
    /// Whether it differs from the open step.
    #[inline]
    pub(super) const fn is_apart(&self) -> bool {
        self.apart
    }

    /// Is the open step from now on.
    #[inline]
    pub(super) const fn end(&mut self) {
        self.apart = false;
    }

    /// Begins with a pass, of which the log says nothing yet.
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

    /// Whether a pass joins that has no plain objection, which widens it; `passes` are those of all steps.
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

    /// Forgets what it touched: resources may be others from now on.
    pub(super) const fn reset(&mut self) {
        (self.apart, self.number) = (false, 0);
    }
}
