//! Phase 6, fast path: load and store operations if every resource has one part, passes run in declaration order and
//! nothing is inlined. This covers most frames.
//!
//! Versions contain the last writer, and culling has computed the next use after each access. No sweep is needed, so
//! load and store operations are computed together.

use super::cull::reads;
use super::framebuffer::sole_color;
use super::liveness::NextUse;
use super::loads::{gather, is_resolved, load_op, loaded_after, why_loaded};
use super::steps::{Members, StepView};
use super::stores::{decide, start_from_zero, written};
use crate::access::Access;
use crate::decision::{Decision, Reason, Subject};
use crate::graph::{PassKind, Tables};
use crate::id::{AccessId, PassId, ResourceId, Span, StepId};
use crate::plan::{Attachment, LoadOp, Role, Step, StepPass, StoreOp};

/// Fills `attachments` with load and store operations, and each step's span of them. `after` is the next use after each
/// access; `stores` is scratch memory for the log of stores, which follows that of loads.
#[inline(never)]
pub(crate) fn ops(
    view: StepView<'_>,
    steps: &mut [Step],
    after: &[NextUse],
    stores: &mut Vec<Decision>,
    attachments: &mut Vec<Attachment>,
    decisions: &mut Vec<Decision>,
) {
    let graph = view.graph;
    attachments.clear();
    stores.clear();
    // Equal lengths, so that one bounds check serves both arrays.
    let after = &after[..graph.accesses.len()];
    for (index, step) in steps.iter_mut().enumerate() {
        // Cannot overflow: there are at most as many steps as passes.
        let (step_id, start) = (StepId::unchecked(index), attachments.len());
        if step.kind != PassKind::Raster {
            step.attachments = Span::new(start, start);
            continue;
        }
        if let Some(sole) = sole_color(graph, step.passes.of(view.step_passes)) {
            let (access, need) = (&graph.accesses[sole.index()], after[sole.index()]);
            only_color(graph, step_id, access, need, stores, attachments, decisions);
        } else {
            let members = view.of(step);
            gather(members, attachments);
            several(members, step_id, after, stores, &mut attachments[start..], decisions);
        }
        step.attachments = Span::new(start, attachments.len());
    }
    decisions.extend_from_slice(stores);
}

/// Adds the color attachment of a step with a single attachment that is not resolved. Decisions are logged where they
/// are made, because passing them through memory is measurably slower.
#[inline]
fn only_color(
    graph: &Tables,
    step: StepId,
    access: &Access,
    need: NextUse,
    stores: &mut Vec<Decision>,
    attachments: &mut Vec<Attachment>,
    decisions: &mut Vec<Decision>,
) {
    let resource = access.resource;
    let (subject, of_store) = (Subject::Load(step, resource), Subject::Store(step, resource));
    let mut load = load_op(access.mode);
    let mut clear = Attachment::ZERO;
    match load {
        LoadOp::Load if need.is_needed() => {
            decisions.push(Decision { subject, reason: loaded_after(writer_before(graph, access)) });
        }
        LoadOp::Load => {
            load = LoadOp::Clear;
            decisions.push(Decision { subject, reason: Reason::ClearUnneeded });
        }
        LoadOp::Clear => {
            clear = access.clear;
            decisions.push(Decision { subject, reason: Reason::LoadClear });
        }
        LoadOp::DontCare => decisions.push(Decision { subject, reason: Reason::LoadOverwritten }),
    }
    let store = if let NextUse::Reader(reader) = need {
        stores.push(Decision { subject: of_store, reason: Reason::StoreReadBy(reader) });
        StoreOp::Store
    } else {
        let (op, reason) = written(need, false);
        stores.push(Decision { subject: of_store, reason });
        op
    };
    attachments.push(Attachment {
        resource,
        mip: 0,
        layer: 0,
        layers: 1,
        view: access.range.view,
        role: Role::Color(access.slot),
        load,
        store,
        stencil_load: load,
        stencil_store: store,
        clear,
    });
}

/// Completes the attachments of a step, which have load operations.
#[inline(never)]
fn several(
    members: Members<'_>,
    step: StepId,
    after: &[NextUse],
    stores: &mut Vec<Decision>,
    of_step: &mut [Attachment],
    decisions: &mut Vec<Decision>,
) {
    let (graph, passes) = (members.graph, members.passes);
    for at in 0..of_step.len() {
        let resolved = is_resolved(of_step, &of_step[at]);
        let attachment = &mut of_step[at];
        let resource = attachment.resource;
        let (first, access) = touch(graph, passes.iter(), resource);
        let of_pass = graph.accesses_of(first);
        let adds = || reads(of_pass, &graph.accesses[access.index()], || after[access.index()].is_needed());
        let reason = if attachment.load == LoadOp::Load && !adds() {
            start_from_zero(attachment)
        } else {
            why_loaded(attachment, || writer_before(graph, &graph.accesses[access.index()]))
        };
        decisions.push(Decision { subject: Subject::Load(step, resource), reason });
        let (_, last) = touch(graph, passes.iter().rev(), resource);
        let need = after[last.index()];
        let reason = decide(members, attachment, resolved, |_| need);
        stores.push(Decision { subject: Subject::Store(step, resource), reason });
    }
}

/// Returns the first of these passes that accesses an attached resource, and its first access to it.
fn touch<'p>(
    graph: &Tables,
    mut members: impl Iterator<Item = &'p StepPass>,
    resource: ResourceId,
) -> (PassId, AccessId) {
    let of_pass = |pass: PassId| {
        let accesses = graph.passes[pass.index()].accesses;
        let at = accesses.of(&graph.accesses).iter().position(|a| a.resource == resource)?;
        Some((pass, AccessId::at(accesses.start as usize + at)))
    };
    members.find_map(|m| of_pass(m.pass)).expect("attachments are accesses of the step's passes")
}

/// Returns the last writer of a resource before this access.
#[inline(never)]
fn writer_before(graph: &Tables, access: &Access) -> Option<PassId> {
    let version = if access.mode.writes() { graph.versions[access.version.index()].previous } else { access.version };
    graph.versions[version.index()].writer.some()
}
