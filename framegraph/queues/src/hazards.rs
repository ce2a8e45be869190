//! Which steps of a plan must be over before which: for contents, and for memory that resources share.

use framegraph::{Access, Placement, Plan, ResourceId};

/// Of each step, the earlier steps that it depends on, the latest first; more than need be said, since some follow from others.
pub fn dependencies(plan: &Plan) -> Vec<Vec<u32>> {
    let mut found = vec![Vec::new(); plan.steps().len()];
    let touched = accesses_by_resource(plan);
    for (resource, accesses) in touched.iter().enumerate() {
        let resource = ResourceId::at(resource);
        for (later, (step, access)) in accesses.iter().enumerate() {
            for (earlier, other) in accesses[..later].iter().rev() {
                let writes = access.mode.writes() || other.mode.writes();
                if earlier != step && writes && plan.graph().overlap(resource, &access.range, &other.range) {
                    found[*step as usize].push(*earlier);
                    // Whoever was before a write of all of it is waited for by that write.
                    if other.mode.writes() && other.range == access.range {
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
