//! Begin of a step: updates its attachments if they changed.

use crate::debug::poison;
use crate::execute::cached_step::CachedStep;
use crate::execute::clear::clears_stored;
use crate::execute::error::ExecuteError;
use crate::execute::prepared::Prepared;
use crate::execute::targets::Targets;
use crate::named::Named;
use framegraph::{AccessKind, Attachment, Format, Join, PassKind, Plan, Range, Role, StepId};

impl CachedStep {
    /// Prepares this value for `step`. Returns the number of attachment views that were reused.
    ///
    /// # Errors
    /// Fails if an attachment cannot be created.
    pub(crate) fn begin(&mut self, frame: &Prepared<'_>, step: StepId) -> Result<usize, ExecuteError> {
        let plan = frame.plan;
        if self.compilation == 0 || self.compilation != plan.compilation() {
            self.release_views();
            self.compilation = 0;
            check(plan, step)?;
            (self.targets, self.clears_stored) = (Targets::of(plan, step), clears_stored(plan, step));
            self.compilation = plan.compilation();
        }
        if plan.steps()[step.index()].kind != PassKind::Raster {
            return Ok(0);
        }
        let attachments = plan.attachments_of(step);
        let same = |(a, stamp): (&Attachment, &u64)| frame.realized.stamp(a.resource) == Some(*stamp);
        if self.valid && attachments.iter().zip(&self.stamps).all(same) {
            return Ok(attachments.len());
        }
        self.release_views();
        self.attached.gather(frame, step)?;
        self.counts = self.attached.counts();
        if frame.poison {
            self.poisoned = poison::at_start(&mut self.attached, &self.targets);
            return Ok(0);
        }
        self.stamps.clear();
        self.stamps.extend(attachments.iter().map_while(|a| frame.realized.stamp(a.resource)));
        self.valid = self.stamps.len() == attachments.len();
        Ok(0)
    }
}

/// Checks that a raster step has attachments and does not sample what it writes.
fn check(plan: &Plan, step: StepId) -> Result<(), ExecuteError> {
    if plan.steps()[step.index()].kind != PassKind::Raster {
        return Ok(());
    }
    if plan.attachments_of(step).is_empty() {
        let pass = Named::pass(plan, plan.passes_of(step)[0].pass);
        return Err(ExecuteError::NoAttachment { pass });
    }
    let both = |a: &&Attachment| a.role == Role::Depth && is_sampled(plan, step, a);
    match plan.attachments_of(step).iter().find(both) {
        Some(attachment) => Err(ExecuteError::Planes { resource: Named::resource(plan, attachment.resource) }),
        None => Ok(()),
    }
}

/// Returns whether a pass of the step reads the attached levels and layers other than as an attachment, in any plane.
/// Same-pixel reads of inlined passes do not count, since they no longer read memory.
fn is_sampled(plan: &Plan, step: StepId, attachment: &Attachment) -> bool {
    let Attachment { mip, layer, layers, .. } = *attachment;
    let attached = Range { mip, mips: 1, layer, layers, ..Range::ALL };
    let format = plan.format(attachment.resource).unwrap_or(Format::Depth32Float);
    plan.passes_of(step).iter().any(|member| {
        let (inlined, resolves) = (member.join == Join::Inlined, member.join == Join::Resolve);
        let mut accesses = plan.graph().accesses_of(member.pass).iter();
        accesses.any(|a| {
            a.resource == attachment.resource
                && a.range.overlaps(&attached, format)
                && !a.kind.is_attachment()
                && !(resolves || inlined && a.kind == AccessKind::SamePixel)
        })
    })
}
