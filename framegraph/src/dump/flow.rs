//! What flows from pass to pass: the arrows worth drawing.

use crate::access::Access;
use crate::format::Aspect;
use crate::graph::Graph;
use crate::id::{PassId, ResourceId};

/// One pass needs what another wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flow {
    /// The writer, declared before the reader.
    pub from: PassId,
    /// The reader.
    pub to: PassId,
    /// The resources whose contents flow, in the order of their ids.
    pub resources: Vec<ResourceId>,
}

/// Which pass needs what another wrote, sorted by writer, then reader. Followed by level, layer and plane. Acyclic, since a
/// graph is declared in order.
pub fn data_flow(graph: &Graph) -> Vec<Flow> {
    let mut flows: Vec<Flow> = Vec::new();
    // By resource: the writes of which something is left, as pass and access.
    let mut visible: Vec<Vec<(PassId, &Access)>> = vec![Vec::new(); graph.resources().len()];
    for to in graph.pass_ids() {
        let first = flows.len();
        let accesses = graph.accesses_of(to);
        for access in accesses.iter().filter(|a| a.mode.needs_contents()) {
            let resource = access.resource;
            let overlaps = |(_, w): &&(PassId, &Access)| graph.overlap(resource, &w.range, &access.range);
            let writes = visible[resource.index()].iter().filter(overlaps);
            for &(from, _) in writes {
                match flows[first..].iter_mut().find(|f| f.from == from) {
                    Some(flow) if flow.resources.contains(&resource) => {}
                    Some(flow) => flow.resources.push(resource),
                    None => flows.push(Flow { from, to, resources: vec![resource] }),
                }
            }
        }
        for access in accesses.iter().filter(|a| a.mode.writes()) {
            let visible = &mut visible[access.resource.index()];
            visible.retain(|(_, earlier)| !covers(graph, access, earlier));
            visible.push((to, access));
        }
    }
    flows.iter_mut().for_each(|f| f.resources.sort_unstable());
    flows.sort_by_key(|f| (f.from, f.to));
    flows
}

/// Whether nothing of the earlier write is left after the later one. A modifying write passes on what it found, so that
/// its reader depends on the earlier writer through it.
fn covers(graph: &Graph, later: &Access, earlier: &Access) -> bool {
    let (l, e) = (&later.range, &earlier.range);
    if let Some(l) = graph.bytes_of(later) {
        return graph.bytes_of(earlier).is_some_and(|e| l.offset <= e.offset && e.end() <= l.end());
    }
    let within = |a: std::ops::Range<u32>, b: std::ops::Range<u32>| b.start <= a.start && a.end <= b.end;
    let (mips, layers) = (u32::from(u8::MAX), u32::from(u16::MAX));
    within(e.mip_range(mips), l.mip_range(mips))
        && within(e.layer_range(layers), l.layer_range(layers))
        && (l.aspect == Aspect::All || l.aspect == e.aspect)
}

/// The flows of a graph of so many passes that no longer way implies (transitive reduction; Aho, Garey and Ullman 1972).
/// Time and memory grow with the square of the number of passes.
pub fn reduced(flows: &[Flow], passes: usize) -> Vec<Flow> {
    let words = passes.div_ceil(64);
    let mut reached = vec![0u64; passes * words];
    let mut kept = Vec::new();
    // All that a writer's readers reach is known before the writer is looked at; its nearest reader can imply the others.
    for of_writer in flows.chunk_by(|a, b| a.from == b.from).rev() {
        for flow in of_writer {
            let (from, to) = (flow.from.index() * words, flow.to.index());
            if reached[from + to / 64] >> (to % 64) & 1 == 0 {
                kept.push(flow.clone());
            }
            reached[from + to / 64] |= 1 << (to % 64);
            for word in 0..words {
                reached[from + word] |= reached[to * words + word];
            }
        }
    }
    kept.sort_by_key(|f| (f.from, f.to));
    kept
}
