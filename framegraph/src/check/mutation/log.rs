//! Mutants of the decision log and of the barriers.

use super::{Edit, Mutator};
use crate::barrier::{Barrier, Stages, State};
use crate::decision::{MemoryNeed, Reason, Refusal, Subject};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::Plan;

/// Rows of `decisions`.
pub(super) fn decisions(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, decision) in plan.decisions.iter().enumerate() {
        m.with("decision missing", row, |p| {
            p.decisions.remove(row);
        });
        m.with("decision doubled", row, |p| {
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

/// Neighbouring subjects, and one of another kind.
fn subjects(plan: &Plan, subject: Subject) -> Vec<Subject> {
    let (passes, steps) = (plan.graph.passes.len(), plan.steps.len());
    let resources = plan.graph.resources.len();
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

const REFUSALS: [Refusal; 23] = [
    Refusal::Disabled,
    Refusal::NotRaster,
    Refusal::ComputeBetween,
    Refusal::Extent,
    Refusal::Samples,
    Refusal::Layers,
    Refusal::ColorsDiffer,
    Refusal::DepthDiffers,
    Refusal::TooManyAttachments,
    Refusal::TileMemory,
    Refusal::SampledElsewhere,
    Refusal::SamePixelUnsupported,
    Refusal::ClearBetween,
    Refusal::ResolveBetween,
    Refusal::NeverMerge,
    Refusal::StorageHazard,
    Refusal::NeededAsTexture,
    Refusal::Blends,
    Refusal::NotPointwise,
    Refusal::NoEpilogue,
    Refusal::TargetShape,
    Refusal::BuildsOnContents,
    Refusal::SideEffect,
];

const NEEDS: [MemoryNeed; 6] = [
    MemoryNeed::Unsupported,
    MemoryNeed::OtherUse,
    MemoryNeed::ResolveTarget,
    MemoryNeed::SeveralParts,
    MemoryNeed::LoadedOrStored,
    MemoryNeed::ReadOnly,
];

/// Reasons of every kind, with the pass or resource that the true one names and with the next one; every refusal and every
/// need where there is one. Never the reason itself.
fn reasons(plan: &Plan, row: usize, reason: Reason) -> Vec<Reason> {
    use Reason as R;
    let (passes, resources) = (plan.graph.passes.len(), plan.graph.resources.len());
    let own_pass = pass_of(reason).unwrap_or(PassId::at(row % passes.max(1)));
    let own_resource = resource_of(reason).unwrap_or(ResourceId::at(row % resources.max(1)));
    let other_pass = PassId::at((own_pass.index() + 1) % passes.max(1));
    let other_resource = ResourceId::at((own_resource.index() + 1) % resources.max(1));
    let mut all = vec![
        R::KeptSideEffect,
        R::KeptCullingOff,
        R::CulledNoOutput,
        R::LoadClear,
        R::ClearUnneeded,
        R::LoadOverwritten,
        R::LoadEntry,
        R::StoreExport,
        R::StoreImport,
        R::StoreHistory,
        R::DiscardUnread,
        R::DiscardOverwritten,
        R::DiscardResolved,
        R::StoreUnchanged,
        R::Inlined,
        R::SlotFirst,
        R::Placed,
        R::External,
        R::Persistent,
        R::AliasingOff,
        R::Unused,
    ];
    for pass in [own_pass, other_pass] {
        all.extend([
            R::KeptReadBy(own_resource, pass),
            R::CulledReaderCulled(own_resource, pass),
            R::CulledOverwritten(own_resource, pass),
            R::OrderMerge(pass),
            R::OrderBytes(pass),
            R::MergedAttachments(pass),
            R::MergedSamePixel(pass),
            R::MergedInline(pass),
            R::LoadWritten(pass),
            R::StoreReadBy(pass),
        ]);
    }
    for resource in [own_resource, other_resource] {
        all.extend([
            R::KeptExport(resource),
            R::KeptImport(resource),
            R::KeptHistory(resource),
            R::KeptReadBy(resource, own_pass),
            R::CulledUnread(resource),
            R::CulledReaderCulled(resource, own_pass),
            R::CulledOverwritten(resource, own_pass),
            R::SlotAfter(resource),
            R::PlacedAfter(resource),
        ]);
    }
    match reason {
        R::Split(with, why) => {
            all.extend(REFUSALS.map(|other| R::Split(with, other)));
            all.push(R::Split(other_pass, why));
        }
        R::NotInlined(with, why) => {
            all.extend(REFUSALS.map(|other| R::NotInlined(with, other)));
            all.push(R::NotInlined(other_pass, why));
        }
        R::NeedsMemory(_) => all.extend(NEEDS.map(R::NeedsMemory)),
        R::Memoryless(_) => all.extend(plan.step_ids().map(R::Memoryless)),
        _ => {}
    }
    all.retain(|r| *r != reason);
    all
}

fn pass_of(reason: Reason) -> Option<PassId> {
    match reason {
        Reason::KeptReadBy(_, p)
        | Reason::CulledReaderCulled(_, p)
        | Reason::CulledOverwritten(_, p)
        | Reason::Split(p, _)
        | Reason::NotInlined(p, _)
        | Reason::LoadWritten(p)
        | Reason::StoreReadBy(p)
        | Reason::OrderMerge(p)
        | Reason::OrderBytes(p)
        | Reason::MergedAttachments(p)
        | Reason::MergedSamePixel(p)
        | Reason::MergedInline(p) => Some(p),
        _ => None,
    }
}

fn resource_of(reason: Reason) -> Option<ResourceId> {
    match reason {
        Reason::KeptReadBy(r, _)
        | Reason::CulledReaderCulled(r, _)
        | Reason::CulledOverwritten(r, _)
        | Reason::KeptExport(r)
        | Reason::KeptImport(r)
        | Reason::KeptHistory(r)
        | Reason::CulledUnread(r)
        | Reason::SlotAfter(r)
        | Reason::PlacedAfter(r) => Some(r),
        _ => None,
    }
}

const STATES: [State; 13] = [
    State::Undefined,
    State::Entry,
    State::ColorAttachment,
    State::DepthAttachment,
    State::DepthReadOnly,
    State::InputAttachment,
    State::Sampled,
    State::Storage,
    State::Uniform,
    State::VertexInput,
    State::Indirect,
    State::CopySource,
    State::CopyTarget,
];

const STAGES: [Stages; 7] = [
    Stages::SHADER,
    Stages::COLOR,
    Stages::DEPTH,
    Stages::COMPUTE,
    Stages::COPY,
    Stages::VERTEX_INPUT,
    Stages::INDIRECT,
];

/// The stages with one more, or with only this one where it is among them already and not alone, or with none.
fn other_stages(stages: Stages) -> Vec<Stages> {
    let mut all: Vec<Stages> = STAGES.iter().map(|s| stages.union(*s)).collect();
    all.extend(STAGES.iter().filter(|s| stages.contains(**s)));
    all.push(Stages::NONE);
    all.retain(|s| *s != stages);
    all
}

/// Rows of `barriers`.
pub(super) fn barriers(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, barrier) in plan.barriers.iter().enumerate() {
        m.with("barrier missing", row, |p| {
            p.barriers.remove(row);
        });
        m.with("barrier doubled", row, |p| {
            let copy = p.barriers[row];
            p.barriers.insert(row, copy);
        });
        for (field, edit) in BARRIER_EDITS {
            m.with(field, row, |p| edit(&mut p.barriers[row]));
        }
        for state in STATES {
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
        for resource in plan.graph.resource_ids().chain([ResourceId::NONE]) {
            if resource != barrier.hand_over {
                m.with("barrier.hand_over", row, |p| p.barriers[row].hand_over = resource);
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
