//! Sums over the plan, worked out anew: memory with its lower bound, counts, traffic.

use super::case::Case;
use super::finding::Rule;
use super::memory::{Region, images};
use super::tenants::{life, reserved, without_srgb};
use crate::counts::{Counts, Traffic};
use crate::id::{ResourceId, StepId};
use crate::options::Alias;
use crate::plan::{Attachment, LoadOp, Memory, Placement, Role, StoreOp};
use crate::resource::Kind;
use std::collections::HashMap;

/// Examines all sums.
pub(super) fn totals(case: &Case<'_>) {
    memory(case);
    let (counts, traffic) = attachments(case);
    case.report.equal(case.plan.counts(), counts, Rule::Counts, (), "counts()");
    case.report.equal(case.plan.traffic(case.plan.frame()), traffic, Rule::Counts, (), "traffic()");
}

/// The figures of the memory that is shared, and of what is not.
fn memory(case: &Case<'_>) {
    let found = case.plan.memory();
    let heap = case.plan.options().alias == Alias::Heap && case.plan.caps().placed;
    let mut sums = if heap { heaps(case, &found) } else { slots(case) };
    for resource in case.graph.resource_ids() {
        let row = case.planned(resource);
        match (row.placement, case.kind(resource)) {
            (Placement::Memoryless | Placement::Inlined, _) => add(&mut sums.avoided_bytes, row.bytes),
            // Earlier images are part of the ring of the current one.
            (Placement::Own, Kind::HistoryPrevious { .. }) => {}
            (Placement::Own, _) => add(&mut sums.own_bytes, row.bytes.saturating_mul(images(case.plan, resource))),
            _ => {}
        }
    }
    case.report.equal(found, sums, Rule::Memory, (), "memory()");
}

fn add(sum: &mut u64, bytes: u64) {
    *sum = sum.saturating_add(bytes);
}

/// Live bytes at each step.
fn live(case: &Case<'_>, items: &[(StepId, StepId, u64)]) -> Vec<u64> {
    let mut changes = vec![0i128; case.plan.steps().len() + 1];
    for (first, last, bytes) in items {
        changes[first.index()] += i128::from(*bytes);
        changes[last.index() + 1] -= i128::from(*bytes);
    }
    let sums = changes.iter().scan(0i128, |sum, change| {
        *sum += change;
        Some(u64::try_from(*sum).unwrap_or(u64::MAX))
    });
    sums.take(case.plan.steps().len()).collect()
}

/// The figures of a pool.
fn slots(case: &Case<'_>) -> Memory {
    let rows = case.plan.resources().iter();
    let shared = rows.filter(|r| matches!(r.placement, Placement::Slot(_)) && !r.first.is_none());
    let items: Vec<_> = shared.map(|r| (r.first, r.last, r.bytes)).collect();
    let live = live(case, &items);
    let most = live.iter().copied().max().unwrap_or(0);
    let peak = live.iter().position(|bytes| *bytes == most && most > 0);
    let bytes = case.plan.slots().iter().map(|s| s.bytes).fold(0, u64::saturating_add);
    Memory {
        unaliased_bytes: items.iter().map(|i| i.2).fold(0, u64::saturating_add),
        bytes,
        lower_bound_bytes: most,
        optimal: bytes == least_pool(case),
        peak: peak.map_or(StepId::NONE, StepId::at),
        ..Memory::default()
    }
}

/// The figures of the heaps. A bound above the peak of live bytes comes from alignment or from a search; it can be judged
/// only by what it must lie between, and by brute force, which tests do.
fn heaps(case: &Case<'_>, found: &Memory) -> Memory {
    let mut sums = Memory::default();
    let (mut peaks, mut highest, mut at_peak) = (0u64, 0, false);
    for heap in 0..2 {
        let (mut items, mut top) = (Vec::new(), 0);
        for resource in case.graph.resource_ids() {
            if let Region::Bytes { heap: own, start, end } = reserved(case, resource)
                && own == heap
            {
                let (first, last) = life(case, resource);
                items.push((first, last, end - start));
                top = end.max(top);
            }
        }
        items.retain(|(first, ..)| !first.is_none());
        let live = live(case, &items);
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
    let why = format_args!("the lower bound is {bound}, the peak {peaks}, taken are {}", sums.bytes);
    case.report.require(peaks <= bound && bound <= sums.bytes, Rule::Memory, (), why);
    let why = format_args!("{:?} is not where the most bytes are live", found.peak);
    case.report.require(at_peak || highest == 0, Rule::Memory, (), why);
    sums.lower_bound_bytes = bound;
    sums.optimal = bound == sums.bytes;
    sums.peak = if highest == 0 { StepId::NONE } else { found.peak };
    sums
}

/// The least bytes that sharing by shape can take: for each shape, as many slots as are ever live at once.
fn least_pool(case: &Case<'_>) -> u64 {
    let shared = case.plan.options().alias != Alias::Off;
    let mut shapes: HashMap<_, Vec<ResourceId>> = HashMap::new();
    for resource in case.graph.resource_ids() {
        if let Placement::Slot(slot) = case.placement(resource) {
            let shape = without_srgb(case.plan.slots()[slot.index()].desc);
            let alone = if shared { ResourceId::NONE } else { resource };
            shapes.entry((shape, alone)).or_default().push(resource);
        }
    }
    let of_shape = |tenants: &Vec<ResourceId>| {
        // Births before deaths within a step: both tenants are live there.
        let rows = tenants.iter().map(|r| case.planned(*r));
        let mut changes: Vec<(StepId, i64)> = rows.flat_map(|row| [(row.first, -1), (row.last, 1)]).collect();
        changes.sort_unstable();
        let counts = changes.iter().scan(0i64, |live, (_, change)| {
            *live -= change;
            Some(*live)
        });
        let most = u64::try_from(counts.max().unwrap_or(0)).unwrap_or(0);
        tenants.first().map_or(0, |r| case.planned(*r).bytes).saturating_mul(most)
    };
    shapes.values().map(of_shape).fold(0, u64::saturating_add)
}

/// Counts and traffic, from the ops of all attachments.
fn attachments(case: &Case<'_>) -> (Counts, Traffic) {
    let plan = case.plan;
    let placed = |wanted: Placement| plan.resources().iter().filter(|r| r.placement == wanted).count() as u32;
    let mut counts = Counts {
        memoryless: placed(Placement::Memoryless),
        inlined: placed(Placement::Inlined),
        steps: plan.steps().len() as u32,
        render_passes: plan.step_ids().filter(|s| case.is_raster(*s)).count() as u32,
        passes: plan.step_passes().len() as u32,
        culled: case.position.iter().filter(|p| p.is_none()).count() as u32,
        ..Counts::default()
    };
    let mut traffic = Traffic::default();
    for attachment in plan.attachments() {
        let planes = planes(case, attachment);
        let texels = texels(case, attachment);
        let loaded = |op: LoadOp| planes.iter().any(|(load, ..)| *load == op);
        let left = |op: StoreOp| planes.iter().any(|(_, store, _)| *store == op);
        let stored = left(StoreOp::Store);
        // A resolve target that is not stored stands for an average that is not made.
        let resolve = matches!(attachment.role, Role::Resolve(_));
        counts.unresolves += u32::from(loaded(LoadOp::Load));
        counts.resolves += u32::from(stored);
        counts.clears += u32::from(loaded(LoadOp::Clear));
        counts.discards += u32::from(!stored && !resolve && left(StoreOp::Discard));
        counts.multisample_resolves += u32::from(resolve && stored);
        for (load, store, texel_bytes) in planes {
            let bytes = texels.saturating_mul(texel_bytes);
            let if_so = |so: bool| if so { bytes } else { 0 };
            add(&mut traffic.loaded_bytes, if_so(load == LoadOp::Load));
            add(&mut traffic.stored_bytes, if_so(store == StoreOp::Store));
            add(&mut traffic.resolved_bytes, if_so(store == StoreOp::Store && resolve));
        }
    }
    (counts, traffic)
}

/// The planes of an attachment, each with its ops and its bytes a texel; depth takes what stencil leaves of a texel.
fn planes(case: &Case<'_>, attachment: &Attachment) -> Vec<(LoadOp, StoreOp, u64)> {
    let Some(format) = case.format(attachment.resource) else {
        return Vec::new();
    };
    let texel = u64::from(format.block_bytes());
    let both = format.has_depth() && format.has_stencil();
    let first = (attachment.load, attachment.store, texel - u64::from(both));
    let stencil = both.then_some((attachment.stencil_load, attachment.stencil_store, 1));
    std::iter::once(first).chain(stencil).collect()
}

/// Samples of all texels that an attachment covers.
fn texels(case: &Case<'_>, attachment: &Attachment) -> u64 {
    case.texture(attachment.resource).map_or(0, |t| {
        let [w, h] = t.mip_extent(case.plan.frame(), attachment.mip.into());
        let samples = u64::from(t.samples) * u64::from(attachment.layers);
        (u64::from(w) * u64::from(h)).saturating_mul(samples)
    })
}
