//! First of all: do the arrays of the plan fit each other and the graph? Everything after relies on it, so a plan that
//! fails here is examined no further.

use super::finding::{Findings, Place, Rule};
use crate::decision::{Names, Subject};
use crate::id::{PassId, ResourceId, Span, StepId};
use crate::plan::{Attachment, Join, LoadOp, Placement, Plan};

/// Lengths, spans and ids.
pub(super) fn structure(plan: &Plan, findings: &mut Findings<'_>) {
    let graph = plan.graph();
    let whole = Place::default();
    findings.require(plan.valid, Rule::Structure, whole, || "nothing was compiled into this plan".into());
    let lengths = [
        ("pass_steps", plan.pass_steps().len(), graph.passes().len()),
        ("resources", plan.resources().len(), graph.resources().len()),
    ];
    for (name, found, expected) in lengths {
        findings.equal(found, expected, Rule::Structure, whole, name);
    }
    let passes = plan.steps().iter().map(|s| s.passes);
    spans("passes", passes, plan.step_passes().len(), findings);
    let attachments = plan.steps().iter().map(|s| s.attachments);
    spans("attachments", attachments, plan.attachments().len(), findings);
    for member in plan.step_passes() {
        findings.require(member.pass.index() < graph.passes().len(), Rule::Structure, whole, || {
            format!("{:?} is no pass of the graph", member.pass)
        });
    }
    for attachment in plan.attachments() {
        if let Some(why) = misfit(plan, attachment) {
            findings.violation(Rule::Structure, whole, why);
        }
    }
    for (index, row) in plan.resources().iter().enumerate() {
        let step = |s: StepId| s.is_none() || s.index() < plan.steps().len();
        let slot = match row.placement {
            Placement::Slot(slot) => slot.index() < plan.slots().len(),
            _ => true,
        };
        let alive = row.first.is_none() == row.last.is_none() && (row.first.is_none() || row.first <= row.last);
        findings.require(
            step(row.first) && step(row.last) && slot && alive,
            Rule::Structure,
            Place::resource(ResourceId::at(index)),
            || format!("{row:?} names a step or slot that does not exist"),
        );
    }
    for barrier in plan.barriers() {
        let exists = barrier.resource.index() < graph.resources().len();
        let parts = |r: &crate::resource::Desc| u64::from(r.subresources(plan.frame()));
        let inside = exists
            && u64::from(barrier.first_part) + u64::from(barrier.parts)
                <= parts(&graph.resources()[barrier.resource.index()].desc);
        findings.require(inside && barrier.parts > 0, Rule::Structure, whole, || {
            format!("{barrier:?} lies outside of its resource")
        });
    }
    for decision in plan.decisions() {
        let Names { pass, resource, step, .. } = decision.reason.names();
        let exists = pass.is_none_or(|p| has_pass(plan, p))
            && resource.is_none_or(|r| has_resource(plan, r))
            && step.is_none_or(|s| has_step(plan, s))
            && subject_exists(plan, decision.subject);
        findings.require(exists, Rule::Structure, whole, || format!("{decision:?} names what does not exist"));
    }
    if findings.is_sound() {
        members(plan, findings);
    }
}

/// Consecutive spans that cover an array.
fn spans(name: &str, spans: impl Iterator<Item = Span>, length: usize, findings: &mut Findings<'_>) {
    let mut end = 0;
    for (index, span) in spans.enumerate() {
        let place = Place::step(StepId::at(index));
        findings.equal(span.start as usize, end, Rule::Structure, place, name);
        end = span.start as usize + span.len as usize;
    }
    findings.equal(end, length, Rule::Structure, Place::default(), name);
}

/// What an attachment names that does not exist.
fn misfit(plan: &Plan, attachment: &Attachment) -> Option<String> {
    let graph = plan.graph();
    let Some(row) = graph.resources().get(attachment.resource.index()) else {
        return Some(format!("{:?} is no resource", attachment.resource));
    };
    let Some(texture) = row.desc.texture() else {
        return Some(format!("{:?} is no texture", attachment.resource));
    };
    let mips = texture.mip_count(plan.frame());
    let end = u32::from(attachment.layer) + u32::from(attachment.layers);
    if u32::from(attachment.mip) >= mips || end > texture.tracked_layers() || attachment.layers == 0 {
        return Some(format!("{attachment:?} lies outside of its texture"));
    }
    let clears = attachment.load == LoadOp::Clear || attachment.stencil_load == LoadOp::Clear;
    if clears && attachment.clear != Attachment::ZERO && attachment.clear as usize >= graph.clears().len() {
        return Some(format!("clear value {} does not exist", attachment.clear));
    }
    None
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

fn subject_exists(plan: &Plan, subject: Subject) -> bool {
    match subject {
        Subject::Pass(p) => has_pass(plan, p),
        Subject::Load(s, r) | Subject::Store(s, r) => has_step(plan, s) && has_resource(plan, r),
        Subject::Resource(r) => has_resource(plan, r),
    }
}

/// Which step each pass is in, and what a step may be made of.
fn members(plan: &Plan, findings: &mut Findings<'_>) {
    let graph = plan.graph();
    let mut steps = vec![StepId::NONE; graph.passes().len()];
    for step in plan.step_ids() {
        let row = &plan.steps()[step.index()];
        let place = Place::step(step);
        findings.require(!row.passes.is_empty(), Rule::Structure, place, || "it has no pass".into());
        for (at, member) in plan.passes_of(step).iter().enumerate() {
            let place = place.and_pass(member.pass);
            let seen = std::mem::replace(&mut steps[member.pass.index()], step);
            findings.require(seen.is_none(), Rule::Structure, place, || "it runs twice".into());
            let kind = graph.passes()[member.pass.index()].kind;
            findings.equal(row.kind, kind, Rule::Structure, place, "the step's kind");
            let first = member.join == Join::First;
            findings.require(first == (at == 0), Rule::Structure, place, || {
                "the first pass of a step, and only that, opens it".into()
            });
        }
    }
    for (pass, (found, expected)) in graph.pass_ids().zip(plan.pass_steps().iter().zip(&steps)) {
        let place = Place::pass(pass);
        findings.equal(found, expected, Rule::Structure, place, "its step");
    }
}
