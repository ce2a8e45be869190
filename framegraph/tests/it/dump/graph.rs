//! The `petgraph` forms.

use super::frame;
use crate::support::*;
use framegraph::dump::graph::{Node, bipartite, data_flow, reduced};
use framegraph::generate::{self, Entropy, Profile};
use framegraph::*;
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
            other => panic!("{other:?} is no edge between a pass and a resource"),
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
    g.export(out);
    let flow = data_flow(&g);
    let edges: Vec<_> =
        flow.edge_references().map(|e| (g.pass_name(flow[e.source()]), g.pass_name(flow[e.target()]))).collect();
    assert_eq!(edges, [("a", "c")], "b wrote another level");
}

#[test]
fn reducing_keeps_reachability_and_nothing_that_is_implied() {
    for seed in 0..200 {
        let g = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let flow = data_flow(&g);
        assert!(!is_cyclic_directed(&flow));
        let small = reduced(&flow);
        assert_eq!(small.node_count(), flow.node_count());
        for a in flow.node_indices() {
            for b in flow.node_indices() {
                let before = has_path_connecting(&flow, a, b, None);
                assert_eq!(before, has_path_connecting(&small, a, b, None), "seed {seed}");
            }
        }
        // Without all edges between two passes, the one cannot be reached from the other.
        for edge in small.edge_references() {
            let ends = (edge.source(), edge.target());
            let mut without = small.clone();
            without.retain_edges(|g, e| g.edge_endpoints(e) != Some(ends));
            assert!(!has_path_connecting(&without, ends.0, ends.1, None), "seed {seed}");
        }
    }
}
