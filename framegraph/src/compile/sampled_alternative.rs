//! Phase 4, the sampled alternative of the current step: the step that would exist if same-pixel reads were sampled.
//!
//! Step and alternative begin together. They diverge when a pass joins the step that could not join if it sampled; a
//! new alternative begins there. Steps are unions of alternatives as long as each pass that joins the alternative also
//! joins the step. `merge` splits a step otherwise.

use super::attachment_set::AttachmentSet;
use super::current_step::CurrentStep;
use super::join::{AccessFlags, Candidate, StepAccesses, join_kind, record_accesses};
use crate::plan::{Join, StepPass};

/// The sampled alternative; see the [module](self).
#[derive(Debug)]
pub(super) struct SampledAlternative {
    /// The alternative differs from the current step.
    apart: bool,
    /// State of the alternative, and length of the log before it began.
    pub(super) current: CurrentStep,
    pub(super) log: usize,
    access_flags: Vec<AccessFlags>,
    number: u32,
    attached: AttachmentSet,
}

impl Default for SampledAlternative {
    fn default() -> Self {
        let (access_flags, attached) = (Vec::new(), AttachmentSet::default());
        Self { apart: false, current: CurrentStep::NONE, log: 0, access_flags, number: 0, attached }
    }
}

impl SampledAlternative {
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
    pub(super) fn begin(&mut self, candidate: &Candidate<'_>, current: CurrentStep, log: usize) {
        if self.number == 0 {
            self.access_flags.clear();
        }
        (self.apart, self.current, self.log) = (true, current, log);
        self.number += 1;
        self.access_flags.resize(candidate.graph.resources.len(), AccessFlags::default());
        self.attached.reset_to(candidate.accesses, current.framebuffer.samples());
        self.note(candidate);
    }

    /// Checks if a pass can join, and adds it if so. `passes` are the passes of all steps. The caller has checked the
    /// objections that do not depend on attachments.
    pub(super) fn takes(&mut self, candidate: &Candidate<'_>, passes: &[StepPass]) -> bool {
        let Self { current, access_flags, number, attached, .. } = self;
        let members = &passes[current.first..];
        let step = StepAccesses { access_flags, number: *number, members, inlined_into: &[], sampled: true };
        let takes = join_kind(candidate, step, attached).is_ok();
        if takes {
            self.note(candidate);
        }
        takes
    }

    fn note(&mut self, candidate: &Candidate<'_>) {
        record_accesses(&mut self.access_flags, self.number, candidate.accesses, Join::First, &self.attached, &[]);
    }

    /// Forgets recorded accesses, because resources may have changed.
    pub(super) const fn reset(&mut self) {
        (self.apart, self.number) = (false, 0);
    }
}
