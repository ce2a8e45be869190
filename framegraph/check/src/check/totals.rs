//! Recomputes the memory statistics of the plan and its lower bound.

use super::finding::Rule;
use super::memory::{Region, images};
use super::rule_input::RuleInput;
use super::tenants::{life, reserved, without_srgb};
use framegraph::id::{ResourceId, StepId};
use framegraph::options::Alias;
use framegraph::plan::{Memory, Placement};
use framegraph::resource::Kind;
use std::collections::HashMap;

/// Compares the statistics of shared and unshared memory.
pub(super) fn totals(ctx: &RuleInput<'_>) {
    let found = ctx.plan.memory();
    let heap = ctx.plan.options().alias == Alias::Heap && ctx.plan.caps().placed;
    let mut sums = if heap { heaps(ctx, &found) } else { slots(ctx) };
    for resource in ctx.graph.resource_ids() {
        let row = ctx.planned(resource);
        match (row.placement, ctx.kind(resource)) {
            (Placement::Memoryless | Placement::Inlined, _) => add(&mut sums.avoided_bytes, row.bytes),
            // Earlier images are part of the current one's ring.
            (Placement::Own, Kind::HistoryPrevious { .. }) => {}
            (Placement::Own, _) => add(&mut sums.own_bytes, row.bytes.saturating_mul(images(ctx.plan, resource))),
            _ => {}
        }
    }
    ctx.report.equal(found, sums, Rule::Memory, (), "memory()");
}

fn add(sum: &mut u64, bytes: u64) {
    *sum = sum.saturating_add(bytes);
}

/// Returns the live bytes of each step.
fn live(ctx: &RuleInput<'_>, items: &[(StepId, StepId, u64)]) -> Vec<u64> {
    let mut changes = vec![0i128; ctx.plan.steps().len() + 1];
    for (first, last, bytes) in items {
        changes[first.index()] += i128::from(*bytes);
        changes[last.index() + 1] -= i128::from(*bytes);
    }
    let sums = changes.iter().scan(0i128, |sum, change| {
        *sum += change;
        Some(u64::try_from(*sum).unwrap_or(u64::MAX))
    });
    sums.take(ctx.plan.steps().len()).collect()
}

/// Returns the statistics of a pool.
fn slots(ctx: &RuleInput<'_>) -> Memory {
    let rows = ctx.plan.resources().iter();
    let shared = rows.filter(|r| matches!(r.placement, Placement::Slot(_)) && !r.first.is_none());
    let items: Vec<_> = shared.map(|r| (r.first, r.last, r.bytes)).collect();
    let live = live(ctx, &items);
    let most = live.iter().copied().max().unwrap_or(0);
    let peak = live.iter().position(|bytes| *bytes == most && most > 0);
    let bytes = ctx.plan.slots().iter().map(|s| s.bytes).fold(0, u64::saturating_add);
    Memory {
        unaliased_bytes: items.iter().map(|i| i.2).fold(0, u64::saturating_add),
        bytes,
        lower_bound_bytes: most,
        optimal: bytes == min_pool(ctx),
        peak: peak.map_or(StepId::NONE, StepId::at),
        ..Memory::default()
    }
}

/// Returns the statistics of the heaps. A lower bound above the maximum of live bytes comes from alignment or from a
/// search. It is only checked to lie in its valid interval; tests compare it with brute force.
fn heaps(ctx: &RuleInput<'_>, found: &Memory) -> Memory {
    let mut sums = Memory::default();
    let (mut peaks, mut highest, mut at_peak) = (0u64, 0, false);
    for heap in 0..2 {
        let (mut items, mut top) = (Vec::new(), 0);
        for resource in ctx.graph.resource_ids() {
            if let Region::Bytes { heap: own, start, end } = reserved(ctx, resource)
                && own == heap
            {
                let (first, last) = life(ctx, resource);
                items.push((first, last, end - start));
                top = end.max(top);
            }
        }
        items.retain(|(first, ..)| !first.is_none());
        let live = live(ctx, &items);
        let most = live.iter().copied().max().unwrap_or(0);
        add(&mut peaks, most);
        if most > highest {
            highest = most;
            at_peak = live.get(found.peak.index()) == Some(&most);
        }
        add(&mut sums.bytes, top);
        items.iter().for_each(|i| add(&mut sums.unaliased_bytes, i.2));
    }
    let bound = found.lower_bound_bytes;
    let why = format_args!("the lower bound {bound} is not between the peak {peaks} and the size {}", sums.bytes);
    ctx.report.require(peaks <= bound && bound <= sums.bytes, Rule::Memory, (), why);
    let why = format_args!("{:?} is not the step with the most live bytes", found.peak);
    ctx.report.require(at_peak || highest == 0, Rule::Memory, (), why);
    sums.lower_bound_bytes = bound;
    sums.optimal = bound == sums.bytes;
    sums.peak = if highest == 0 { StepId::NONE } else { found.peak };
    sums
}

/// Returns the minimum size of a pool: for each shape, as many slots as resources that are live at the same time.
fn min_pool(ctx: &RuleInput<'_>) -> u64 {
    let shared = ctx.plan.options().alias != Alias::Off;
    let mut shapes: HashMap<_, Vec<ResourceId>> = HashMap::new();
    for resource in ctx.graph.resource_ids() {
        if let Placement::Slot(slot) = ctx.placement(resource) {
            let shape = without_srgb(ctx.plan.slots()[slot.index()].desc);
            let alone = if shared { ResourceId::NONE } else { resource };
            shapes.entry((shape, alone)).or_default().push(resource);
        }
    }
    let of_shape = |tenants: &Vec<ResourceId>| {
        // Starts are sorted before ends, because both resources are live in a common step.
        let rows = tenants.iter().map(|r| ctx.planned(*r));
        let mut changes: Vec<(StepId, i64)> = rows.flat_map(|row| [(row.first, -1), (row.last, 1)]).collect();
        changes.sort_unstable();
        let counts = changes.iter().scan(0i64, |live, (_, change)| {
            *live -= change;
            Some(*live)
        });
        let most = u64::try_from(counts.max().unwrap_or(0)).unwrap_or(0);
        tenants.first().map_or(0, |r| ctx.planned(*r).bytes).saturating_mul(most)
    };
    shapes.values().map(of_shape).fold(0, u64::saturating_add)
}
