//! The graph as a `petgraph` graph: for algorithms this crate has no use for, and for drawing.

use crate::access::Access;
use crate::format::Format;
use crate::graph::Graph;
use crate::id::{AccessId, PassId, ResourceId};
use petgraph::algo::tred::{dag_to_toposorted_adjacency_list, dag_transitive_reduction_closure};
use petgraph::graph::{DiGraph, NodeIndex};
use petgraph::visit::{EdgeRef, IntoNeighbors};

/// A node of [`bipartite`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A declared pass.
    Pass(PassId),
    /// A declared resource.
    Resource(ResourceId),
}

/// Passes and resources as nodes, accesses as edges: from a resource to the pass that needs its contents, from a pass to
/// the resource that it writes. A modifying access makes both edges. The first nodes are the passes, in order.
pub fn bipartite(graph: &Graph) -> DiGraph<Node, AccessId> {
    let nodes = graph.passes().len() + graph.resources().len();
    let mut out = DiGraph::with_capacity(nodes, graph.accesses().len());
    let passes: Vec<_> = graph.pass_ids().map(|p| out.add_node(Node::Pass(p))).collect();
    let resources: Vec<_> = graph.resource_ids().map(|r| out.add_node(Node::Resource(r))).collect();
    for pass in graph.pass_ids() {
        let span = graph.passes()[pass.index()].accesses;
        for at in span.range() {
            let access = &graph.accesses()[at];
            let (p, r) = (passes[pass.index()], resources[access.resource.index()]);
            if access.mode.needs_contents() {
                out.add_edge(r, p, AccessId::at(at));
            }
            if access.mode.writes() {
                out.add_edge(p, r, AccessId::at(at));
            }
        }
    }
    out
}

/// Which pass needs what another wrote: passes as nodes, in order, and an edge for each resource that flows from writer
/// to reader. Followed by level, layer and plane. Acyclic, since a graph is declared in order.
pub fn data_flow(graph: &Graph) -> DiGraph<PassId, ResourceId> {
    let mut out = DiGraph::with_capacity(graph.passes().len(), graph.accesses().len());
    let passes: Vec<_> = graph.pass_ids().map(|p| out.add_node(p)).collect();
    // By resource: the writes that somebody can still see, as pass and access.
    let mut visible: Vec<Vec<(PassId, &Access)>> = vec![Vec::new(); graph.resources().len()];
    for pass in graph.pass_ids() {
        let accesses = graph.accesses_of(pass);
        for access in accesses.iter().filter(|a| a.mode.needs_contents()) {
            let format = format(graph, access);
            for (writer, _) in
                visible[access.resource.index()].iter().filter(|(_, w)| w.range.overlaps(&access.range, format))
            {
                let (from, to) = (passes[writer.index()], passes[pass.index()]);
                let known = out.edges_connecting(from, to).any(|e| *e.weight() == access.resource);
                if from != to && !known {
                    out.add_edge(from, to, access.resource);
                }
            }
        }
        for access in accesses.iter().filter(|a| a.mode.writes()) {
            let seen = &mut visible[access.resource.index()];
            seen.retain(|(_, earlier)| !covers(access, earlier));
            seen.push((pass, access));
        }
    }
    out
}

fn format(graph: &Graph, access: &Access) -> Format {
    let texture = graph.resources()[access.resource.index()].desc.texture();
    texture.map_or(Format::R8Unorm, |t| t.format)
}

/// Whether nothing of the earlier write is left after the later one. A modifying write passes on what it found, so that
/// its reader depends on the earlier writer through it.
fn covers(later: &Access, earlier: &Access) -> bool {
    let (l, e) = (&later.range, &earlier.range);
    let within = |a: std::ops::Range<u32>, b: std::ops::Range<u32>| b.start <= a.start && a.end <= b.end;
    let (mips, layers) = (u32::from(u8::MAX), u32::from(u16::MAX));
    within(e.mip_range(mips), l.mip_range(mips))
        && within(e.layer_range(layers), l.layer_range(layers))
        && (l.aspect == crate::format::Aspect::All || l.aspect == e.aspect)
}

/// The edges of an acyclic graph of passes that no other path implies (transitive reduction; Aho, Garey and Ullman 1972):
/// what is worth drawing. Time and memory grow with the square of the number of nodes.
pub fn reduced(flow: &DiGraph<PassId, ResourceId>) -> DiGraph<PassId, ResourceId> {
    // Passes are nodes in declaration order, and what flows, flows forward: the order is topological.
    let order: Vec<_> = flow.node_indices().collect();
    let (list, position) = dag_to_toposorted_adjacency_list::<_, u32>(flow, &order);
    let (reduction, _) = dag_transitive_reduction_closure(&list);
    flow.filter_map(
        |_, pass| Some(*pass),
        |edge, resource| {
            let (from, to) = flow.edge_endpoints(edge)?;
            let target = position[to.index()];
            let kept = reduction.neighbors(position[from.index()]).any(|n| n == target);
            kept.then_some(*resource)
        },
    )
}

/// The edges of `flow`, those between the same passes together.
pub(crate) fn bundles(flow: &DiGraph<PassId, ResourceId>) -> Vec<(PassId, PassId, Vec<ResourceId>)> {
    let mut out: Vec<(PassId, PassId, Vec<ResourceId>)> = Vec::new();
    let mut edges: Vec<_> = flow.edge_references().map(|e| (e.source(), e.target(), *e.weight())).collect();
    edges.sort_unstable();
    let pass = |n: NodeIndex| flow[n];
    for (from, to, resource) in edges {
        match out.last_mut() {
            Some((f, t, bundle)) if (*f, *t) == (pass(from), pass(to)) => bundle.push(resource),
            _ => out.push((pass(from), pass(to), vec![resource])),
        }
    }
    out
}
