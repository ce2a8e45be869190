//! Points of a frame where memory passes from one resource to another, derived from the plan's barriers.

use framegraph::{Placement, Plan, ResourceId, StepId};

/// Resources that acquire their memory before a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct AliasBarrier {
    pub(crate) before: StepId,
    pub(crate) resources: Vec<ResourceId>,
}

/// Returns the smallest set of points, in order, at which every placed resource accepted by `is_placed` acquires its
/// memory.
///
/// A resource acquires its memory no later than its own first step, and after all resources that used the memory before
/// it in this frame. Resources whose memory was not used before in this frame are included, since the previous frame
/// may have used it.
pub(crate) fn alias_barriers(plan: &Plan, is_placed: impl Fn(ResourceId) -> bool) -> Vec<AliasBarrier> {
    let heap = |r: &ResourceId| matches!(plan.resources()[r.index()].placement, Placement::Heap { .. });
    let mut earliest = vec![0; plan.resources().len()];
    for barrier in plan.barriers().iter().filter(|b| !b.aliases.is_none()) {
        let free = &mut earliest[barrier.resource.index()];
        *free = (barrier.after.index() + 1).max(*free);
    }
    let mut waiting: Vec<_> = plan.graph().resource_ids().filter(heap).filter(|r| is_placed(*r)).collect();
    waiting.sort_by_key(|r| (plan.resources()[r.index()].first, *r));
    let mut out: Vec<AliasBarrier> = Vec::new();
    // The resource with the earliest deadline sets the point, as late as possible. All resources that are ready by then
    // join it.
    for resource in waiting {
        match out.last_mut() {
            Some(last) if earliest[resource.index()] <= last.before.index() => last.resources.push(resource),
            _ => {
                let before = plan.resources()[resource.index()].first;
                out.push(AliasBarrier { before, resources: vec![resource] });
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Alias, Caps, Options, Plan, Scratch, compile};
    use framegraph_check::generate::{self, Entropy, FRAME, Profile};

    /// Returns the heap and the byte range of a resource.
    fn bytes(plan: &Plan, resource: ResourceId) -> Option<(bool, u64, u64)> {
        let row = &plan.resources()[resource.index()];
        let buffer = plan.graph().resources()[resource.index()].desc.texture().is_none();
        match row.placement {
            Placement::Heap { offset } => Some((buffer && plan.caps().separate_heaps, offset, offset + row.bytes)),
            _ => None,
        }
    }

    /// Checks by brute force that no other resource uses the memory from acquisition to the last step.
    #[test]
    fn memory_is_free_when_it_is_acquired() {
        let caps = Caps { placed_histories: false, separate_heaps: true, ..Caps::desktop() };
        let options = Options { alias: Alias::Heap, ..Options::for_frame(FRAME[0], FRAME[1]) };
        let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
        let (mut shared, mut joined) = (0, 0);
        for seed in 0..300 {
            let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
            if compile(&graph, &caps, &options, &mut scratch, &mut plan).is_err() {
                continue;
            }
            let found = alias_barriers(&plan, |_| true);
            assert!(found.is_sorted_by(|a, b| a.before < b.before), "seed {seed}: {found:?}");
            let placed: Vec<_> = plan.graph().resource_ids().filter(|r| bytes(&plan, *r).is_some()).collect();
            let all = found.iter().flat_map(|a| a.resources.iter().map(|r| (a.before, *r)));
            let mut times: Vec<_> = all.map(|(at, r)| (r, at)).collect();
            times.sort_unstable();
            assert_eq!(times.iter().map(|t| t.0).collect::<Vec<_>>(), placed, "seed {seed}: each once");
            joined += usize::from(found.len() < placed.len());
            for &(resource, at) in &times {
                let row = &plan.resources()[resource.index()];
                assert!(at <= row.first, "seed {seed}");
                for &(other, other_at) in times.iter().filter(|(o, _)| *o != resource) {
                    let (Some(a), Some(b)) = (bytes(&plan, resource), bytes(&plan, other)) else { continue };
                    if a.0 == b.0 && a.1 < b.2 && b.1 < a.2 {
                        let last = plan.resources()[other.index()].last;
                        assert!(last < at || row.last < other_at, "seed {seed}: {resource:?} and {other:?}");
                        shared += 1;
                    }
                }
            }
        }
        assert!(shared > 100 && joined > 100, "the graphs share too little: {shared}, {joined}");
    }
}
