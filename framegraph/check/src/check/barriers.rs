//! Checks the barriers: every use of a part must have its layout and wait for conflicting uses.
//!
//! A second state machine next to the one for contents. For each part it tracks the layout, and if the last use wrote.
//! It also tracks the stages of uses since the last barrier (*pending*), and the destination stages of that barrier
//! (*admitted*).
//!
//! A use needs a barrier if it is the first, if it or the previous use writes, or if the layout differs. Otherwise its
//! stages must be admitted, because the last barrier made the contents visible only to its destination stages.
//!
//! A barrier waits for exactly the pending stages; a chain of barriers covers earlier ones. The first use of a resource
//! waits for the pending stages of all previous resources in its memory.

use super::finding::{Place, Rule};
use super::rule_input::{PlannedAccess, RuleInput};
use super::subresource::whole_levels;
use super::tenants::EarlierTenants;
use framegraph::access::{Access, AccessKind, Range};
use framegraph::barrier::{Barrier, Stages, State};
use framegraph::graph::PassKind;
use framegraph::id::{ResourceId, StepId};
use framegraph::plan::Placement;
use framegraph::resource::{Entry, Kind};
use std::collections::BTreeMap;

/// The synchronization state of one part.
#[derive(Clone, Copy, Debug, Default)]
struct Sync {
    state: State,
    wrote: bool,
    pending: Stages,
    admitted: Stages,
    /// The barrier that admitted the stages.
    barrier: Option<usize>,
    /// The step that used the part last.
    last: StepId,
}

/// The use of one part by one step.
#[derive(Clone, Copy, Debug)]
struct PartUse {
    part: usize,
    resource: ResourceId,
    state: State,
    stages: Stages,
    writes: bool,
}

/// Examines the barriers of a plan.
pub(super) fn barriers(ctx: &RuleInput<'_>, earlier: &EarlierTenants) {
    let rows = ctx.plan.barriers();
    if !ctx.plan.caps().explicit_barriers {
        return ctx.report.require(
            rows.is_empty(),
            Rule::Barrier,
            (),
            "the plan has barriers, but the device needs none",
        );
    }
    let key = |b: &Barrier| (b.before, b.resource, b.first_part);
    let sorted = rows.windows(2).all(|w| key(&w[0]) < key(&w[1]));
    ctx.report.require(sorted, Rule::Barrier, (), "the barriers are out of order");
    let mut syncs = on_entry(ctx);
    let mut used = 0;
    let mut admitted = vec![Stages::NONE; rows.len()];
    for step in ctx.plan.step_ids() {
        let here = used..used + rows[used..].iter().take_while(|b| b.before == step).count();
        used = here.end;
        let mut over: BTreeMap<usize, usize> = BTreeMap::new();
        for index in here {
            for part in covered(ctx, &rows[index]) {
                if over.insert(part, index).is_some() {
                    let place = (step, rows[index].resource);
                    ctx.report.violation(Rule::Barrier, place, "two barriers on one part");
                }
            }
        }
        let needs = needs(ctx, step);
        let beside: Vec<_> = needs.iter().map(|need| beside(ctx, &syncs, need.resource)).collect();
        for (need, beside) in needs.into_iter().zip(beside) {
            let index = over.remove(&need.part);
            let barrier = index.map(|i| &rows[i]);
            let place = (step, need.resource, ctx.parts.name(need.resource, need.part));
            let owners = &earlier[need.resource.index()];
            judge(ctx, &syncs, &need, barrier, owners, beside, place.into());
            let sync = &mut syncs[need.part];
            settle(sync, &need, index.zip(barrier), step);
            if let Some(barrier) = sync.barrier {
                admitted[barrier] = admitted[barrier].union(need.stages);
            }
        }
        for barrier in over.into_values() {
            let place = (step, rows[barrier].resource);
            ctx.report.violation(Rule::Barrier, place, "a barrier on a part that the step does not use");
        }
    }
    for (barrier, admitted) in rows.iter().zip(admitted) {
        let (found, expected) = (names(barrier.to_stages), names(admitted));
        ctx.report.equal(found, expected, Rule::Barrier, (barrier.before, barrier.resource), "to_stages");
    }
    ctx.report.require(used == rows.len(), Rule::Barrier, (), "a barrier precedes no step");
}

fn on_entry(ctx: &RuleInput<'_>) -> Vec<Sync> {
    let mut syncs = vec![Sync::default(); ctx.parts.total()];
    for (id, resource) in ctx.graph.resource_ids().zip(ctx.graph.resources()) {
        let entry = match resource.kind {
            Kind::Imported { entry: Entry::Left { state, stages }, .. } => {
                Sync { state, pending: stages, ..Sync::default() }
            }
            Kind::Imported { entry: Entry::Defined, .. } | Kind::HistoryPrevious { .. } => {
                Sync { state: State::Entry, ..Sync::default() }
            }
            _ => continue,
        };
        syncs[ctx.parts.all(id)].fill(entry);
    }
    syncs
}

/// Returns the parts that a barrier covers. Its numbering runs over levels first, then layers, then planes.
fn covered(ctx: &RuleInput<'_>, barrier: &Barrier) -> Vec<usize> {
    let [mips, layers, planes] = ctx.parts.counts(barrier.resource);
    let end = barrier.first_part.saturating_add(barrier.parts);
    let numbers = barrier.first_part..end.min(mips * layers * planes);
    let parts = |number| {
        let (mip, layer, plane) = (number % mips, number / mips % layers, number / (mips * layers));
        // A barrier covers all slices of a level. Numbers fit, because the structure was checked.
        let layer = if layers == 1 { Range::ALL } else { Range { layer: layer as u16, layers: 1, ..Range::ALL } };
        let range = Range { mip: mip as u8, mips: 1, ..layer };
        ctx.parts.covered(barrier.resource, range).filter(move |part| {
            let name = ctx.parts.name(barrier.resource, *part);
            planes == 1 || name.plane == plane
        })
    };
    numbers.flat_map(parts).collect()
}

/// Returns the layout and stages of one access.
fn wanted(kind: PassKind, touch: &PlannedAccess, in_tile: bool) -> (State, Stages) {
    let shader = match kind {
        PassKind::Raster => Stages::SHADER,
        PassKind::Compute => Stages::COMPUTE,
        PassKind::Copy => Stages::COPY,
    };
    match touch.access.kind {
        AccessKind::Resolve if touch.access.slot == Access::DEPTH => (State::DepthAttachment, Stages::COLOR),
        AccessKind::Color | AccessKind::Resolve => (State::ColorAttachment, Stages::COLOR),
        AccessKind::Depth => (State::DepthAttachment, Stages::DEPTH),
        AccessKind::DepthReadOnly => (State::DepthReadOnly, Stages::DEPTH),
        AccessKind::SamePixel if in_tile => (State::InputAttachment, Stages::SHADER),
        AccessKind::SamePixel | AccessKind::Sampled => (State::Sampled, shader),
        AccessKind::StorageRead | AccessKind::StorageWrite => (State::Storage, shader),
        AccessKind::Uniform => (State::Uniform, shader),
        AccessKind::Vertex | AccessKind::Index => (State::VertexInput, Stages::VERTEX_INPUT),
        AccessKind::Indirect => (State::Indirect, Stages::INDIRECT),
        AccessKind::CopySource => (State::CopySource, Stages::COPY),
        AccessKind::CopyTarget => (State::CopyTarget, Stages::COPY),
    }
}

/// Returns the use of each part by a step. Writers determine the layout, then attachments; all stages count. An
/// attachment uses all its planes.
fn needs(ctx: &RuleInput<'_>, step: StepId) -> Vec<PartUse> {
    let kind = ctx.step(step).kind;
    let mut needs: BTreeMap<usize, PartUse> = BTreeMap::new();
    for attachment in ctx.plan.attachments_of(step) {
        let resource = attachment.resource;
        let (state, stages, writes) = (State::DepthReadOnly, Stages::DEPTH, false);
        if ctx.texture(resource).is_some_and(|t| t.format.has_depth() && t.format.has_stencil()) {
            needs
                .extend(ctx.attached(attachment).map(|part| (part, PartUse { part, resource, state, stages, writes })));
        }
    }
    for (member, touch) in ctx.accesses_by(ctx.plan.passes_of(step)) {
        let (state, stages) = wanted(kind, &touch, ctx.in_tile(step, member, &touch));
        let writes = touch.access.mode.writes();
        for part in ctx.parts.covered(touch.resource, whole_levels(touch.range)) {
            let need = needs.entry(part).or_insert(PartUse { part, resource: touch.resource, state, stages, writes });
            // The layout of a storage texture also supports sampling.
            let rank = |writes: bool, state: State| (!writes, state != State::Storage, state);
            if rank(writes, state) < rank(need.writes, need.state) {
                need.state = state;
            }
            need.stages = need.stages.union(stages);
            need.writes |= writes;
        }
        // Depth is resolved in the color output stage.
        let depth = touch.access.kind == AccessKind::Resolve && touch.access.slot == Access::DEPTH;
        let samples = Some(()).filter(|()| depth).and_then(|()| ctx.averaged(member, &touch));
        if let Some(samples) = samples {
            for part in ctx.parts.covered(samples.resource, samples.range) {
                if let Some(need) = needs.get_mut(&part) {
                    need.stages = need.stages.union(Stages::COLOR);
                }
            }
        }
    }
    needs.into_values().collect()
}

/// Returns the last step and the pending stages of the imports that may alias a resource, before a step.
fn beside(ctx: &RuleInput<'_>, syncs: &[Sync], resource: ResourceId) -> Option<(StepId, Stages)> {
    let others = ctx.graph.resource_ids().filter(|other| ctx.graph.are_aliases(resource, *other));
    let used = others.flat_map(|other| &syncs[ctx.parts.all(other)]).filter(|sync| !sync.last.is_none());
    used.map(|sync| (sync.last, sync.pending)).reduce(|a, b| (a.0.max(b.0), a.1.union(b.1)))
}

/// Checks one use against the barrier before it, if any.
fn judge(
    ctx: &RuleInput<'_>,
    syncs: &[Sync],
    need: &PartUse,
    barrier: Option<&Barrier>,
    owners: &[ResourceId],
    beside: Option<(StepId, Stages)>,
    place: Place,
) {
    let sync = syncs[need.part];
    let first = sync.last.is_none();
    let overtaken = beside.is_some_and(|(step, _)| first || step > sync.last);
    let conflict = first || need.writes || sync.wrote || sync.state != need.state || overtaken;
    let Some(barrier) = barrier else {
        // A buffer has no layout, so new memory needs no barrier.
        let external = ctx.placement(need.resource) == Placement::External;
        let silent = first && ctx.texture(need.resource).is_none() && !external && owners.is_empty();
        let why = format_args!("used as {:?} after {:?} without a barrier", need.state, sync.state);
        ctx.report.require(silent || !conflict, Rule::Barrier, place, why);
        if !silent && !conflict && !sync.admitted.contains(need.stages) {
            let names: Vec<_> = need.stages.names().collect();
            let why = format_args!("used by {}, but not admitted by a barrier", names.join(", "));
            ctx.report.violation(Rule::Barrier, place, why);
        }
        return;
    };
    ctx.report.require(conflict, Rule::Barrier, place, "a barrier between two reads of one layout");
    let (mut pending, mut after, mut before) = (sync.pending, sync.last, ResourceId::NONE);
    if first {
        for owner in owners {
            let stages = syncs[ctx.parts.all(*owner)].iter().map(|s| s.pending);
            pending = stages.fold(pending, Stages::union);
        }
        // If several previous resources end in the same step, the barrier may name any of them.
        let last = |r: ResourceId| ctx.planned(r).last;
        if let Some(latest) = owners.iter().map(|r| last(*r)).max() {
            let among = |r: &ResourceId| last(*r) == latest;
            let named = Some(barrier.aliases).filter(|r| owners.contains(r) && among(r));
            let any = owners.iter().copied().find(among);
            (after, before) = (latest, named.or(any).unwrap_or(before));
        }
    }
    if let Some((step, stages)) = beside {
        pending = pending.union(stages);
        after = if overtaken { step } else { after };
    }
    ctx.report.equal(barrier.from, sync.state, Rule::Barrier, place, "from");
    ctx.report.equal(barrier.to, need.state, Rule::Barrier, place, "to");
    ctx.report.equal(names(barrier.from_stages), names(pending), Rule::Barrier, place, "from_stages");
    ctx.report.equal(barrier.after, after, Rule::Barrier, place, "after");
    ctx.report.equal(barrier.aliases, before, Rule::Barrier, place, "aliases");
}

/// Returns the names of stages, for readable reports.
fn names(stages: Stages) -> Vec<&'static str> {
    stages.names().collect()
}

fn settle(sync: &mut Sync, need: &PartUse, barrier: Option<(usize, &Barrier)>, step: StepId) {
    if let Some((index, barrier)) = barrier {
        sync.pending = Stages::NONE;
        sync.admitted = barrier.to_stages;
        sync.barrier = Some(index);
    } else if sync.last.is_none() {
        sync.admitted = need.stages;
    }
    sync.state = need.state;
    sync.wrote = need.writes;
    sync.pending = sync.pending.union(need.stages);
    sync.last = step;
}
