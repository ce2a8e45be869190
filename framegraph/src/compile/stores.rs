//! Phase 6, backward half: what becomes of each attachment at the end of its step.
//!
//! One sweep from the last step to the first. A plane whose contents somebody needs after the step is stored, all others
//! are discarded; what was only read is neither, unless nobody needs it any more: then the last reader discards it.

use super::inline::{InlinedInto, effective};
use super::loads::covered;
use super::measure::Measures;
use super::need::{Need, Why, needs_at_exit};
use super::parts::Parts;
use crate::access::{Access, AccessKind};
use crate::decision::{Decision, Reason, Subject};
use crate::format::Aspect;
use crate::graph::Graph;
use crate::id::{AccessId, ResourceId, StepId};
use crate::plan::{Attachment, Join, Role, Step, StepPass, StoreOp};

/// Fills the store ops of `attachments`; `needs` is scratch.
pub(crate) fn stores(
    graph: &Graph,
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
        let start = step.attachments.start as usize;
        let of_step = &mut attachments[step.attachments.range()];
        let decided = &mut decisions[first + start..];
        let sole = match members {
            [only] => graph.sole_colors[only.pass.index()],
            _ => AccessId::NONE,
        };
        if let ([color], false) = (&mut *of_step, sole.is_none()) {
            let subject = Subject::Store(step_id, color.resource);
            let mut log = |reason| decided[0] = Decision { subject, reason };
            let op = match needs[color.resource.index()].why() {
                Why::Reader(reader) => {
                    log(Reason::StoreReadBy(reader));
                    StoreOp::Store
                }
                why => {
                    let (op, reason) = written(why, false);
                    log(reason);
                    op
                }
            };
            (color.store, color.stencil_store) = (op, op);
        } else {
            for at in (0..of_step.len()).rev() {
                let resolved = is_resolved(of_step, at);
                let reason = decide(graph, parts, step_passes, step, needs, &mut of_step[at], resolved);
                let subject = Subject::Store(step_id, of_step[at].resource);
                decided[at] = Decision { subject, reason };
            }
        }
        for member in members.iter().rev() {
            let accesses = graph.accesses_of(member.pass);
            let inlined = member.join == Join::Inlined;
            // No two accesses of one pass exclude each other, so they need no order.
            for access in accesses {
                if inlined && matches!(access.kind, AccessKind::SamePixel | AccessKind::Color) {
                    continue;
                }
                let need = if access.mode.needs_contents() {
                    Need::reader(member.pass)
                } else {
                    Need::overwritten(member.pass)
                };
                let (resource, range) = if access.mode.writes() {
                    effective(graph, inlined_into, access)
                } else {
                    (access.resource, access.range)
                };
                parts.fill(needs, resource, range, need);
            }
        }
    }
}

/// What becomes of a plane that the step writes and, when `resolved`, averages into another attachment.
#[inline]
fn written(why: Why, resolved: bool) -> (StoreOp, Reason) {
    match why.stored() {
        Some(because) => (StoreOp::Store, because),
        None if resolved => (StoreOp::Discard, Reason::DiscardResolved),
        None if matches!(why, Why::Overwritten(_)) => (StoreOp::Discard, Reason::DiscardOverwritten),
        None => (StoreOp::Discard, Reason::DiscardUnread),
    }
}

fn is_resolved(of_step: &[Attachment], at: usize) -> bool {
    match of_step[at].role {
        Role::Color(slot) => of_step.iter().any(|a| a.role == Role::Resolve(slot)),
        _ => false,
    }
}

/// Decides both planes of one attachment and says why, the stored plane first.
#[inline(never)]
fn decide(
    graph: &Graph,
    parts: &Parts,
    step_passes: &[StepPass],
    step: &Step,
    needs: &[Need],
    attachment: &mut Attachment,
    resolved: bool,
) -> Reason {
    let Some(format) = graph.resources[attachment.resource.index()].desc.texture().map(|t| t.format) else {
        return Reason::DiscardUnread;
    };
    let mut reason = None;
    let mut plane = |aspect: Aspect, touched: StoreOp| -> StoreOp {
        let need = |holds: fn(Need) -> bool| parts.find(needs, attachment.resource, covered(attachment, aspect), holds);
        let why = need(Need::is_needed).or_else(|| need(|_| true)).map_or(Why::Unread, Need::why);
        let (op, because) = match why.stored() {
            Some(_) if !is_written(graph, step_passes, step, attachment, aspect) => {
                (StoreOp::None, Reason::StoreUnchanged)
            }
            _ => written(why, resolved),
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

/// Whether a pass of the step changes that plane of the attachment.
fn is_written(graph: &Graph, step_passes: &[StepPass], step: &Step, attachment: &Attachment, aspect: Aspect) -> bool {
    if attachment.role != Role::Depth {
        return attachment.role != Role::DepthReadOnly;
    }
    let hits = |a: &Access| {
        a.kind == AccessKind::Depth
            && a.resource == attachment.resource
            && (a.range.aspect == Aspect::All || aspect == Aspect::All || a.range.aspect == aspect)
    };
    step.passes.of(step_passes).iter().any(|m| graph.accesses_of(m.pass).iter().any(hits))
}
