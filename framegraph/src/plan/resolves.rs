//! Queries about multisample resolves: those performed while storing, and full-screen passes.

use super::{Attachment, Join, Plan, Role, StepPass};
use crate::access::{Access, AccessKind};
use crate::id::StepId;

impl Role {
    /// Returns `true` for a target of a multisample resolve.
    #[inline]
    pub const fn is_resolve(self) -> bool {
        matches!(self, Self::ResolveTarget(..) | Self::ResolveDepth(_))
    }

    /// Returns `true` if the attachment is a resolve target of an attachment with role `samples` in the same step.
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
    /// Returns the passes that run, in execution order: [`Plan::step_passes`] without full-screen resolves.
    pub fn running(&self) -> impl Iterator<Item = StepPass> {
        self.step_passes().iter().copied().filter(|m| m.join != Join::Resolve)
    }

    /// Returns the resolves that a full-screen resolve step ([`Join::Resolve`]) performs; empty for other steps.
    ///
    /// Each pair holds the access that attached the samples, which the step samples, and the resolve.
    ///
    /// # Panics
    /// Panics if `step` does not belong to this plan.
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
