//! Export as `petgraph` graphs.

use super::frame;
use crate::support::*;
use framegraph::dump::graph::{Node, bipartite, flows};
use framegraph::dump::{data_flow, reduced};
use framegraph::*;
use framegraph_check::generate::{self, Entropy, Profile};
use petgraph::algo::{has_path_connecting, is_cyclic_directed};
use petgraph::visit::EdgeRef;

#[test]
fn the_bipartite_graph_has_an_edge_for_each_read_and_write() {
    let g = frame();
    let b = bipartite(&g);
    assert_eq!(b.node_count(), 4 + 4);
    // prepass -> depth -> scene -> hdr -> idle -> idle_out, hdr -> tonemap -> screen.
    assert_eq!(b.edge_count(), 7);
    for edge in b.edge_references() {
        let ends = (b[edge.source()], b[edge.target()]);
        let access = g.accesses()[edge.weight().index()];
        match ends {
            (Node::Pass(_), Node::Resource(r)) => {
                assert!(access.mode.writes() && access.resource == r);
            }
            (Node::Resource(r), Node::Pass(_)) => {
                assert!(access.mode.needs_contents() && access.resource == r);
            }
            other => panic!("{other:?} is not an edge between a pass and a resource"),
        }
    }
}

#[test]
fn levels_flow_apart() {
    let mut g = Graph::new();
    let t = g.texture("t", color(Format::R32Float).mips(2));
    let t = g.add_fn("a", |p| p.color(t.mip(0), BLACK)).unwrap();
    let t = g.add_fn("b", |p| p.color(t.mip(1), BLACK)).unwrap();
    let out = g.texture("out", color(Format::R8Unorm));
    let out = g
        .add_fn("c", |p| {
            p.sampled(t.mip(0))?;
            p.color(out, Intent::Overwrite)
        })
        .unwrap();
    g.export(out).unwrap();
    let edges: Vec<_> = data_flow(&g).iter().map(|f| (g.pass_name(f.from), g.pass_name(f.to))).collect();
    assert_eq!(edges, [("a", "c")], "b wrote another level");
}

#[test]
fn reducing_keeps_reachability_and_nothing_that_is_implied() {
    for seed in 0..200 {
        let g = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let all = data_flow(&g);
        let flow = flows(&g, &all);
        assert!(!is_cyclic_directed(&flow));
        let small = flows(&g, &reduced(&all, g.passes().len()));
        assert_eq!(small.node_count(), flow.node_count());
        for a in flow.node_indices() {
            for b in flow.node_indices() {
                let before = has_path_connecting(&flow, a, b, None);
                assert_eq!(before, has_path_connecting(&small, a, b, None), "seed {seed}");
            }
        }
        // Without the edges between two passes, one is not reachable from the other.
        for edge in small.edge_references() {
            let ends = (edge.source(), edge.target());
            let mut without = small.clone();
            without.retain_edges(|g, e| g.edge_endpoints(e) != Some(ends));
            assert!(!has_path_connecting(&without, ends.0, ends.1, None), "seed {seed}");
        }
    }
}

/// A pass runs if and only if an exported result or a pass with a side effect is reachable from it. Compares culling
/// with reachability in `petgraph`, for whole textures that no pass modifies, where no write is overwritten unused.
#[test]
fn culling_is_reachability() {
    let mut culled = 0;
    for seed in 0..300 {
        let profile = Profile { plain: true, ..Profile::default() };
        let g = generate::graph(&mut Entropy::seeded(seed), &profile);
        let versions = |r: ResourceId| g.versions_of(r).count();
        // A reader of the initial contents does not depend on passes that overwrite them.
        let of_entry = |a: &Access| !a.mode.writes() && g.versions()[a.version.index()].writer.is_none();
        let stale = g.accesses().iter().any(|a| of_entry(a) && versions(a.resource) > 1);
        if stale || g.resource_ids().any(|r| versions(r) > 2) {
            continue;
        }
        let mut plan = Plan::new();
        let options = Options { frame: generate::FRAME, ..Options::default() };
        compile(&g, &Caps::desktop(), &options, &mut Scratch::new(), &mut plan).unwrap();
        let b = bipartite(&g);
        let roots: Vec<_> = b
            .node_indices()
            .filter(|n| match b[*n] {
                Node::Pass(p) => g.passes()[p.index()].flags.has(PassFlags::SIDE_EFFECT),
                Node::Resource(r) => {
                    g.resources()[r.index()].kind.kept_on_exit() || g.exports().iter().any(|e| e.resource == r)
                }
            })
            .collect();
        for node in b.node_indices() {
            let Node::Pass(pass) = b[node] else { continue };
            let needed = roots.iter().any(|root| has_path_connecting(&b, node, *root, None));
            assert_eq!(plan.is_culled(pass), !needed, "seed {seed}, {}", g.pass_name(pass));
            culled += u32::from(!needed);
        }
    }
    assert!(culled > 20, "only {culled} passes were culled");
}
