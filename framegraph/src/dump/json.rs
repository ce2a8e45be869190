//! Plans as JSON, for external tools. `docs/reference/plan-json.md` documents the fields, and `docs/reference/plan.schema.json` is their
//! JSON schema (draft 2020-12). A test checks the output against both.
//!
//! The JSON form uses names instead of ids and is stable: fields change their meaning only with a new [`JSON_VERSION`].

mod names;
mod resources;
mod steps;
mod value;

pub(crate) use value::{Json, field, object};

use names::Names;

use super::describe;
use super::flow::{Flow, data_flow};
use super::reasons::Reasons;
use crate::barrier::{Barrier, Stages};
use crate::decision::{self, Decision, MemoryNeed, Refusal, Subject};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::Plan;
use crate::warning::Warning;

/// Version of the format. Increases when a field changes its meaning or is removed.
pub const JSON_VERSION: u32 = 1;

/// Returns the plan as indented JSON text, ending in a line feed; `name` is the name of the frame.
pub fn json(plan: &Plan, name: &str) -> String {
    let graph = plan.graph();
    let (reasons, names) = (Reasons::new(plan), Names::new(graph));
    // All totals are numbers, except `optimal`, which is a boolean.
    let total = |(name, value): (&'static str, u64)| match name {
        "optimal" => field(name, value != 0),
        _ => field(name, value),
    };
    let document = object([
        field("schema", "framegraph-plan"),
        field("version", JSON_VERSION),
        field("name", name),
        field("caps", plan.caps().name.as_str()),
        field("frame", plan.frame().to_vec()),
        field("order", plan.options().order.word()),
        field("alias", plan.options().alias.word()),
        field("warnings", Json::list(plan.warnings().map(warning))),
        field("totals", object(totals(plan).map(total))),
        field("peak", peak(plan, &names)),
        field("passes", Json::list(graph.pass_ids().map(|p| steps::pass(plan, &names, &reasons, p)))),
        field("flows", Json::list(data_flow(graph).iter().map(|f| flow(&names, f)))),
        field("steps", Json::list(plan.step_ids().map(|s| steps::step(plan, &names, &reasons, s)))),
        field("resources", resources::resources(plan, &names)),
        field("histories", resources::histories(plan, &names)),
        field("slots", resources::slots(plan, &names)),
        field("barriers", Json::list(plan.barriers().iter().map(|b| barrier(&names, b)))),
        field("notes", Json::list(graph.notes().map(note))),
        field("decisions", Json::list(plan.decisions().iter().map(|d| decision(plan, &names, *d)))),
    ]);
    document.text()
}

/// Returns counts and bytes of the whole plan with their JSON names; a boolean as 0 or 1.
pub fn totals(plan: &Plan) -> [(&'static str, u64); 21] {
    let (counts, memory) = (plan.counts(), plan.memory());
    let traffic = plan.traffic(plan.frame());
    [
        ("unresolves", counts.unresolves.into()),
        ("resolves", counts.resolves.into()),
        ("unresolve_bytes", traffic.loaded_bytes),
        ("resolve_bytes", traffic.stored_bytes),
        ("multisample_resolves", counts.multisample_resolves.into()),
        ("multisample_resolve_bytes", traffic.multisample_resolve_bytes),
        ("clears", counts.clears.into()),
        ("discards", counts.discards.into()),
        ("memoryless", counts.memoryless.into()),
        ("inlined", counts.inlined.into()),
        ("steps", counts.steps.into()),
        ("render_passes", counts.render_passes.into()),
        ("passes", counts.passes.into()),
        ("culled", counts.culled.into()),
        ("heap_bytes", memory.bytes),
        ("lower_bound_bytes", memory.lower_bound_bytes),
        ("gap_bytes", memory.bytes.saturating_sub(memory.lower_bound_bytes)),
        ("optimal", memory.optimal.into()),
        ("unaliased_bytes", memory.unaliased_bytes),
        ("avoided_bytes", memory.avoided_bytes),
        ("own_bytes", memory.own_bytes),
    ]
}

/// Returns the step with the most live bytes and the live resources; `None` if no memory is shared.
fn peak(plan: &Plan, names: &Names) -> Option<Json> {
    let step = plan.memory().peak.some()?;
    let live = |r: &ResourceId| describe::held(plan, *r).is_some_and(|(first, last)| first <= step && step <= last);
    let live = plan.graph().resource_ids().filter(live);
    Some(object([
        field("step", step.index()),
        field("passes", steps::passes(plan, names, step)),
        field("resources", Json::list(live.map(|r| names.resource(r)))),
    ]))
}

/// Returns a data dependency.
fn flow(names: &Names, flow: &Flow) -> Json {
    object([
        field("from", names.pass(flow.from)),
        field("to", names.pass(flow.to)),
        field("resources", Json::list(flow.resources.iter().map(|r| names.resource(*r)))),
    ])
}

fn warning(warning: Warning) -> Json {
    object([field("warning", warning.word()), field("sentence", warning.sentence())])
}

fn note((about, sentence): (&str, &str)) -> Json {
    object([field("about", about), field("sentence", sentence)])
}

/// Returns a layout transition or an aliasing barrier.
fn barrier(names: &Names, barrier: &Barrier) -> Json {
    let name = |r| names.resource(r);
    let stages = |s: Stages| Json::list(s.names());
    object([
        field("before_step", barrier.before.index()),
        field("resource", name(barrier.resource)),
        field("first_part", barrier.first_part),
        field("parts", barrier.parts),
        field("from", barrier.from.word()),
        field("to", barrier.to.word()),
        field("from_stages", stages(barrier.from_stages)),
        field("to_stages", stages(barrier.to_stages)),
        field("after_step", barrier.after.some().map(StepId::index)),
        field("hand_over", barrier.aliases.some().map(name)),
    ])
}

fn decision(plan: &Plan, names: &Names, decision: Decision) -> Json {
    let graph = plan.graph();
    let (about, pass, resource, step) = match decision.subject {
        Subject::Pass(p) => ("pass", Some(p), None, None),
        Subject::Load(s, r) => ("load", None, Some(r), Some(s)),
        Subject::Store(s, r) => ("store", None, Some(r), Some(s)),
        Subject::Resource(r) => ("resource", None, Some(r), None),
    };
    let decision::Names { pass: other_pass, resource: other_resource, refusal, need, .. } = decision.reason.names();
    let pass_name = |p: PassId| names.pass(p);
    let resource_name = |r: ResourceId| names.resource(r);
    object([
        field("about", about),
        field("pass", pass.map(pass_name)),
        field("resource", resource.map(resource_name)),
        field("step", step.map(StepId::index)),
        field("reason", decision.reason.word()),
        field("refusal", refusal.map(Refusal::word).or(need.map(MemoryNeed::word))),
        field("other_pass", other_pass.map(pass_name)),
        field("other_resource", other_resource.map(resource_name)),
        field("sentence", decision.reason.sentence(graph)),
        field("hint", Some(plan.hint(&decision)).filter(|h| !h.is_empty())),
    ])
}
