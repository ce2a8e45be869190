//! Which steps of a plan must be over before which: for contents, and for memory that resources share.

use framegraph::{Access, Placement, Plan, ResourceId};
use std::collections::HashSet;

/// Of each step, the earlier steps that it depends on, the latest first; more than need be said, since some follow from others.
pub fn dependencies(plan: &Plan) -> Vec<Vec<u32>> {
    let mut found = vec![Vec::new(); plan.steps().len()];
    let touched = accesses_by_resource(plan);
    let moved = moved(plan);
    for (resource, accesses) in touched.iter().enumerate() {
        let resource = ResourceId::at(resource);
        let changes = |step: u32, access: &Access| access.mode.writes() || moved.contains(&(step, resource));
        for (later, (step, access)) in accesses.iter().enumerate() {
            for (earlier, other) in accesses[..later].iter().rev() {
                let ordered = changes(*step, access) || changes(*earlier, other);
                if earlier != step && ordered && plan.graph().overlap(resource, &access.range, &other.range) {
                    found[*step as usize].push(*earlier);
                    // Whoever was before a change of all of it is waited for by that change.
                    if changes(*earlier, other) && other.range == access.range {
                        break;
                    }
                }
            }
        }
    }
    share_memory(plan, &touched, &mut found);
    for earlier in &mut found {
        earlier.sort_unstable_by(|a, b| b.cmp(a));
        earlier.dedup();
    }
    found
}

/// The textures whose layout changes in front of a step: whoever reads them before and after must be ordered too, since a
/// transition is a write (Vulkan 1.3, 7.7.4).
fn moved(plan: &Plan) -> HashSet<(u32, ResourceId)> {
    let rows = plan.barriers().iter().filter(|row| row.from != row.to);
    rows.map(|row| (row.before.index() as u32, row.resource)).collect()
}

/// Of each resource, the steps that access it, in order, with how.
pub fn accesses_by_resource(plan: &Plan) -> Vec<Vec<(u32, Access)>> {
    let mut touched = vec![Vec::new(); plan.resources().len()];
    for step in plan.step_ids() {
        for member in plan.passes_of(step) {
            for access in plan.graph().accesses_of(member.pass) {
                touched[access.resource.index()].push((step.index() as u32, *access));
            }
        }
    }
    touched
}

/// Who gets memory waits for all who touched what lay there.
fn share_memory(plan: &Plan, touched: &[Vec<(u32, Access)>], found: &mut [Vec<u32>]) {
    let mut placed: Vec<(usize, u64, u64)> = Vec::new();
    for (resource, row) in plan.resources().iter().enumerate() {
        let [begin, end] = match row.placement {
            Placement::Slot(slot) => [slot.index() as u64, slot.index() as u64 + 1],
            Placement::Heap { offset } => [offset, offset.saturating_add(row.bytes.max(1))],
            _ => continue,
        };
        placed.push((resource, begin, end));
    }
    placed.sort_unstable_by_key(|(resource, ..)| plan.resources()[*resource].first);
    let is_buffer = |resource: usize| plan.graph().resources()[resource].desc.texture().is_none();
    for (at, (later, begin, end)) in placed.iter().enumerate() {
        for (earlier, other_begin, other_end) in &placed[..at] {
            let other_heap = plan.caps().separate_heaps && is_buffer(*later) != is_buffer(*earlier);
            let apart = end <= other_begin || other_end <= begin || other_heap;
            if apart {
                continue;
            }
            for (step, _) in &touched[*later] {
                let before = touched[*earlier].iter().map(|(before, _)| *before);
                found[*step as usize].extend(before.filter(|before| before < step));
            }
        }
    }
}
