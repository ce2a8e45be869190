//! Phase 6, backward half: what becomes of each attachment at the end of its step.
//!
//! A plane whose contents somebody needs after the step is stored, all others are discarded; what was only read is neither,
//! unless nobody needs it any more: then the last reader discards it. Where passes run as declared and resources are
//! whole, culling has noted what is needed after each access; else one sweep from the last step to the first finds it.

use super::cull::need_before;
use super::inline::{InlinedInto, effective};
use super::loads::{End, covered, is_resolved};
use super::measure::Measures;
use super::need::{Need, needs_at_exit};
use super::parts::Parts;
use crate::access::{Access, AccessKind};
use crate::decision::{Decision, Reason, Subject};
use crate::format::Aspect;
use crate::graph::Tables;
use crate::id::{AccessId, PassId, ResourceId, StepId};
use crate::plan::{Attachment, Join, Role, Step, StepPass, StoreOp};

/// Fills the store ops of `attachments` from what is needed `after` each access: for passes that run in declaration order,
/// where every resource has one part and nothing is inlined.
#[inline(never)]
pub(crate) fn stores_as_declared(
    graph: &Tables,
    steps: &[Step],
    step_passes: &[StepPass],
    after: &[Need],
    ends: &[End],
    attachments: &mut [Attachment],
    decisions: &mut Vec<Decision>,
) {
    // A decision is made where its reason is found: handed on through memory it would cost more than all the rest.
    for (attachment, end) in attachments.iter_mut().zip(ends) {
        let subject = Subject::Store(end.step, attachment.resource);
        let Some(sole) = end.sole.some() else {
            let members = steps[end.step.index()].passes.of(step_passes);
            let need = after[last_touch(graph, members, attachment.resource).index()];
            let reason = decide(graph, members, attachment, end.resolved, |_| need);
            decisions.push(Decision { subject, reason });
            continue;
        };
        let need = after[sole.index()];
        if let Some(reader) = need.reader_alone() {
            (attachment.store, attachment.stencil_store) = (StoreOp::Store, StoreOp::Store);
            decisions.push(Decision { subject, reason: Reason::StoreReadBy(reader) });
        } else {
            let (op, reason) = written(need, false);
            (attachment.store, attachment.stencil_store) = (op, op);
            decisions.push(Decision { subject, reason });
        }
    }
}

/// The last of these passes that touches a resource which one of them attaches: its first access to it.
fn last_touch(graph: &Tables, members: &[StepPass], resource: ResourceId) -> AccessId {
    let of_pass = |pass: PassId| {
        let accesses = graph.passes[pass.index()].accesses;
        let at = accesses.of(&graph.accesses).iter().position(|a| a.resource == resource)?;
        Some(AccessId::at(accesses.start as usize + at))
    };
    members.iter().rev().find_map(|m| of_pass(m.pass)).expect("a step attaches what its passes name")
}

/// Fills the store ops of `attachments`; `needs` is scratch.
#[inline(never)]
pub(crate) fn stores(
    graph: &Tables,
    parts: &Parts,
    measures: &Measures,
    steps: &[Step],
    step_passes: &[StepPass],
    inlined_into: &InlinedInto,
    needs: &mut Vec<Need>,
    attachments: &mut [Attachment],
    decisions: &mut Vec<Decision>,
) {
    needs_at_exit(graph, parts, measures, needs);
    let first = decisions.len();
    let unknown = Decision { subject: Subject::Store(StepId::NONE, ResourceId::NONE), reason: Reason::DiscardUnread };
    decisions.resize(first + attachments.len(), unknown);
    for (index, step) in steps.iter().enumerate().rev() {
        let step_id = StepId::at(index);
        let members = step.passes.of(step_passes);
        let of_step = &mut attachments[step.attachments.range()];
        let decided = &mut decisions[first + step.attachments.start as usize..];
        for at in (0..of_step.len()).rev() {
            let attachment = of_step[at];
            let resource = attachment.resource;
            let resolved = is_resolved(of_step, &attachment);
            let need = |aspect| {
                let range = covered(&attachment, aspect);
                let find = |holds: fn(Need) -> bool| parts.find(needs, resource, range, holds);
                find(Need::is_needed).or_else(|| find(|_| true)).unwrap_or(Need::UNREAD)
            };
            let reason = decide(graph, members, &mut of_step[at], resolved, need);
            decided[at] = Decision { subject: Subject::Store(step_id, resource), reason };
        }
        for member in members.iter().rev() {
            let inlined = member.join == Join::Inlined;
            // No two accesses of one pass exclude each other, so they need no order.
            for access in graph.accesses_of(member.pass) {
                if inlined && matches!(access.kind, AccessKind::SamePixel | AccessKind::Color) {
                    continue;
                }
                let (resource, range) = if access.mode.writes() {
                    effective(graph, inlined_into, access)
                } else {
                    (access.resource, access.range)
                };
                parts.fill(needs, resource, range, need_before(member.pass, access));
            }
        }
    }
}

/// What becomes of a plane that the step writes and, when `resolved`, averages into another attachment.
#[inline(never)]
fn written(need: Need, resolved: bool) -> (StoreOp, Reason) {
    match need.why().stored() {
        Some(because) => (StoreOp::Store, because),
        None if resolved => (StoreOp::Discard, Reason::DiscardResolved),
        None if need.is_overwritten() => (StoreOp::Discard, Reason::DiscardOverwritten),
        None => (StoreOp::Discard, Reason::DiscardUnread),
    }
}

/// Decides both planes of one attachment of a step of these passes from what is `needed` of each plane after the step, and
/// says why, the stored plane first.
#[inline(never)]
fn decide(
    graph: &Tables,
    members: &[StepPass],
    attachment: &mut Attachment,
    resolved: bool,
    needed: impl Fn(Aspect) -> Need,
) -> Reason {
    let Some(format) = graph.resources[attachment.resource.index()].desc.texture().map(|t| t.format) else {
        return Reason::DiscardUnread;
    };
    let mut reason = None;
    let mut plane = |aspect: Aspect, touched: StoreOp| -> StoreOp {
        let need = needed(aspect);
        let (op, because) = match need.is_needed() && !is_written(graph, members, attachment, aspect) {
            true => (StoreOp::None, Reason::StoreUnchanged),
            false => written(need, resolved),
        };
        // A plane that no access of the step touches is left as it is.
        let op = if touched == StoreOp::None { StoreOp::None } else { op };
        let stronger = reason.is_none() || op == StoreOp::Store;
        reason = if stronger && touched != StoreOp::None { Some(because) } else { reason };
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

/// Whether one of these passes changes that plane of the attachment.
fn is_written(graph: &Tables, members: &[StepPass], attachment: &Attachment, aspect: Aspect) -> bool {
    if attachment.role != Role::Depth {
        return attachment.role != Role::DepthReadOnly;
    }
    let hits = |a: &Access| {
        a.kind == AccessKind::Depth
            && a.resource == attachment.resource
            && (a.range.aspect == Aspect::All || aspect == Aspect::All || a.range.aspect == aspect)
    };
    members.iter().any(|m| graph.accesses_of(m.pass).iter().any(hits))
}
