//! Mutants of the decision log and of barriers.

use super::mutator::{Edit, Mutator};
use framegraph::barrier::{Barrier, Stages, State};
use framegraph::decision::{MemoryNeed, Names, Reason, Refusal, Subject};
use framegraph::id::{PassId, ResourceId, StepId};
use framegraph::internals;
use framegraph::plan::Plan;

/// Visits mutants of `decisions`.
pub(super) fn decisions(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, decision) in plan.decisions().iter().enumerate() {
        m.with("decision missing", row, |p| {
            p.decisions.remove(row);
        });
        m.with("decision duplicated", row, |p| {
            let copy = p.decisions[row];
            p.decisions.push(copy);
        });
        for subject in subjects(plan, decision.subject) {
            m.with("decision.subject", row, |p| p.decisions[row].subject = subject);
        }
        for reason in reasons(plan, row, decision.reason) {
            m.with("decision.reason", row, |p| p.decisions[row].reason = reason);
        }
    }
}

/// Returns adjacent subjects, and one of another kind.
fn subjects(plan: &Plan, subject: Subject) -> Vec<Subject> {
    let (passes, steps) = (plan.graph().passes().len(), plan.steps().len());
    let resources = plan.graph().resources().len();
    let next = |index: usize, count: usize| (index + 1) % count.max(1);
    let mut all = match subject {
        Subject::Pass(p) => vec![Subject::Pass(PassId::at(next(p.index(), passes)))],
        Subject::Resource(r) => {
            vec![Subject::Resource(ResourceId::at(next(r.index(), resources)))]
        }
        Subject::Load(s, r) => vec![
            Subject::Load(StepId::at(next(s.index(), steps)), r),
            Subject::Load(s, ResourceId::at(next(r.index(), resources))),
            Subject::Store(s, r),
        ],
        Subject::Store(s, r) => vec![
            Subject::Store(StepId::at(next(s.index(), steps)), r),
            Subject::Store(s, ResourceId::at(next(r.index(), resources))),
            Subject::Load(s, r),
        ],
    };
    if resources > 0 && passes > 0 {
        all.push(match subject {
            Subject::Resource(_) => Subject::Pass(PassId::at(0)),
            _ => Subject::Resource(ResourceId::at(0)),
        });
    }
    all.retain(|s| *s != subject);
    all
}

/// Returns other reasons: of every kind, with the same and with the next pass or resource, and with every refusal and
/// need.
fn reasons(plan: &Plan, row: usize, reason: Reason) -> Vec<Reason> {
    let (passes, resources) = (plan.graph().passes().len(), plan.graph().resources().len());
    let own = reason.names();
    let own_pass = own.pass.unwrap_or(PassId::at(row % passes.max(1)));
    let own_resource = own.resource.unwrap_or(ResourceId::at(row % resources.max(1)));
    let other_pass = PassId::at((own_pass.index() + 1) % passes.max(1));
    let other_resource = ResourceId::at((own_resource.index() + 1) % resources.max(1));
    let mut all = internals::reasons(Names::default());
    for pass in [own_pass, other_pass] {
        let named = internals::reasons(Names { pass: Some(pass), resource: Some(own_resource), ..Names::default() });
        all.extend(named.into_iter().filter(|r| r.names().pass.is_some()));
    }
    for resource in [own_resource, other_resource] {
        let named = internals::reasons(Names { pass: Some(own_pass), resource: Some(resource), ..Names::default() });
        all.extend(named.into_iter().filter(|r| r.names().resource.is_some()));
    }
    match reason {
        Reason::Split(with, why) => {
            all.extend(Refusal::ALL.iter().map(|other| Reason::Split(with, *other)));
            all.push(Reason::Split(other_pass, why));
        }
        Reason::NotInlined(with, why) => {
            all.extend(Refusal::ALL.iter().map(|other| Reason::NotInlined(with, *other)));
            all.push(Reason::NotInlined(other_pass, why));
        }
        Reason::NeedsMemory(_) => all.extend(MemoryNeed::ALL.iter().copied().map(Reason::NeedsMemory)),
        Reason::Memoryless(_) => all.extend(plan.step_ids().map(Reason::Memoryless)),
        _ => {}
    }
    all.retain(|r| *r != reason);
    all
}

/// Returns other stages: one more, a single one, or none.
fn other_stages(stages: Stages) -> Vec<Stages> {
    let mut all: Vec<Stages> = Stages::NAMES.iter().map(|(s, _)| stages.union(*s)).collect();
    all.extend(Stages::NAMES.iter().map(|(s, _)| *s).filter(|s| stages.contains(*s)));
    all.push(Stages::NONE);
    all.retain(|s| *s != stages);
    all
}

/// Visits mutants of `barriers`.
pub(super) fn barriers(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, barrier) in plan.barriers().iter().enumerate() {
        m.with("barrier missing", row, |p| {
            p.barriers.remove(row);
        });
        m.with("barrier duplicated", row, |p| {
            let copy = p.barriers[row];
            p.barriers.insert(row, copy);
        });
        for (field, edit) in BARRIER_EDITS {
            m.with(field, row, |p| edit(&mut p.barriers[row]));
        }
        for state in State::ALL {
            if state != barrier.from {
                m.with("barrier.from", row, |p| p.barriers[row].from = state);
            }
            if state != barrier.to {
                m.with("barrier.to", row, |p| p.barriers[row].to = state);
            }
        }
        for stages in other_stages(barrier.from_stages) {
            m.with("barrier.from_stages", row, |p| p.barriers[row].from_stages = stages);
        }
        for stages in other_stages(barrier.to_stages) {
            m.with("barrier.to_stages", row, |p| p.barriers[row].to_stages = stages);
        }
        for step in plan.step_ids().chain([StepId::NONE]) {
            if step != barrier.before {
                m.with("barrier.before", row, |p| p.barriers[row].before = step);
            }
            if step != barrier.after {
                m.with("barrier.after", row, |p| p.barriers[row].after = step);
            }
        }
        for resource in plan.graph().resource_ids().chain([ResourceId::NONE]) {
            if resource != barrier.aliases {
                m.with("barrier.aliases", row, |p| p.barriers[row].aliases = resource);
            }
            if resource != barrier.resource {
                m.with("barrier.resource", row, |p| p.barriers[row].resource = resource);
            }
        }
    }
}

const BARRIER_EDITS: [Edit<Barrier>; 4] = [
    ("barrier.first_part", |b| b.first_part = b.first_part.wrapping_add(1)),
    ("barrier.first_part", |b| b.first_part = b.first_part.wrapping_sub(1)),
    ("barrier.parts", |b| b.parts = b.parts.wrapping_add(1)),
    ("barrier.parts", |b| b.parts = b.parts.wrapping_sub(1)),
];
