//! Data flow between passes.

use crate::access::Access;
use crate::format::Aspect;
use crate::graph::Graph;
use crate::id::{PassId, ResourceId};

/// A data dependency between two passes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flow {
    /// The writer, declared before the reader.
    pub from: PassId,
    /// The reader.
    pub to: PassId,
    /// The resources whose contents the reader uses, ordered by id.
    pub resources: Vec<ResourceId>,
}

/// Returns the data dependencies between passes, sorted by writer, then reader. Subresources are tracked separately.
/// The result is acyclic, because passes are declared in order.
pub fn data_flow(graph: &Graph) -> Vec<Flow> {
    let mut flows: Vec<Flow> = Vec::new();
    // By resource: writes that are at least partly visible, as pass and access.
    let mut visible: Vec<Vec<(PassId, &Access)>> = vec![Vec::new(); graph.resources().len()];
    for to in graph.pass_ids() {
        let first = flows.len();
        let accesses = graph.accesses_of(to);
        for access in accesses.iter().filter(|a| a.needs_contents()) {
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

/// Returns `true` if nothing of the earlier write is visible after the later one. A reader after a modifying write
/// depends on the earlier writer through it.
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

/// Returns the flows that are not implied by others (transitive reduction; Aho, Garey and Ullman 1972). `passes` is the
/// number of passes. Time and memory are quadratic in it.
pub fn reduced(flows: &[Flow], passes: usize) -> Vec<Flow> {
    let words = passes.div_ceil(64);
    let mut reached = vec![0u64; passes * words];
    let mut kept = Vec::new();
    // Writers are processed in reverse, so that everything reachable from their readers is known.
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
