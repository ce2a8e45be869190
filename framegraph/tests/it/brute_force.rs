//! Compares the compiler with exhaustive searches on tiny graphs.

mod orders;

use framegraph::*;
use framegraph_check::generate::{self, Entropy, FRAME, Profile};
use std::collections::BTreeSet;

const PLAIN: Profile =
    Profile { max_passes: 6, sloppy: false, plain: true, plain_accesses: true, volumes: false, forwards: false };

/// Returns graphs of at most 7 passes and 7 resources.
fn tiny(count: usize) -> impl Iterator<Item = (u64, Graph)> {
    let all = (0..).map(|seed| (seed, generate::graph(&mut Entropy::seeded(seed), &PLAIN)));
    let small = |(_, g): &(u64, Graph)| g.passes().len() <= 7 && g.resources().len() <= 7;
    all.filter(small).take(count)
}

fn declared() -> Options {
    Options { frame: FRAME, ..Options::default() }
}

fn compiled(graph: &Graph, caps: &Caps, options: &Options) -> Plan {
    let mut plan = Plan::new();
    let outcome = compile(graph, caps, options, &mut Scratch::new(), &mut plan);
    outcome.unwrap_or_else(|errors| panic!("a valid graph was rejected: {errors}"));
    plan
}

/// A resource in memory: first and last step, bytes.
type Item = (ResourceId, StepId, StepId, u64);

fn items(plan: &Plan) -> Vec<Item> {
    let rows = plan.graph().resource_ids().zip(plan.resources());
    let shared = |p: Placement| matches!(p, Placement::Slot(_) | Placement::Heap { .. });
    rows.filter(|(_, r)| shared(r.placement)).map(|(id, r)| (id, r.first, r.last, r.bytes)).collect()
}

fn meet(a: &Item, b: &Item) -> bool {
    a.1 <= b.2 && b.1 <= a.2
}

/// Returns the minimum size over all partitions of the items into slots. Items of a slot have equal shape and disjoint
/// lifetimes.
fn min_pool(plan: &Plan, items: &[Item], slots: &mut Vec<Vec<Item>>) -> u64 {
    let Some((item, rest)) = items.split_first() else {
        return slots.iter().map(|s| s[0].3).sum();
    };
    let shape = |r: ResourceId| {
        let desc = plan.graph().resources()[r.index()].desc;
        let texture = desc.texture().copied();
        texture.map(|t| {
            let format = plan.format(r).unwrap_or(t.format).without_srgb();
            let extent = t.extent.texels(FRAME);
            (extent, format, t.samples, t.layers, t.mip_count(FRAME))
        })
    };
    slots.push(vec![*item]);
    let mut least = min_pool(plan, rest, slots);
    slots.pop();
    for slot in 0..slots.len() {
        let fits = |other: &Item| !meet(item, other) && shape(item.0) == shape(other.0);
        if slots[slot].iter().all(fits) {
            slots[slot].push(*item);
            least = least.min(min_pool(plan, rest, slots));
            slots[slot].pop();
        }
    }
    least
}

/// Finds the minimum top over all placements. Sorted by their offsets in an optimal placement, items can be placed as
/// low as possible one after another without raising the top. So trying every order is sufficient.
fn min_heap(items: &[Item], align: u64, placed: &mut Vec<(Item, u64)>, best: &mut u64) {
    let top = placed.iter().map(|(i, at)| at + size(i, align)).max();
    let top = top.unwrap_or(0);
    if top >= *best && !items.is_empty() {
        return;
    }
    if items.is_empty() {
        *best = top.min(*best);
        return;
    }
    for index in 0..items.len() {
        let item = items[index];
        let mut rest = items.to_vec();
        rest.remove(index);
        let mut at = 0;
        while let Some((other, below)) =
            placed.iter().find(|(o, b)| meet(&item, o) && at < b + size(o, align) && *b < at + size(&item, align))
        {
            at = below + size(other, align);
        }
        placed.push((item, at));
        min_heap(&rest, align, placed, best);
        placed.pop();
    }
}

fn size(item: &Item, align: u64) -> u64 {
    item.3.next_multiple_of(align)
}

#[test]
fn the_pool_takes_the_least_there_is() {
    let mut shared = 0;
    let options = Options { cull: false, ..declared() };
    for (seed, graph) in tiny(1500) {
        let plan = compiled(&graph, &Caps::desktop(), &options);
        let least = min_pool(&plan, &items(&plan), &mut Vec::new());
        assert_eq!(plan.memory().bytes, least, "seed {seed}");
        assert!(plan.memory().optimal, "seed {seed}");
        shared += usize::from(least < plan.memory().unaliased_bytes);
    }
    assert!(shared >= 20, "only {shared} graphs share memory");
}

#[test]
fn the_heap_takes_the_least_there_is() {
    let (mut shared, mut above) = (0, 0);
    for (seed, graph) in tiny(250) {
        for (align, effort) in [(1, Effort::Exact), (4096, Effort::Exact), (1, Effort::Greedy)] {
            let caps = Caps { texture_alignment_bytes: align, buffer_alignment_bytes: align, ..Caps::desktop() };
            let options = Options { alias: Alias::Heap, effort, cull: seed % 2 == 0, ..declared() };
            let plan = compiled(&graph, &caps, &options);
            let mut least = u64::MAX;
            min_heap(&items(&plan), align, &mut Vec::new(), &mut least);
            let memory = plan.memory();
            assert!(memory.lower_bound_bytes <= least, "seed {seed}: {memory:?}, {least}");
            if effort == Effort::Exact || memory.optimal {
                assert_eq!(memory.bytes, least, "seed {seed}");
                assert!(memory.optimal, "seed {seed}");
            }
            shared += usize::from(least < memory.unaliased_bytes);
            above += usize::from(memory.bytes > least);
        }
    }
    assert!(shared >= 20, "only {shared} graphs share memory");
    assert!(above <= 2, "greedy packing misses the optimum {above} times of 250");
}

/// Returns the parts of a texture with one level and layer: its planes.
fn planes(graph: &Graph, access: &Access) -> impl Iterator<Item = (usize, u32)> + use<> {
    let resource = access.resource.index();
    let format = graph.resources()[resource].desc.texture().map(|t| t.format);
    let format = format.expect("plain graphs have textures only");
    let aspect = access.range.aspect;
    (0..format.planes()).filter(move |p| aspect.selects_plane(format, *p)).map(move |p| (resource, p))
}

/// Returns the passes that a frame needs, by definition. Contents are the set of passes that contributed to them. A
/// pass is needed if it contributed to exported contents or to a side effect.
fn needed(graph: &Graph) -> BTreeSet<PassId> {
    let mut contents = std::collections::BTreeMap::<(usize, u32), BTreeSet<PassId>>::new();
    let mut needed = BTreeSet::new();
    for pass in graph.pass_ids() {
        let accesses = graph.accesses_of(pass);
        let before = |access: &Access| -> BTreeSet<PassId> {
            planes(graph, access).flat_map(|part| contents.get(&part).into_iter().flatten().copied()).collect()
        };
        // Previous contents of a color attachment influence only its new contents and its resolve.
        let averaged = |slot| accesses.iter().any(|a| a.kind == AccessKind::Resolve && a.slot == slot);
        let adds = |a: &Access| a.kind == AccessKind::Color && a.mode == Mode::Modify && !averaged(a.slot);
        let mut of_pass = BTreeSet::from([pass]);
        for access in accesses.iter().filter(|a| a.mode.needs_contents() && !adds(a)) {
            of_pass.extend(before(access));
        }
        if graph.passes()[pass.index()].flags.has(PassFlags::SIDE_EFFECT) {
            needed.extend(&of_pass);
        }
        let held: Vec<_> = accesses.iter().map(|a| if adds(a) { before(a) } else { BTreeSet::new() }).collect();
        for (access, held) in accesses.iter().zip(held).filter(|(a, _)| a.mode.writes()) {
            for part in planes(graph, access) {
                contents.insert(part, of_pass.union(&held).copied().collect());
            }
        }
    }
    let exported: BTreeSet<_> = graph.exports().iter().map(|e| e.resource.index()).collect();
    for ((resource, _), passes) in contents {
        let kept = graph.resources()[resource].kind.kept_on_exit();
        if kept || exported.contains(&resource) {
            needed.extend(passes);
        }
    }
    needed
}

#[test]
fn culling_keeps_what_is_needed_and_nothing_else() {
    let mut culled = 0;
    for (seed, graph) in tiny(1500) {
        let plan = compiled(&graph, &crate::support::wgpu(), &declared());
        let needed = needed(&graph);
        for pass in graph.pass_ids() {
            let found = !plan.is_culled(pass);
            assert_eq!(found, needed.contains(&pass), "seed {seed}, {}", graph.pass_name(pass));
        }
        culled += plan.counts().culled;
    }
    assert!(culled > 500, "only {culled} passes are culled");
}
