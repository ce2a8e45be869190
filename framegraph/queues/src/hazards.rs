//! Dependencies between the steps of a plan: through contents, and through shared memory.

use framegraph::{Access, Aspect, Mode, Placement, Plan, Range, ResourceId};
use std::collections::HashSet;

/// Returns the earlier steps that each step depends on, latest first. May include implied dependencies.
pub fn dependencies(plan: &Plan) -> Vec<Vec<u32>> {
    let mut found = vec![Vec::new(); plan.steps().len()];
    let accessed = with_other_planes(plan, accesses_by_resource(plan));
    let moved = moved(plan);
    for (resource, accesses) in accessed.iter().enumerate() {
        let resource = ResourceId::at(resource);
        let changes = |step: u32, access: &Access| access.mode.writes() || moved.contains(&(step, resource));
        for (later, (step, access)) in accesses.iter().enumerate() {
            for (earlier, other) in accesses[..later].iter().rev() {
                let ordered = changes(*step, access) || changes(*earlier, other);
                if earlier != step && ordered && plan.graph().overlap(resource, &access.range, &other.range) {
                    found[*step as usize].push(*earlier);
                    // Earlier users are covered by this change of the whole range.
                    if changes(*earlier, other) && other.range == access.range {
                        break;
                    }
                }
            }
        }
    }
    share_memory(plan, &accessed, &mut found);
    for earlier in &mut found {
        earlier.sort_unstable_by(|a, b| b.cmp(a));
        earlier.dedup();
    }
    found
}

/// Returns the textures whose layout changes before a step. Reads before and after must be ordered, because a
/// transition is a write (Vulkan 1.3, 7.7.4).
fn moved(plan: &Plan) -> HashSet<(u32, ResourceId)> {
    let rows = plan.barriers().iter().filter(|row| row.from != row.to);
    rows.map(|row| (row.before.index() as u32, row.resource)).collect()
}

/// Adds reads of whole depth-stencil attachments. Vulkan attaches both planes, also if a pass declares one of them, and
/// the plan moves the other plane to a layout for it.
fn with_other_planes(plan: &Plan, mut accessed: Vec<Vec<(u32, Access)>>) -> Vec<Vec<(u32, Access)>> {
    for rows in &mut accessed {
        let whole = |(step, access): &(u32, Access)| {
            let two = plan.format(access.resource).is_some_and(|format| format.planes() > 1);
            let one = access.kind.is_depth() && access.range.aspect != Aspect::All;
            let range = Range { aspect: Aspect::All, ..access.range };
            (two && one).then_some((*step, Access { mode: Mode::Read, range, ..*access }))
        };
        rows.extend(rows.iter().filter_map(whole).collect::<Vec<_>>());
        rows.sort_by_key(|(step, _)| *step);
    }
    accessed
}

/// Returns for each resource the steps that access it, in order, with their accesses.
pub fn accesses_by_resource(plan: &Plan) -> Vec<Vec<(u32, Access)>> {
    let mut accessed = vec![Vec::new(); plan.resources().len()];
    for step in plan.step_ids() {
        for member in plan.passes_of(step) {
            for access in plan.graph().accesses_of(member.pass) {
                accessed[access.resource.index()].push((step.index() as u32, *access));
            }
        }
    }
    accessed
}

/// Adds dependencies of resources on all previous users of their memory.
fn share_memory(plan: &Plan, accessed: &[Vec<(u32, Access)>], found: &mut [Vec<u32>]) {
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
            for (step, _) in &accessed[*later] {
                let before = accessed[*earlier].iter().map(|(before, _)| *before);
                found[*step as usize].extend(before.filter(|before| before < step));
            }
        }
    }
}
