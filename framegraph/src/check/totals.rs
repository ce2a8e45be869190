//! Sums over the plan, worked out anew: memory with its lower bound, counts, traffic.

use super::case::Case;
use super::finding::{Findings, Place, Rule};
use super::memory::{Place as Where, images};
use super::tenants::{life, reserved};
use crate::counts::{Counts, Traffic};
use crate::id::{ResourceId, StepId};
use crate::options::Alias;
use crate::plan::{Attachment, LoadOp, Memory, Placement, Role, StoreOp};
use crate::resource::{Desc, Kind};
use std::collections::BTreeMap;

/// Examines all sums.
pub(super) fn totals(case: &Case<'_>, findings: &mut Findings<'_>) {
    memory(case, findings);
    let whole = Place::default();
    let (counts, traffic) = attachments(case);
    findings.equal(case.plan.counts(), counts, Rule::Counts, whole, "counts()");
    let found = case.plan.traffic(case.plan.frame());
    findings.equal(found, traffic, Rule::Counts, whole, "traffic()");
}

/// The figures of the memory that is shared, and of what is not.
fn memory(case: &Case<'_>, findings: &mut Findings<'_>) {
    let found = case.plan.memory();
    let heap = case.plan.options().alias == Alias::Heap && case.plan.caps().placed;
    let mut sums = if heap { heaps(case, &found, findings) } else { slots(case) };
    for resource in case.graph.resource_ids() {
        let row = &case.plan.resources()[resource.index()];
        match row.placement {
            Placement::Memoryless | Placement::Inlined => {
                sums.avoided_bytes = sums.avoided_bytes.saturating_add(row.bytes);
            }
            Placement::Own => {
                let earlier = matches!(case.graph.resources()[resource.index()].kind, Kind::HistoryPrevious { .. });
                // Earlier images are part of the ring of the current one.
                let images = if earlier { 0 } else { images(case.plan, resource) };
                let bytes = row.bytes.saturating_mul(images);
                sums.own_bytes = sums.own_bytes.saturating_add(bytes);
            }
            _ => {}
        }
    }
    findings.equal(found, sums, Rule::Memory, Place::default(), "memory()");
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
    let at = live.iter().position(|bytes| *bytes == most && most > 0);
    let sum = |bytes: u64, more: u64| bytes.saturating_add(more);
    let bytes = case.plan.slots().iter().map(|s| s.bytes).fold(0, sum);
    Memory {
        unaliased_bytes: items.iter().map(|i| i.2).fold(0, sum),
        bytes,
        lower_bound_bytes: most,
        optimal: bytes == least_pool(case),
        peak: at.map_or(StepId::NONE, StepId::at),
        ..Memory::default()
    }
}

/// The figures of the heaps. A bound above the peak of live bytes comes from alignment or from a search; it can be judged
/// only by what it must lie between, and by brute force, which tests do.
fn heaps(case: &Case<'_>, found: &Memory, findings: &mut Findings<'_>) -> Memory {
    let whole = Place::default();
    let mut sums = Memory::default();
    let (mut peaks, mut highest, mut at_peak) = (0u64, 0, false);
    for heap in 0..2 {
        let mut items = Vec::new();
        let mut top = 0;
        for resource in case.graph.resource_ids() {
            match reserved(case, resource) {
                Where::Bytes { heap: own, start, end } if own == heap => {
                    let (first, last) = life(case, resource);
                    items.push((first, last, end - start));
                    top = end.max(top);
                }
                _ => {}
            }
        }
        items.retain(|(first, ..)| !first.is_none());
        let live = live(case, &items);
        let most = live.iter().copied().max().unwrap_or(0);
        peaks = peaks.saturating_add(most);
        if most > highest {
            highest = most;
            at_peak = live.get(found.peak.index()) == Some(&most);
        }
        sums.bytes = sums.bytes.saturating_add(top);
        let all = items.iter().map(|i| i.2);
        sums.unaliased_bytes = all.fold(sums.unaliased_bytes, u64::saturating_add);
    }
    let bound = found.lower_bound_bytes;
    findings.require(peaks <= bound && bound <= sums.bytes, Rule::Memory, whole, || {
        format!("the lower bound is {bound}, the peak {peaks}, taken are {}", sums.bytes)
    });
    findings.require(at_peak || highest == 0, Rule::Memory, whole, || {
        format!("{:?} is not where the most bytes are live", found.peak)
    });
    sums.lower_bound_bytes = bound;
    sums.optimal = bound == sums.bytes;
    sums.peak = if highest == 0 { StepId::NONE } else { found.peak };
    sums
}

/// The least bytes that sharing by shape can take: for each shape, as many slots as are ever live at once.
fn least_pool(case: &Case<'_>) -> u64 {
    let mut shapes: BTreeMap<String, Vec<ResourceId>> = BTreeMap::new();
    for resource in case.graph.resource_ids() {
        if let Placement::Slot(slot) = case.plan.resources()[resource.index()].placement {
            let desc = &case.plan.slots()[slot.index()].desc;
            let shape = if case.plan.options().alias == Alias::Off {
                format!("{resource:?}")
            } else {
                match desc {
                    Desc::Texture(t) => format!("{:?}", t.format(t.format.linear_twin())),
                    Desc::Buffer(b) => format!("{b:?}"),
                }
            };
            shapes.entry(shape).or_default().push(resource);
        }
    }
    let mut sum = 0u64;
    for tenants in shapes.values() {
        // Births before deaths within a step: both tenants are live there.
        let mut changes: Vec<(StepId, i64)> = Vec::new();
        for row in tenants.iter().map(|r| &case.plan.resources()[r.index()]) {
            changes.extend([(row.first, -1), (row.last, 1)]);
        }
        changes.sort_unstable();
        let counts = changes.iter().scan(0i64, |live, (_, change)| {
            *live -= change;
            Some(*live)
        });
        let most = u64::try_from(counts.max().unwrap_or(0)).unwrap_or(0);
        let bytes = tenants.first().map_or(0, |r| case.plan.resources()[r.index()].bytes);
        sum = sum.saturating_add(bytes.saturating_mul(most));
    }
    sum
}

/// Counts and traffic, from the ops of all attachments.
fn attachments(case: &Case<'_>) -> (Counts, Traffic) {
    let plan = case.plan;
    let mut counts = Counts::default();
    let mut traffic = Traffic::default();
    let placed = |wanted: Placement| {
        let rows = plan.resources().iter().filter(|r| r.placement == wanted);
        rows.count() as u32
    };
    counts.memoryless = placed(Placement::Memoryless);
    counts.inlined = placed(Placement::Inlined);
    counts.steps = plan.steps().len() as u32;
    counts.render_passes = plan.step_ids().filter(|s| case.is_raster(*s)).count() as u32;
    counts.passes = plan.step_passes().len() as u32;
    counts.culled = case.position.iter().filter(|p| p.is_none()).count() as u32;
    for attachment in plan.attachments() {
        let ops = planes(case, attachment);
        let texels = texels(case, attachment);
        let any = |holds: &dyn Fn(&Plane) -> bool| ops.iter().any(holds);
        let stored = any(&|p| p.store == StoreOp::Store);
        counts.unresolves += u32::from(any(&|p| p.load == LoadOp::Load));
        counts.resolves += u32::from(stored);
        counts.clears += u32::from(any(&|p| p.load == LoadOp::Clear));
        // A resolve target that is not stored stands for an average that is not made.
        let resolve = matches!(attachment.role, Role::Resolve(_));
        counts.discards += u32::from(!stored && !resolve && any(&|p| p.store == StoreOp::Discard));
        counts.multisample_resolves += u32::from(resolve && stored);
        for plane in &ops {
            let bytes = texels.saturating_mul(plane.texel_bytes);
            if plane.load == LoadOp::Load {
                traffic.loaded_bytes = traffic.loaded_bytes.saturating_add(bytes);
            }
            if plane.store == StoreOp::Store {
                traffic.stored_bytes = traffic.stored_bytes.saturating_add(bytes);
                if resolve {
                    traffic.resolved_bytes = traffic.resolved_bytes.saturating_add(bytes);
                }
            }
        }
    }
    (counts, traffic)
}

/// One plane of an attachment.
struct Plane {
    load: LoadOp,
    store: StoreOp,
    texel_bytes: u64,
}

/// The planes of an attachment; depth takes what stencil leaves of a texel.
fn planes(case: &Case<'_>, attachment: &Attachment) -> Vec<Plane> {
    let Some(format) = case.format(attachment.resource) else {
        return Vec::new();
    };
    let texel = u64::from(format.block_bytes());
    let both = format.has_depth() && format.has_stencil();
    let first =
        Plane { load: attachment.load, store: attachment.store, texel_bytes: if both { texel - 1 } else { texel } };
    let stencil =
        both.then_some(Plane { load: attachment.stencil_load, store: attachment.stencil_store, texel_bytes: 1 });
    std::iter::once(first).chain(stencil).collect()
}

/// Samples of all texels that an attachment covers.
fn texels(case: &Case<'_>, attachment: &Attachment) -> u64 {
    let resource = &case.graph.resources()[attachment.resource.index()];
    resource.desc.texture().map_or(0, |t| {
        let [w, h] = t.mip_extent(case.plan.frame(), attachment.mip.into());
        let samples = u64::from(t.samples) * u64::from(attachment.layers);
        (u64::from(w) * u64::from(h)).saturating_mul(samples)
    })
}
