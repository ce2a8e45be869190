//! Resolves: which of them a plan makes, in the store of a step or by full-screen passes, and whether each is what its pass
//! declares.

use super::case::{Case, Touch};
use super::finding::Rule;
use super::reference::{Read, Value};
use crate::access::{Access, AccessKind, Mode, Range};
use crate::format::{Aspect, Format};
use crate::id::{PassId, StepId};
use crate::plan::{Attachment, Join, Role, StepPass};
use crate::resolve::ResolveMode;

/// A resolve that is made by a full-screen pass: as what that pass does.
pub(super) struct FullScreen {
    /// Who declares it.
    pub(super) pass: PassId,
    /// Index of the resolve in the graph.
    pub(super) id: usize,
    /// The samples, fetched from memory.
    pub(super) samples: Access,
    /// What they must hold.
    pub(super) reads: Vec<Read>,
    /// The target, drawn into.
    pub(super) target: Access,
}

impl Case<'_> {
    /// Fills `dropped` from the attachments of the plan: the average is made for the last pass of the step that declares it.
    pub(super) fn find_dropped(&mut self) {
        for step in self.plan.step_ids() {
            let mut made = Vec::new();
            for member in self.plan.passes_of(step).iter().rev().filter(|m| m.join != Join::Resolve) {
                for (id, access) in self.accesses_of(member.pass).filter(|(_, a)| a.kind == AccessKind::Resolve) {
                    let target = self.resolved_into(step, *member, access).filter(|at| !made.contains(at));
                    self.dropped[id] = target.is_none();
                    made.extend(target);
                }
            }
        }
        for step in self.plan.step_ids() {
            for member in self.plan.passes_of(step).iter().filter(|m| m.join == Join::Resolve) {
                for (id, resolve) in self.accesses_of(member.pass).filter(|(_, a)| a.kind == AccessKind::Resolve) {
                    let made = self.full_screen(member.pass, id, resolve);
                    let drawn = |made: &FullScreen| {
                        let Access { kind, resource, range, .. } = made.target;
                        self.attachment(step, kind, resource, range).is_some()
                    };
                    if let Some(made) = made.filter(drawn) {
                        self.dropped[id] = false;
                        self.full_screen.push(made);
                    }
                }
            }
        }
    }

    /// What a full-screen pass does for a resolve.
    fn full_screen(&self, pass: PassId, id: usize, resolve: &Access) -> Option<FullScreen> {
        let (own, attached) = self.accesses_of(pass).find(|(_, a)| attaches_samples(a, resolve))?;
        let format = self.texture(attached.resource)?.format;
        let depth = resolve.slot == Access::DEPTH;
        let aspect = if format.has_stencil() && depth { Aspect::Depth } else { attached.range.aspect };
        let range = Range { aspect, ..attached.range };
        let samples = Access { kind: AccessKind::Sampled, mode: Mode::Read, range, ..*attached };
        let kind = if depth { AccessKind::Depth } else { AccessKind::Color };
        let target = Access { kind, slot: if depth { 0 } else { resolve.slot }, ..*resolve };
        let before = &self.reference.reads[self.reference.of_access[own].clone()];
        let reads = self.covered(&samples).map(|part| {
            let tested = before.iter().find(|r| r.part == part && !attached.mode.writes());
            Read { pass, access: id, part, value: tested.map_or(Value::Written(pass), |r| r.value) }
        });
        Some(FullScreen { pass, id, reads: reads.collect(), samples, target })
    }

    /// The resolve target of a step that gets what a pass resolves so.
    fn resolved_into(&self, step: StepId, member: StepPass, resolve: &Access) -> Option<usize> {
        let spot = |a: &Access| self.effective(a.resource, a.range);
        let samples = self.graph.accesses_of(member.pass).iter().find(|a| attaches_samples(a, resolve))?;
        let (resource, range) = spot(samples);
        let (_, samples) = self.attachment(step, samples.kind, resource, range)?;
        let (target, range) = spot(resolve);
        let (at, target) = self.attachment(step, AccessKind::Resolve, target, range)?;
        takes_samples(target.role, samples.role).then_some(at)
    }

    /// The attachment whose samples a resolve of a pass takes: that of its own which has the resolve's slot, or depth.
    pub(super) fn averaged(&self, member: StepPass, resolve: &Touch) -> Option<Touch> {
        self.touches(member).find(|t| attaches_samples(&t.access, &resolve.access))
    }

    /// Whether a full-screen pass makes the resolve of that index.
    pub(super) fn is_full_screen(&self, resolve: usize) -> bool {
        self.full_screen.iter().any(|m| m.id == resolve)
    }
}

/// Whether an access attaches what a resolve of the same pass takes.
pub(super) fn attaches_samples(access: &Access, resolve: &Access) -> bool {
    match resolve.slot {
        Access::DEPTH => matches!(access.kind, AccessKind::Depth | AccessKind::DepthReadOnly),
        slot => access.kind == AccessKind::Color && access.slot == slot,
    }
}

/// Whether an attachment is the target of a resolve.
pub(super) const fn is_target(role: Role) -> bool {
    matches!(role, Role::ResolveTarget(..) | Role::ResolveDepth(_))
}

/// Whether a target takes the samples of an attachment of its step.
pub(super) const fn takes_samples(target: Role, samples: Role) -> bool {
    match (target, samples) {
        (Role::ResolveTarget(slot, _), Role::Color(color)) => slot == color,
        (Role::ResolveDepth(_), Role::Depth | Role::DepthReadOnly) => true,
        _ => false,
    }
}

/// Each target gets the samples that its pass declares, by its mode, where the device makes it.
pub(super) fn resolves(case: &Case<'_>, step: StepId) {
    for &member in case.plan.passes_of(step) {
        for touch in case.touches(member).filter(|t| t.access.kind == AccessKind::Resolve) {
            let place = (step, member.pass, touch.resource);
            let target = case.attachment(step, AccessKind::Resolve, touch.resource, touch.range);
            let samples = case.averaged(member, &touch);
            let samples = samples.and_then(|t| case.attachment(step, t.access.kind, t.resource, t.range));
            let (Some((_, target)), Some((_, samples))) = (target, samples) else {
                case.report.violation(Rule::Resolve, place, "it resolves nothing that is attached");
                continue;
            };
            let takes = takes_samples(target.role, samples.role);
            let why = format_args!("{:?} does not take the samples of {:?}", target.role, samples.role);
            case.report.require(takes, Rule::Resolve, place, why);
            if let Role::ResolveTarget(_, mode) | Role::ResolveDepth(mode) = target.role {
                case.report.equal(mode, touch.access.resolve, Rule::Resolve, place, "its mode");
            }
            let seen = |a: &Attachment| a.view.or(case.format(a.resource));
            fits(case, seen(target), seen(samples), place);
            case.report.require(in_store(case, &touch.access), Rule::Resolve, place, "the device does not store so");
        }
        if member.join == Join::Resolve {
            full_screen(case, step, member);
        }
    }
}

/// A step that is a full-screen pass makes nothing but resolves which the device does not make in its store.
fn full_screen(case: &Case<'_>, step: StepId, member: StepPass) {
    let mut made = 0;
    for resolve in case.full_screen.iter().filter(|m| m.pass == member.pass) {
        let (samples, target) = (resolve.samples, resolve.target);
        let place = (step, member.pass, target.resource);
        let seen = |a: Access| a.range.view.or(case.format(a.resource));
        fits(case, seen(target), seen(samples), place);
        let declared = &case.graph.accesses()[resolve.id];
        case.report.require(!in_store(case, declared), Rule::Resolve, place, "the device stores so");
        made += 1;
    }
    let rows = case.plan.attachments_of(step).len();
    case.report.equal(rows, made, Rule::Resolve, (step, member.pass), "its targets");
}

/// A target has the format of its samples, or that of their depth plane.
fn fits(case: &Case<'_>, target: Option<Format>, samples: Option<Format>, place: impl Into<super::finding::Place>) {
    let samples = samples.map(|format| match format {
        Format::Depth24PlusStencil8 => Format::Depth24Plus,
        Format::Depth32FloatStencil8 => Format::Depth32Float,
        other => other,
    });
    case.report.equal(target, samples, Rule::Resolve, place, "its format");
}

/// Whether the device makes a resolve in its store.
pub(super) fn in_store(case: &Case<'_>, resolve: &Access) -> bool {
    let caps = case.plan.caps();
    let modes = if resolve.slot == Access::DEPTH { caps.depth_resolves } else { caps.color_resolves };
    let apart = resolve.resolve == ResolveMode::Average
        && case.texture(resolve.resource).is_some_and(|t| caps.not_averaged.contains(&t.format));
    modes.has(resolve.resolve) && !apart
}
