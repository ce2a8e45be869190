//! Tries every order of small graphs: each gives a correct plan, and the optimizing order nearly always finds an
//! optimal one.

use super::{compiled, declared, planes};
use framegraph::*;
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, Profile};

fn flag(p: &mut PassBuilder<'_>, flags: PassFlags) {
    if flags.has(PassFlags::SIDE_EFFECT) {
        p.side_effect();
    }
    if flags.has(PassFlags::POINTWISE) {
        p.pointwise();
    }
    if flags.has(PassFlags::BLENDS) {
        p.blends();
    }
    if flags.has(PassFlags::NEVER_MERGE) {
        p.never_merge();
    }
    if flags.has(PassFlags::TAKES_EPILOGUE) {
        p.takes_epilogue();
    }
}

/// Returns the graph with its passes in another order, without those that `order` omits.
fn redeclared(graph: &Graph, order: &[PassId]) -> Graph {
    let mut copy = Graph::new();
    let mut handles: Vec<Texture> = graph
        .resource_ids()
        .zip(graph.resources())
        .map(|(id, resource)| {
            let desc = resource.desc.texture().copied().expect("plain graphs have textures only");
            match resource.kind {
                Kind::Imported { entry, exit } => copy.import_texture(graph.resource_name(id), desc, entry, exit),
                _ => copy.texture(graph.resource_name(id), desc),
            }
        })
        .collect();
    for &pass in order {
        let declared = &graph.passes()[pass.index()];
        let outcome = copy.add_fn(graph.pass_name(pass), |p| {
            flag(p, declared.flags);
            p.kind(declared.kind)?;
            for access in graph.accesses_of(pass) {
                let part = handles[access.resource.index()].range(access.range);
                let intent = match access.mode {
                    Mode::Clear => Intent::Clear(graph.clears()[access.clear as usize]),
                    Mode::Overwrite => Intent::Overwrite,
                    Mode::Modify | Mode::Read => Intent::Modify,
                };
                let view = match access.kind {
                    AccessKind::Color => Err(p.color_at(access.slot, part, intent)?),
                    AccessKind::Depth => Err(p.depth(part, intent)?),
                    AccessKind::StorageWrite => Err(p.storage_write(part, intent)?),
                    AccessKind::CopyTarget => Err(p.copy_target(part, intent)?),
                    AccessKind::DepthReadOnly => Ok(p.depth_read_only(part)?),
                    AccessKind::SamePixel => Ok(p.same_pixel(part)?),
                    AccessKind::StorageRead => Ok(p.storage_read(part)?),
                    AccessKind::CopySource => Ok(p.copy_source(part)?),
                    _ => Ok(p.sampled(part)?),
                };
                if let Err(written) = view {
                    handles[access.resource.index()] = written;
                }
            }
            Ok(())
        });
        assert_eq!(outcome, Ok(()));
    }
    for export in graph.exports() {
        match export.kind {
            ExportKind::Keep => copy.export(handles[export.resource.index()]).unwrap(),
            ExportKind::Readback => copy.readback(handles[export.resource.index()]).unwrap(),
        }
    }
    copy
}

/// Returns every valid order of `passes`: passes that access a common part, one of them writing, and passes with side
/// effects keep their order. `None` if there are more than `most`.
fn orders(graph: &Graph, passes: &[PassId], most: usize) -> Option<Vec<Vec<PassId>>> {
    let effect = |p: PassId| graph.passes()[p.index()].flags.has(PassFlags::SIDE_EFFECT);
    let depends = |a: PassId, b: PassId| {
        let parts = |p: PassId| {
            let accesses = graph.accesses_of(p).iter();
            accesses.flat_map(|x| planes(graph, x).map(move |part| (part, x.mode.writes())))
        };
        let shared = parts(a).any(|(x, w)| parts(b).any(|(y, v)| x == y && (w || v)));
        shared || (effect(a) && effect(b))
    };
    let mut found = vec![Vec::new()];
    for &pass in passes {
        let mut longer = Vec::new();
        for order in &found {
            let after = order.iter().rposition(|p| depends(*p, pass)).map_or(0, |p| p + 1);
            for at in after..=order.len() {
                let mut next: Vec<PassId> = order.clone();
                next.insert(at, pass);
                longer.push(next);
            }
        }
        if longer.len() > most {
            return None;
        }
        found = longer;
    }
    Some(found)
}

/// Returns steps, bytes of memory, and bytes between tile and memory.
fn cost(plan: &Plan) -> (u32, u64, u64) {
    let traffic = plan.traffic(plan.frame());
    (plan.counts().steps, plan.memory().bytes, traffic.total_bytes())
}

/// Returns graphs of at most `most` passes, all of which run, with all of their orders: at least three, and at most
/// 200. Passes are declared in a random order, so that declaration order has no advantage.
fn shuffled(most: usize, count: usize) -> impl Iterator<Item = (u64, Graph, Vec<Vec<PassId>>)> {
    let profile = Profile { max_passes: most as u8, plain: true, ..Profile::default() };
    let draw = move |seed: u64| {
        let mut entropy = Entropy::seeded(seed);
        let graph = generate::graph(&mut entropy, &profile);
        let plan = compiled(&graph, &crate::support::wgpu(), &declared());
        let kept: Vec<_> = graph.pass_ids().filter(|p| !plan.is_culled(*p)).collect();
        let all = orders(&graph, &kept, 200).filter(|all| all.len() >= 3 && kept.len() <= most)?;
        let lot = entropy.below(all.len() as u32) as usize;
        let graph = redeclared(&graph, &all[lot]);
        // An import with readers that are all culled may be invalid afterwards.
        let sound =
            compile(&graph, &crate::support::wgpu(), &declared(), &mut Scratch::new(), &mut Plan::new()).is_ok();
        let passes: Vec<_> = graph.pass_ids().collect();
        let all = orders(&graph, &passes, 200).filter(|_| sound)?;
        Some((seed, graph, all))
    };
    (0..).filter_map(draw).take(count)
}

#[test]
fn every_order_gives_a_right_plan_and_the_optimising_order_is_the_best() {
    let (mut graphs, mut tried, mut best, mut lucky) = (0, 0, 0, 0);
    for (seed, graph, orders) in shuffled(8, 120) {
        let caps = &[crate::support::wgpu(), Caps::tiler(), Caps::desktop()][seed as usize % 3];
        let alias = if seed % 2 == 0 { Alias::Pool } else { Alias::Heap };
        let declared = Options { alias, ..declared() };
        let found = cost(&compiled(&graph, caps, &Options { order: Order::Optimized, ..declared }));
        let mut least = (u32::MAX, u64::MAX, u64::MAX);
        for order in &orders {
            let moved = compiled(&redeclared(&graph, order), caps, &declared);
            let report = check::examine(&moved);
            assert!(report.is_clean(), "seed {seed}, {order:?}: {report}");
            assert_eq!(moved.counts().culled, 0, "seed {seed}: {order:?}");
            least = least.min(cost(&moved));
        }
        assert!(least <= found, "seed {seed}: the plan is cheaper than any order");
        graphs += 1;
        tried += orders.len();
        best += usize::from(least == found);
        lucky += usize::from(least == cost(&compiled(&graph, caps, &declared)));
    }
    println!("optimal: {best} of {graphs} graphs with the optimizing order, {lucky} as declared; {tried} orders tried");
    // A few tenths of a percent of thousands of graphs miss the optimum, because the search ends in a local one.
    assert!(best * 100 >= graphs * 98, "{best} of {graphs} are optimal");
    assert!(lucky * 100 < graphs * 90, "{lucky} of {graphs} are optimal as declared: the graphs are too easy");
}
