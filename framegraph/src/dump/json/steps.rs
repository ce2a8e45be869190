//! Passes, steps and attachments.

use super::names::Names;
use super::value::{Json, field, object};
use crate::decision::Subject;
use crate::dump::describe::part;
use crate::dump::reasons::Reasons;
use crate::format::Aspect;
use crate::id::{PassId, StepId};
use crate::plan::{Attachment, Join, Plan, Role};

/// Returns the names of the passes of a step, in order.
pub(super) fn passes(plan: &Plan, names: &Names, step: StepId) -> Json {
    Json::list(plan.passes_of(step).iter().map(|m| names.pass(m.pass)))
}

/// Returns a declared pass.
pub(super) fn pass(plan: &Plan, names: &Names, reasons: &Reasons, pass: PassId) -> Json {
    let graph = plan.graph();
    let step = plan.pass_steps()[pass.index()].some();
    let member = step.and_then(|s| plan.passes_of(s).iter().find(|m| m.pass == pass));
    let accesses = graph.accesses_of(pass).iter().map(|a| {
        object([
            field("resource", names.resource(a.resource)),
            field("kind", a.kind.word()),
            field("mode", a.mode.word()),
            field("part", Some(part(&a.range, graph.bytes_of(a)).trim_start()).filter(|p| !p.is_empty())),
        ])
    });
    object([
        field("name", names.pass(pass)),
        field("kind", graph.passes()[pass.index()].kind.word()),
        field("culled", plan.is_culled(pass)),
        field("reason", reasons.sentence(plan, Subject::Pass(pass))),
        field("step", step.map(StepId::index)),
        field("join", member.map(|m| m.join.word())),
        field("accesses", Json::list(accesses)),
    ])
}

/// Returns a step.
pub(super) fn step(plan: &Plan, names: &Names, reasons: &Reasons, step: StepId) -> Json {
    let row = &plan.steps()[step.index()];
    let counts = plan.step_counts(step);
    let traffic = plan.step_traffic(step, plan.frame());
    let attachments = plan.attachments_of(step).iter().map(|a| attachment(plan, names, reasons, step, a));
    let full_screen = plan.passes_of(step).iter().any(|m| m.join == Join::Resolve);
    object([
        field("index", step.index()),
        field("kind", row.kind.word()),
        field("passes", passes(plan, names, step)),
        field("full_screen_resolve", full_screen),
        field("extent", row.extent.to_vec()),
        field("layers", row.layers),
        field("samples", u32::from(row.samples)),
        field("attachments", Json::list(attachments)),
        field("unresolves", counts.unresolves),
        field("resolves", counts.resolves),
        field("unresolve_bytes", traffic.loaded_bytes),
        field("resolve_bytes", traffic.stored_bytes),
    ])
}

/// Returns one attachment of a step.
fn attachment(plan: &Plan, names: &Names, reasons: &Reasons, step: StepId, attachment: &Attachment) -> Json {
    let Attachment { resource, mip, layer, layers, view, role, load, store, .. } = *attachment;
    let (role, slot, mode) = match role {
        Role::Color(slot) => ("color", Some(slot), None),
        Role::Depth => ("depth", None, None),
        Role::DepthReadOnly => ("depth_read_only", None, None),
        Role::ResolveTarget(slot, mode) => ("resolve", Some(slot), Some(mode.word())),
        Role::ResolveDepth(mode) => ("resolve_depth", None, Some(mode.word())),
    };
    let stencil = plan.format(resource).and_then(|f| attachment.ops(f, Aspect::Stencil));
    let moved = plan.attachment_traffic(attachment, plan.frame());
    object([
        field("resource", names.resource(resource)),
        field("role", role),
        field("slot", slot.map(u32::from)),
        field("resolve_mode", mode),
        field("mip", u32::from(mip)),
        field("layer", u32::from(layer)),
        field("layers", u32::from(layers)),
        field("view", view.map(|format| format!("{format:?}"))),
        field("load", load.word()),
        field("store", store.word()),
        field("stencil_load", stencil.map(|(load, _)| load.word())),
        field("stencil_store", stencil.map(|(_, store)| store.word())),
        field("load_reason", reasons.sentence(plan, Subject::Load(step, resource))),
        field("store_reason", reasons.sentence(plan, Subject::Store(step, resource))),
        field("unresolve_bytes", moved.loaded_bytes),
        field("resolve_bytes", moved.stored_bytes),
    ])
}
