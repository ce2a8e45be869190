//! Phase 3, initial orders: list schedules that group mergeable passes and reduce live bytes.
//!
//! Among the ready passes, the scheduler picks the first one that could share the current step. If there is none, it
//! picks the one after which the fewest bytes are live; ties are resolved in declaration order. These are estimates,
//! because merging depends on the whole step. `order` plans and improves them.

use super::parts::Parts;
use crate::access::AccessKind;
use crate::graph::{PassFlags, PassKind, Tables};
use crate::id::{PassId, ResourceId};

/// Priority of a schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aim {
    /// Passes that could share the current step, then few live bytes.
    MergeThenBytes,
    /// Passes that could share the current step, then declaration order.
    Merge,
    /// Few live bytes.
    Bytes,
}

impl Aim {
    /// All priorities, in the order in which they are tried.
    pub(crate) const ALL: [Self; 3] = [Self::MergeThenBytes, Self::Merge, Self::Bytes];
}

/// Maximum number of ready passes examined per choice. Keeps scheduling near-linear for wide graphs.
const WINDOW: usize = 64;

/// Memory of the phase, reused between compilations.
#[derive(Debug, Default)]
pub(crate) struct ScheduleScratch {
    /// Dependencies as pairs (before, after), sorted by their first element.
    edges: Vec<(u32, u32)>,
    starts: Vec<u32>,
    waiting: Vec<u32>,
    ready: Vec<u32>,
    last_writer: Vec<u32>,
    readers: Vec<(u32, u32)>,
    reader_head: Vec<u32>,
    uses_left: Vec<u32>,
    bytes: Vec<u64>,
    live: Vec<bool>,
    step: Vec<u32>,
}

const NIL: u32 = u32::MAX;

impl ScheduleScratch {
    /// The dependents of pass `index` of the declared order, as pairs (index, dependent).
    pub(crate) fn waiting_for(&self, index: u32) -> &[(u32, u32)] {
        let at = index as usize;
        &self.edges[self.starts[at] as usize..self.starts[at + 1] as usize]
    }
}

/// Fills `order` with the kept passes, as indices of `declared`. `scratch` contains the dependencies.
pub(crate) fn schedule(
    graph: &Tables,
    frame: [u32; 2],
    declared: &[PassId],
    aim: Aim,
    scratch: &mut ScheduleScratch,
    order: &mut Vec<u32>,
) {
    weigh(graph, frame, declared, scratch);
    order.clear();
    let ScheduleScratch { edges, starts, waiting, ready, uses_left, bytes, live, step, .. } = scratch;
    waiting.clear();
    waiting.resize(declared.len(), 0);
    for (_, after) in edges.iter() {
        waiting[*after as usize] += 1;
    }
    ready.clear();
    ready.extend((0..declared.len() as u32).filter(|p| waiting[*p as usize] == 0));
    step.clear();
    while !ready.is_empty() {
        let window = &ready[..ready.len().min(WINDOW)];
        let accesses = |p: u32| graph.accesses_of(declared[p as usize]);
        let joins = |p: u32| aim != Aim::Bytes && could_join(graph, declared, step, p);
        let joined = window.iter().position(|p| joins(*p));
        let (at, merged) = match (joined, aim) {
            (Some(at), _) => (at, true),
            (None, Aim::Merge) => (0, false),
            (None, _) => (cheapest(window, |p| delta(accesses(p), uses_left, bytes, live)), false),
        };
        let pass = ready.remove(at);
        order.push(pass);
        if !merged {
            step.clear();
        }
        step.push(pass);
        for access in accesses(pass) {
            uses_left[access.resource.index()] -= 1;
            live[access.resource.index()] = uses_left[access.resource.index()] > 0;
        }
        for (_, after) in &edges[starts[pass as usize] as usize..starts[pass as usize + 1] as usize] {
            let left = &mut waiting[*after as usize];
            *left -= 1;
            if *left == 0 {
                let place = ready.partition_point(|r| r < after);
                ready.insert(place, *after);
            }
        }
    }
    debug_assert_eq!(order.len(), declared.len(), "declaration order has no cycles");
}

/// Computes the dependencies. A pass depends on the writers of the resources it accesses; a writer also depends on the
/// readers of the contents it replaces. Passes with side effects stay in order.
pub(crate) fn dependencies(graph: &Tables, parts: &Parts, declared: &[PassId], scratch: &mut ScheduleScratch) {
    let ScheduleScratch { edges, starts, last_writer, readers, reader_head, .. } = scratch;
    edges.clear();
    readers.clear();
    for (table, value) in [(&mut *last_writer, NIL), (&mut *reader_head, NIL)] {
        table.clear();
        table.resize(parts.total(), value);
    }
    let mut last_effect = NIL;
    for (index, pass) in declared.iter().enumerate() {
        let after = index as u32;
        let first_edge = edges.len();
        let mut edge = |before: u32| {
            if before != NIL && before != after && edges[first_edge..].iter().all(|e| e.0 != before) {
                edges.push((before, after));
            }
        };
        for access in graph.accesses_of(*pass) {
            parts.runs(access.resource, access.range, |run| {
                for part in run {
                    edge(last_writer[part]);
                    if access.mode.writes() {
                        let mut at = reader_head[part];
                        while at != NIL {
                            edge(readers[at as usize].0);
                            at = readers[at as usize].1;
                        }
                        last_writer[part] = after;
                        reader_head[part] = NIL;
                    } else {
                        readers.push((after, reader_head[part]));
                        reader_head[part] = readers.len() as u32 - 1;
                    }
                }
            });
        }
        if graph.passes[pass.index()].flags.has(PassFlags::SIDE_EFFECT) {
            edge(last_effect);
            last_effect = after;
        }
    }
    edges.sort_unstable();
    starts.clear();
    starts.resize(declared.len() + 1, 0);
    for (before, _) in edges.iter() {
        starts[*before as usize + 1] += 1;
    }
    for index in 1..starts.len() {
        starts[index] += starts[index - 1];
    }
}

/// Computes the number of accesses of each resource, and its size; 0 if it does not share memory.
fn weigh(graph: &Tables, frame: [u32; 2], declared: &[PassId], scratch: &mut ScheduleScratch) {
    let ScheduleScratch { uses_left, bytes, live, .. } = scratch;
    uses_left.clear();
    uses_left.resize(graph.resources.len(), 0);
    for pass in declared {
        for access in graph.accesses_of(*pass) {
            uses_left[access.resource.index()] += 1;
        }
    }
    bytes.clear();
    bytes.extend(graph.resources.iter().map(|r| match r.kind {
        crate::resource::Kind::Transient => r.desc.bytes(frame),
        _ => 0,
    }));
    for export in &graph.exports {
        bytes[export.resource.index()] = 0;
    }
    live.clear();
    live.resize(graph.resources.len(), false);
}

/// Change of live bytes caused by a pass.
fn delta(accesses: &[crate::access::Access], uses_left: &[u32], bytes: &[u64], live: &[bool]) -> i128 {
    let mut sum = 0i128;
    for (index, access) in accesses.iter().enumerate() {
        let r = access.resource.index();
        let again = |a: &&crate::access::Access| a.resource == access.resource;
        if accesses[..index].iter().any(|a| a.resource == access.resource) {
            continue;
        }
        let here = accesses.iter().filter(again).count() as u32;
        sum += if live[r] { 0 } else { i128::from(bytes[r]) };
        sum -= if uses_left[r] == here { i128::from(bytes[r]) } else { 0 };
    }
    sum
}

fn cheapest(window: &[u32], delta: impl Fn(u32) -> i128) -> usize {
    let mut best = (0, i128::MAX);
    for (at, pass) in window.iter().enumerate() {
        let bytes = delta(*pass);
        if bytes < best.1 {
            best = (at, bytes);
        }
    }
    best.0
}

/// Returns `true` if a pass might join the step formed by the passes in `step`. It must draw into one of their
/// attachments or read it at the same pixel, and must not sample any of them.
pub(crate) fn could_join(graph: &Tables, declared: &[PassId], step: &[u32], pass: u32) -> bool {
    let id = declared[pass as usize];
    if graph.passes[id.index()].kind != PassKind::Raster || step.is_empty() {
        return false;
    }
    let members = || step.iter().map(|m| declared[*m as usize]);
    if members().any(|m| graph.passes[m.index()].kind != PassKind::Raster) {
        return false;
    }
    let attached =
        |r: ResourceId| members().flat_map(|m| graph.accesses_of(m)).any(|a| a.resource == r && a.kind.is_attachment());
    let accesses = graph.accesses_of(id);
    let shares =
        accesses.iter().any(|a| (a.kind.is_attachment() || a.kind == AccessKind::SamePixel) && attached(a.resource));
    let samples = accesses.iter().any(|a| a.kind == AccessKind::Sampled && attached(a.resource));
    shares && !samples
}
