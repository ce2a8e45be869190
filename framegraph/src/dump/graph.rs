//! Graphs as `petgraph` graphs, for algorithms such as reachability, dominators and layouts.

use super::flow::Flow;
use crate::graph::Graph;
use crate::id::{AccessId, PassId, ResourceId};
use petgraph::graph::{DiGraph, NodeIndex};

/// A node of [`bipartite`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A declared pass.
    Pass(PassId),
    /// A declared resource.
    Resource(ResourceId),
}

/// Returns a graph with passes and resources as nodes and accesses as edges.
///
/// Reads are edges from a resource to a pass, writes from a pass to a resource; a modifying access has both. The first
/// nodes are the passes, in order.
pub fn bipartite(graph: &Graph) -> DiGraph<Node, AccessId> {
    let nodes = graph.passes().len() + graph.resources().len();
    let mut out = DiGraph::with_capacity(nodes, graph.accesses().len());
    let passes: Vec<_> = graph.pass_ids().map(|p| out.add_node(Node::Pass(p))).collect();
    let resources: Vec<_> = graph.resource_ids().map(|r| out.add_node(Node::Resource(r))).collect();
    for (pass, row) in passes.into_iter().zip(graph.passes()) {
        for at in row.accesses.range() {
            let access = &graph.accesses()[at];
            let resource = resources[access.resource.index()];
            if access.needs_contents() {
                out.add_edge(resource, pass, AccessId::at(at));
            }
            if access.mode.writes() {
                out.add_edge(pass, resource, AccessId::at(at));
            }
        }
    }
    out
}

/// Returns a graph with passes as nodes, in order, and an edge for each flow. `flows` comes from
/// [`data_flow`](super::data_flow) or [`reduced`](super::reduced).
pub fn flows(graph: &Graph, flows: &[Flow]) -> DiGraph<PassId, Vec<ResourceId>> {
    let mut out = DiGraph::with_capacity(graph.passes().len(), flows.len());
    graph.pass_ids().for_each(|p| _ = out.add_node(p));
    for Flow { from, to, resources } in flows {
        out.add_edge(NodeIndex::new(from.index()), NodeIndex::new(to.index()), resources.clone());
    }
    out
}
