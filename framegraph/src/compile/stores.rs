//! Phase 6, backward half: the store operation of each attachment.
//!
//! A written plane is stored if its contents are used after the step, otherwise discarded. A plane that was only read
//! is left unchanged. Once its contents are no longer needed, the last step that reads it discards them if possible. A
//! color attachment is cleared instead of loaded if its previous contents have no effect.
//!
//! One sweep from the last step to the first; `ops_fast_path` replaces it where possible.

use super::cull::use_before;
use super::liveness::{NextUse, uses_at_exit};
use super::loads::{attached_range, is_resolved};
use super::measure::Measures;
use super::parts::Parts;
use super::steps::{Members, StepView};
use crate::access::{Access, AccessKind, Range};
use crate::decision::{Decision, Reason, Subject};
use crate::format::{Aspect, Format};
use crate::id::{ResourceId, StepId};
use crate::plan::{Attachment, LoadOp, Role, Step, StoreOp};

/// Clears a color attachment to zero because its previous contents have no effect. Blending still reads defined values.
pub(super) fn start_from_zero(attachment: &mut Attachment) -> Reason {
    (attachment.load, attachment.stencil_load) = (LoadOp::Clear, LoadOp::Clear);
    attachment.clear = Attachment::ZERO;
    Reason::ClearUnneeded
}

/// Fills the store operations of `attachments`; `needs` is scratch memory. The log must end with the decisions on their
/// loads.
#[inline(never)]
pub(crate) fn stores(
    view: StepView<'_>,
    parts: &Parts,
    measures: &Measures,
    steps: &[Step],
    needs: &mut Vec<NextUse>,
    attachments: &mut [Attachment],
    decisions: &mut Vec<Decision>,
) {
    uses_at_exit(view.graph, parts, measures, needs);
    let first = decisions.len();
    let loads = first - attachments.len();
    let unknown = Decision { subject: Subject::Store(StepId::NONE, ResourceId::NONE), reason: Reason::DiscardUnread };
    decisions.resize(first + attachments.len(), unknown);
    for (index, step) in steps.iter().enumerate().rev() {
        let step_id = StepId::at(index);
        let members = view.of(step);
        let of_step = &mut attachments[step.attachments.range()];
        let decided = first + step.attachments.start as usize;
        for at in (0..of_step.len()).rev() {
            let attachment = of_step[at];
            let resource = attachment.resource;
            let resolved = is_resolved(of_step, &attachment);
            let need = |aspect| {
                let range = attached_range(&attachment, aspect);
                let find = |holds: fn(NextUse) -> bool| parts.find(needs, resource, range, holds);
                find(NextUse::is_needed).or_else(|| find(|_| true)).unwrap_or(NextUse::Unread)
            };
            let reason = decide(members, &mut of_step[at], resolved, need);
            decisions[decided + at] = Decision { subject: Subject::Store(step_id, resource), reason };
        }
        for at in (0..members.passes.len()).rev() {
            let pass = members.passes[at].pass;
            // Accesses of one pass do not conflict, so their order does not matter.
            for access in members.accesses(at) {
                let (resource, range) = members.resource_range(access);
                parts.replace(needs, resource, range, NextUse::is_needed, |after| {
                    use_before(pass, view.graph.accesses_of(pass), access, after)
                });
            }
        }
        for (at, attachment) in of_step.iter_mut().enumerate() {
            let loaded = attachment.load == LoadOp::Load && matches!(attachment.role, Role::Color(_));
            let range = attached_range(attachment, Aspect::All);
            if loaded && !parts.any(needs, attachment.resource, range, NextUse::is_needed) {
                let load = loads + step.attachments.start as usize + at;
                decisions[load].reason = start_from_zero(attachment);
            }
        }
    }
}

/// Returns the store operation of a plane that the step writes and, if `resolved`, resolves into another attachment.
#[inline(never)]
pub(super) fn written(need: NextUse, resolved: bool) -> (StoreOp, Reason) {
    match need.stored() {
        Some(because) => (StoreOp::Store, because),
        None if resolved => (StoreOp::Discard, Reason::DiscardResolved),
        None if need.is_overwritten() => (StoreOp::Discard, Reason::DiscardOverwritten),
        None => (StoreOp::Discard, Reason::DiscardUnread),
    }
}

/// Sets the store operations of both planes of an attachment. `needed` returns the next use of a plane after the step.
/// Returns the reason, preferring that of a stored plane.
#[inline(never)]
pub(super) fn decide(
    members: Members<'_>,
    attachment: &mut Attachment,
    resolved: bool,
    needed: impl Fn(Aspect) -> NextUse,
) -> Reason {
    let Some(format) = members.graph.resources[attachment.resource.index()].desc.texture().map(|t| t.format) else {
        return Reason::DiscardUnread;
    };
    let bound = attachment.role == Role::DepthReadOnly && is_read_beside(members, attachment, format);
    let mut reason = None;
    let mut plane = |aspect: Aspect, declared: StoreOp| -> StoreOp {
        let need = needed(aspect);
        let (op, because) = match bound || need.is_needed() && !is_written(members, attachment, aspect) {
            true => (StoreOp::None, Reason::StoreUnchanged),
            false => written(need, resolved),
        };
        // A plane that no access of the step uses is left unchanged.
        let op = if declared == StoreOp::None { StoreOp::None } else { op };
        let stronger = reason.is_none() || op == StoreOp::Store;
        reason = if stronger && declared != StoreOp::None { Some(because) } else { reason };
        op
    };
    if format.has_depth() && format.has_stencil() {
        let depth = plane(Aspect::Depth, attachment.store);
        let stencil = plane(Aspect::Stencil, attachment.stencil_store);
        (attachment.store, attachment.stencil_store) = (depth, stencil);
    } else {
        let op = plane(Aspect::All, attachment.store);
        (attachment.store, attachment.stencil_store) = (op, op);
    }
    reason.unwrap_or(Reason::StoreUnchanged)
}

/// Returns `true` if a pass of the step also reads a depth attachment in another way. The attachment must then be
/// read-only, and its contents cannot be discarded.
fn is_read_beside(members: Members<'_>, attachment: &Attachment, format: Format) -> bool {
    let attached: Range = attached_range(attachment, Aspect::All);
    let reads = |a: &Access| {
        a.resource == attachment.resource && !a.kind.is_attachment() && a.range.overlaps(&attached, format)
    };
    members.passes.iter().any(|m| members.graph.accesses_of(m.pass).iter().any(reads))
}

/// Returns `true` if a pass of the step writes this plane of the attachment.
fn is_written(members: Members<'_>, attachment: &Attachment, aspect: Aspect) -> bool {
    if attachment.role != Role::Depth {
        return attachment.role != Role::DepthReadOnly;
    }
    let hits = |a: &Access| {
        a.kind == AccessKind::Depth
            && a.resource == attachment.resource
            && (a.range.aspect == Aspect::All || aspect == Aspect::All || a.range.aspect == aspect)
    };
    members.passes.iter().any(|m| members.graph.accesses_of(m.pass).iter().any(hits))
}
