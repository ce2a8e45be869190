//! Checks that the arrays of the plan are consistent. Other phases rely on it, so a plan that fails here is not
//! examined further.

use super::finding::{Findings, Rule};
use super::subresource::Subresources;
use framegraph::decision::{Names, Subject};
use framegraph::graph::PassKind;
use framegraph::id::{PassId, ResourceId, Span, StepId};
use framegraph::plan::{Attachment, Join, LoadOp, Placement, Plan};
use std::collections::BTreeSet;

/// Checks lengths, spans and ids.
pub(super) fn structure(plan: &Plan, findings: &Findings<'_>) {
    let graph = plan.graph();
    let require = |holds: bool, why: std::fmt::Arguments<'_>| findings.require(holds, Rule::Structure, (), why);
    require(plan.compilation() != 0, format_args!("nothing was compiled into this plan"));
    let lengths = [
        ("pass_steps", plan.pass_steps().len(), graph.passes().len()),
        ("resources", plan.resources().len(), graph.resources().len()),
    ];
    for (name, found, expected) in lengths {
        findings.equal(found, expected, Rule::Structure, (), name);
    }
    spans("passes", plan.steps().iter().map(|s| s.passes), plan.step_passes().len(), findings);
    spans("attachments", plan.steps().iter().map(|s| s.attachments), plan.attachments().len(), findings);
    for member in plan.step_passes() {
        require(has_pass(plan, member.pass), format_args!("{:?} is not a pass of the graph", member.pass));
    }
    for attachment in plan.attachments() {
        if let Some(why) = misfit(plan, attachment) {
            findings.violation(Rule::Structure, (), why);
        }
    }
    for (index, row) in plan.resources().iter().enumerate() {
        let step = |s: StepId| s.is_none() || has_step(plan, s);
        let slot = !matches!(row.placement, Placement::Slot(slot) if slot.index() >= plan.slots().len());
        let alive = row.first.is_none() == row.last.is_none() && (row.first.is_none() || row.first <= row.last);
        let holds = step(row.first) && step(row.last) && slot && alive;
        let why = format_args!("{row:?} refers to a step or slot that does not exist");
        findings.require(holds, Rule::Structure, ResourceId::at(index), why);
    }
    let parts = (!plan.barriers().is_empty()).then(|| Subresources::of_graph(graph, plan.frame()));
    for barrier in plan.barriers() {
        let end = u64::from(barrier.first_part) + u64::from(barrier.parts);
        let own = parts.as_ref().filter(|_| has_resource(plan, barrier.resource)).map(|p| p.counts(barrier.resource));
        let inside = own.is_some_and(|own| end <= own.into_iter().map(u64::from).product());
        require(inside && barrier.parts > 0, format_args!("{barrier:?} exceeds its resource"));
    }
    for decision in plan.decisions() {
        let Names { pass, resource, step, .. } = decision.reason.names();
        let named = pass.is_none_or(|p| has_pass(plan, p))
            && resource.is_none_or(|r| has_resource(plan, r))
            && step.is_none_or(|s| has_step(plan, s));
        let about = match decision.subject {
            Subject::Pass(p) => has_pass(plan, p),
            Subject::Load(s, r) | Subject::Store(s, r) => has_step(plan, s) && has_resource(plan, r),
            Subject::Resource(r) => has_resource(plan, r),
        };
        require(named && about, format_args!("{decision:?} refers to ids that do not exist"));
    }
    if findings.is_sound() {
        members(plan, findings);
    }
}

/// Checks that consecutive spans cover an array.
fn spans(name: &str, spans: impl Iterator<Item = Span>, length: usize, findings: &Findings<'_>) {
    let mut end = 0;
    for (index, span) in spans.enumerate() {
        findings.equal(span.start as usize, end, Rule::Structure, StepId::at(index), name);
        end = span.start as usize + span.len as usize;
    }
    findings.equal(end, length, Rule::Structure, (), name);
}

/// Describes an id or range of an attachment that does not exist.
fn misfit(plan: &Plan, attachment: &Attachment) -> Option<String> {
    let graph = plan.graph();
    let Some(row) = graph.resources().get(attachment.resource.index()) else {
        return Some(format!("{:?} is not a resource", attachment.resource));
    };
    let Some(texture) = row.desc.texture() else {
        return Some(format!("{:?} is not a texture", attachment.resource));
    };
    let mips = texture.mip_count(plan.frame());
    let end = u32::from(attachment.layer) + u32::from(attachment.layers);
    if u32::from(attachment.mip) >= mips || end > texture.slices(attachment.mip.into()) || attachment.layers == 0 {
        return Some(format!("{attachment:?} exceeds its texture"));
    }
    let clears = attachment.load == LoadOp::Clear || attachment.stencil_load == LoadOp::Clear;
    let unknown = attachment.clear != Attachment::ZERO && attachment.clear as usize >= graph.clears().len();
    (clears && unknown).then(|| format!("clear value {} does not exist", attachment.clear))
}

fn has_pass(plan: &Plan, pass: PassId) -> bool {
    pass.index() < plan.graph().passes().len()
}

fn has_resource(plan: &Plan, resource: ResourceId) -> bool {
    resource.index() < plan.graph().resources().len()
}

fn has_step(plan: &Plan, step: StepId) -> bool {
    step.index() < plan.steps().len()
}

/// Checks the step of each pass, and the composition of steps.
fn members(plan: &Plan, findings: &Findings<'_>) {
    let graph = plan.graph();
    let mut steps = vec![StepId::NONE; graph.passes().len()];
    let mut resolved = BTreeSet::new();
    for step in plan.step_ids() {
        let row = &plan.steps()[step.index()];
        findings.require(!row.passes.is_empty(), Rule::Structure, step, "it has no pass");
        for (at, member) in plan.passes_of(step).iter().enumerate() {
            let place = (step, member.pass);
            if member.join == Join::Resolve {
                // The phase `resolves` checks its accesses.
                let alone = row.passes.len == 1 && row.kind == PassKind::Raster;
                let ran = !steps[member.pass.index()].is_none() && resolved.insert(member.pass);
                findings.require(
                    alone && ran,
                    Rule::Structure,
                    place,
                    "it resolves for a pass that did not run, or twice",
                );
                continue;
            }
            let before = std::mem::replace(&mut steps[member.pass.index()], step);
            findings.require(before.is_none(), Rule::Structure, place, "it runs twice");
            let kind = graph.passes()[member.pass.index()].kind;
            findings.equal(row.kind, kind, Rule::Structure, place, "the step's kind");
            let opens = (member.join == Join::First) == (at == 0);
            findings.require(opens, Rule::Structure, place, "exactly the first pass of a step has the join `First`");
        }
    }
    for (pass, (found, expected)) in graph.pass_ids().zip(plan.pass_steps().iter().zip(&steps)) {
        findings.equal(found, expected, Rule::Structure, pass, "its step");
    }
}
