//! What a plan says of multisample resolves: in a step's store, or by a full-screen pass.

use super::{Attachment, Join, Plan, Role, StepPass};
use crate::access::{Access, AccessKind};
use crate::id::StepId;

impl Role {
    /// Whether it receives samples that the step resolves.
    #[inline]
    pub const fn is_resolve(self) -> bool {
        matches!(self, Self::ResolveTarget(..) | Self::ResolveDepth(_))
    }

    /// Whether it receives samples of an attachment of that role in the same step.
    #[inline]
    pub const fn resolves(self, samples: Self) -> bool {
        match (self, samples) {
            (Self::ResolveTarget(slot, _), Self::Color(color)) => slot == color,
            (Self::ResolveDepth(_), Self::Depth | Self::DepthReadOnly) => true,
            _ => false,
        }
    }
}

impl Plan {
    /// The passes that run, in the order in which they do: those of [`Plan::step_passes`], full-screen resolves left out.
    pub fn running(&self) -> impl Iterator<Item = StepPass> {
        self.step_passes().iter().copied().filter(|m| m.join != Join::Resolve)
    }

    /// What the passes of a step resolve, where it is a full-screen pass that makes resolves ([`Join::Resolve`]): the access
    /// that attached the samples, which are sampled now, with the resolve. Nothing for other steps.
    ///
    /// # Panics
    /// When `step` is not of this plan.
    pub fn full_screen_resolves(&self, step: StepId) -> impl Iterator<Item = (&Access, &Access)> {
        let members = self.passes_of(step).iter().filter(|m| m.join == Join::Resolve);
        members.flat_map(move |member| {
            let own = self.graph().accesses_of(member.pass);
            let made = move |a: &&Access| {
                let target = |t: &Attachment| t.resource == a.resource && t.mip == a.range.mip;
                a.kind == AccessKind::Resolve && self.attachments_of(step).iter().any(target)
            };
            own.iter().filter(made).filter_map(|r| Some((own.iter().find(|a| a.is_resolved_by(r))?, r)))
        })
    }
}
