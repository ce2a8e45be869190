//! The decision log: it has its rows, and each of them is true.
//!
//! Truth is judged from the reference semantics and from what the run of the plan left behind, never from how the
//! compiler came to its decision. A row that says why something was *not* done must name an objection that stands.

mod epilogues;
mod merges;
mod ops;
mod places;
mod verdicts;

use super::case::Case;
use super::finding::{Findings, Place, Rule};
use super::machine::Trace;
use super::tenants::Heritage;
use crate::decision::{Reason, Subject};
use crate::id::{PassId, ResourceId, StepId};

/// The log by subject.
pub(super) struct Log {
    passes: Vec<Vec<Reason>>,
    resources: Vec<Vec<Reason>>,
    loads: Vec<Vec<(ResourceId, Reason)>>,
    stores: Vec<Vec<(ResourceId, Reason)>>,
}

/// Examines the decision log.
pub(super) fn decisions(case: &Case<'_>, trace: &Trace, heritage: &Heritage, findings: &mut Findings<'_>) {
    let log = Log::of(case);
    for pass in case.graph.pass_ids() {
        verdicts::verdict(case, pass, &log.passes[pass.index()], findings);
        merges::merges(case, pass, &log.passes[pass.index()], findings);
    }
    for step in case.plan.step_ids() {
        let (loads, stores) = (&log.loads[step.index()], &log.stores[step.index()]);
        ops::ops(case, trace, step, loads, stores, findings);
    }
    for resource in case.graph.resource_ids() {
        let reasons = &log.resources[resource.index()];
        places::places(case, resource, heritage.of(resource), reasons, findings);
    }
}

impl Log {
    fn of(case: &Case<'_>) -> Self {
        let steps = case.plan.steps().len();
        let mut log = Self {
            passes: vec![Vec::new(); case.graph.passes().len()],
            resources: vec![Vec::new(); case.graph.resources().len()],
            loads: vec![Vec::new(); steps],
            stores: vec![Vec::new(); steps],
        };
        for decision in case.plan.decisions() {
            let reason = decision.reason;
            match decision.subject {
                Subject::Pass(p) => log.passes[p.index()].push(reason),
                Subject::Resource(r) => log.resources[r.index()].push(reason),
                Subject::Load(s, r) => log.loads[s.index()].push((r, reason)),
                Subject::Store(s, r) => log.stores[s.index()].push((r, reason)),
            }
        }
        log
    }
}

/// Notes a row that is not true.
fn untrue(findings: &mut Findings<'_>, case: &Case<'_>, place: Place, reason: Reason) {
    let sentence = format!("the log says: {}; that is not so", reason.sentence(case.graph));
    findings.violation(Rule::Decision, place, sentence);
}

/// Notes how many rows of a kind there are, when it is not the number that there should be.
fn number(findings: &mut Findings<'_>, place: Place, what: &str, found: usize, expected: usize) {
    findings.require(found == expected, Rule::Decision, place, || {
        format!("the log has {found} rows on {what}, should have {expected}")
    });
}

/// The place of a row about what one step does to one resource.
fn at(step: StepId, resource: ResourceId) -> Place {
    Place::step(step).and_resource(resource)
}

/// The pass that runs before `pass`, if any.
fn predecessor(case: &Case<'_>, pass: PassId) -> Option<PassId> {
    let position = case.position[pass.index()]?;
    position.checked_sub(1).map(|p| case.order[p])
}
