//! Resolves: which of them the plan performs, while storing or with full-screen passes, and if they match the
//! declaration.

use super::finding::Rule;
use super::reference::{Read, Value};
use super::rule_input::{PlannedAccess, RuleInput};
use framegraph::access::{Access, AccessKind, Mode, Range};
use framegraph::format::{Aspect, Format};
use framegraph::id::{PassId, StepId};
use framegraph::plan::{Attachment, Join, Role, StepPass};
use framegraph::resolve::ResolveMode;

/// A resolve performed by a full-screen pass, as accesses of that pass.
pub(super) struct FullScreen {
    /// The pass that declares the resolve.
    pub(super) pass: PassId,
    /// Index of the resolve in the graph.
    pub(super) id: usize,
    /// The samples, read from memory.
    pub(super) samples: Access,
    /// The expected values of the samples.
    pub(super) reads: Vec<Read>,
    /// The target, as an attachment.
    pub(super) target: Access,
}

impl RuleInput<'_> {
    /// Fills `dropped` from the attachments of the plan. The last pass of the step that declares a resolve performs it.
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

    /// Returns the accesses of a full-screen pass for a resolve.
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

    /// Returns the resolve target of a step that a resolve of a pass writes.
    fn resolved_into(&self, step: StepId, member: StepPass, resolve: &Access) -> Option<usize> {
        let spot = |a: &Access| self.effective(a.resource, a.range);
        let samples = self.graph.accesses_of(member.pass).iter().find(|a| attaches_samples(a, resolve))?;
        let (resource, range) = spot(samples);
        let (_, samples) = self.attachment(step, samples.kind, resource, range)?;
        let (target, range) = spot(resolve);
        let (at, target) = self.attachment(step, AccessKind::Resolve, target, range)?;
        takes_samples(target.role, samples.role).then_some(at)
    }

    /// Returns the attachment access whose samples a resolve of the same pass reads.
    pub(super) fn averaged(&self, member: StepPass, resolve: &PlannedAccess) -> Option<PlannedAccess> {
        self.planned_accesses(member).find(|t| attaches_samples(&t.access, &resolve.access))
    }

    /// Returns `true` if a full-screen pass performs the resolve with this index.
    pub(super) fn is_full_screen(&self, resolve: usize) -> bool {
        self.full_screen.iter().any(|m| m.id == resolve)
    }
}

/// Returns `true` if an access attaches the source of a resolve of the same pass.
pub(super) fn attaches_samples(access: &Access, resolve: &Access) -> bool {
    match resolve.slot {
        Access::DEPTH => matches!(access.kind, AccessKind::Depth | AccessKind::DepthReadOnly),
        slot => access.kind == AccessKind::Color && access.slot == slot,
    }
}

/// Returns `true` for the role of a resolve target.
pub(super) const fn is_target(role: Role) -> bool {
    matches!(role, Role::ResolveTarget(..) | Role::ResolveDepth(_))
}

/// Returns `true` if a resolve target receives the samples of an attachment with role `samples`.
pub(super) const fn takes_samples(target: Role, samples: Role) -> bool {
    match (target, samples) {
        (Role::ResolveTarget(slot, _), Role::Color(color)) => slot == color,
        (Role::ResolveDepth(_), Role::Depth | Role::DepthReadOnly) => true,
        _ => false,
    }
}

/// Checks that each target receives the declared samples with the declared mode, and that the device supports it.
pub(super) fn resolves(ctx: &RuleInput<'_>, step: StepId) {
    for &member in ctx.plan.passes_of(step) {
        for touch in ctx.planned_accesses(member).filter(|t| t.access.kind == AccessKind::Resolve) {
            let place = (step, member.pass, touch.resource);
            let target = ctx.attachment(step, AccessKind::Resolve, touch.resource, touch.range);
            let samples = ctx.averaged(member, &touch);
            let samples = samples.and_then(|t| ctx.attachment(step, t.access.kind, t.resource, t.range));
            let (Some((_, target)), Some((_, samples))) = (target, samples) else {
                ctx.report.violation(Rule::Resolve, place, "its source is not attached");
                continue;
            };
            let takes = takes_samples(target.role, samples.role);
            let why = format_args!("{:?} does not receive the samples of {:?}", target.role, samples.role);
            ctx.report.require(takes, Rule::Resolve, place, why);
            if let Role::ResolveTarget(_, mode) | Role::ResolveDepth(mode) = target.role {
                ctx.report.equal(mode, touch.access.resolve, Rule::Resolve, place, "its mode");
            }
            let seen = |a: &Attachment| a.view.or(ctx.format(a.resource));
            fits(ctx, seen(target), seen(samples), place);
            ctx.report.require(
                in_store(ctx, &touch.access),
                Rule::Resolve,
                place,
                "the device cannot resolve it while storing",
            );
        }
        if member.join == Join::Resolve {
            full_screen(ctx, step, member);
        }
    }
}

/// Checks that a full-screen resolve step performs only resolves that the device cannot perform while storing.
fn full_screen(ctx: &RuleInput<'_>, step: StepId, member: StepPass) {
    let mut made = 0;
    for resolve in ctx.full_screen.iter().filter(|m| m.pass == member.pass) {
        let (samples, target) = (resolve.samples, resolve.target);
        let place = (step, member.pass, target.resource);
        let seen = |a: Access| a.range.view.or(ctx.format(a.resource));
        fits(ctx, seen(target), seen(samples), place);
        let declared = &ctx.graph.accesses()[resolve.id];
        ctx.report.require(!in_store(ctx, declared), Rule::Resolve, place, "the device can resolve it while storing");
        made += 1;
    }
    let rows = ctx.plan.attachments_of(step).len();
    ctx.report.equal(rows, made, Rule::Resolve, (step, member.pass), "its targets");
}

/// Checks that a target has the format of its source, or of its depth plane.
fn fits(ctx: &RuleInput<'_>, target: Option<Format>, samples: Option<Format>, place: impl Into<super::finding::Place>) {
    let samples = samples.map(|format| match format {
        Format::Depth24PlusStencil8 => Format::Depth24Plus,
        Format::Depth32FloatStencil8 => Format::Depth32Float,
        other => other,
    });
    ctx.report.equal(target, samples, Rule::Resolve, place, "its format");
}

/// Returns `true` if the device performs a resolve while storing.
pub(super) fn in_store(ctx: &RuleInput<'_>, resolve: &Access) -> bool {
    let caps = ctx.plan.caps();
    let modes = if resolve.slot == Access::DEPTH { caps.depth_resolves } else { caps.color_resolves };
    let apart = resolve.resolve == ResolveMode::Average
        && ctx.texture(resolve.resource).is_some_and(|t| !caps.averages(t.format));
    modes.has(resolve.resolve) && !apart
}
