//! Versions of resources, and the order of passes that follows from them. This allows a file to list its passes in any
//! order.
//!
//! Each pass that writes a resource replaces one version of it. A version has one writer and is replaced at most once;
//! every pass that reads it runs in between. These constraints are the edges of a graph. Cycles are errors. Passes are
//! declared in the topological order closest to the order of the file.

use super::error::{FileError, FileErrors, FileReason};
use super::selected::{Mention, Selected, Wanted};
use super::spanned::Source;
use super::value::ValueReason;
use crate::compile::CompileReason;
use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, VecDeque};

/// A version: written by this pass, or the initial version.
type Version = Option<usize>;

/// The version that each pass starts from, and the pass that replaces each version.
#[derive(Debug, Default)]
struct Versions {
    /// For each pass: resource, version at its start, and `true` if it writes the resource.
    base: Vec<Vec<(usize, Version, bool)>>,
    /// The pass that replaces a version.
    next: HashMap<(usize, Version), usize>,
}

/// Returns the order in which the passes are declared, as rows of `selected`. Collects errors and marks invalid passes.
pub(super) fn order(source: Source<'_>, selected: &mut Selected<'_>, errors: &mut FileErrors) -> Vec<usize> {
    let mut failed = Vec::new();
    let versions = versions(source, selected, &mut failed, errors);
    exports(source, selected, &versions, errors);
    let edges = edges(selected, &versions);
    let order = sorted(selected.passes.len(), &edges);
    if order.len() < selected.passes.len() {
        cycles(source, selected, &edges, errors);
        let mut waits = vec![true; selected.passes.len()];
        order.iter().for_each(|pass| waits[*pass] = false);
        failed.extend((0..waits.len()).filter(|pass| waits[*pass]));
    }
    failed.into_iter().for_each(|pass| selected.fail(pass));
    order
}

fn versions(source: Source<'_>, selected: &Selected<'_>, failed: &mut Vec<usize>, errors: &mut FileErrors) -> Versions {
    let mut writers = vec![Vec::new(); selected.resources.len()];
    for (pass, row) in selected.passes.iter().enumerate() {
        for mention in row.mentions.iter().filter(|t| t.writes) {
            if writers[mention.resource].last() != Some(&pass) {
                writers[mention.resource].push(pass);
            }
        }
    }
    let mut out = Versions::default();
    let mut newest: Vec<Version> = vec![None; selected.resources.len()];
    for (pass, row) in selected.passes.iter().enumerate() {
        let found = errors.count();
        let mut bases: Vec<(usize, Version, bool)> = Vec::new();
        let mut named: HashMap<usize, &Mention<'_>> = HashMap::new();
        for mention in &row.mentions {
            if let Some(version) = wanted(source, selected, &writers, &newest, mention, errors) {
                match bases.iter_mut().find(|(r, ..)| *r == mention.resource) {
                    None => bases.push((mention.resource, version, mention.writes)),
                    Some((_, base, writes)) => {
                        *writes |= mention.writes;
                        // A plain name has the version that the pass requests explicitly elsewhere.
                        let other = named.get(&mention.resource);
                        let explicit = mention.version != Wanted::Newest;
                        if let (Some(other), true, true) = (other, explicit, *base != version) {
                            let other = other.at.value.clone();
                            let reason = FileReason::TwoVersions { other };
                            errors.push(|| at(source, selected, pass, mention, reason));
                        } else if explicit {
                            *base = version;
                        }
                    }
                }
                if matches!(mention.version, Wanted::By(_) | Wanted::Entry) {
                    named.entry(mention.resource).or_insert(mention);
                }
            }
        }
        for &(resource, base, writes) in &bases {
            if writes {
                if let Some(&other) = out.next.get(&(resource, base)) {
                    let other = selected.passes[other].id.value.clone();
                    let reason = FileReason::Compile(CompileReason::TwoWriters { other });
                    let mention = row.mentions.iter().find(|t| t.resource == resource && t.writes);
                    if let Some(mention) = mention {
                        errors.push(|| at(source, selected, pass, mention, reason));
                    }
                } else {
                    out.next.insert((resource, base), pass);
                }
                newest[resource] = Some(pass);
            }
        }
        if errors.count() != found {
            failed.push(pass);
        }
        out.base.push(bases);
    }
    out
}

/// Returns the version that a mention refers to; `None` for a previous image, or after an error.
fn wanted(
    source: Source<'_>,
    selected: &Selected<'_>,
    writers: &[Vec<usize>],
    newest: &[Version],
    mention: &Mention<'_>,
    errors: &mut FileErrors,
) -> Option<Version> {
    match mention.version {
        Wanted::Newest => Some(newest[mention.resource]),
        Wanted::Entry => Some(None),
        Wanted::Previous(_) => None,
        Wanted::By(pass) if writers[mention.resource].binary_search(&pass).is_ok() => Some(Some(pass)),
        Wanted::By(pass) => {
            let id = |pass: &usize| selected.passes[*pass].id.value.clone();
            let writers = writers[mention.resource].iter().take(9).map(id).collect();
            let reason = FileReason::NotWrittenBy { pass: id(&pass), writers };
            errors.push(|| source.error(mention.at, reason).of_resource(selected.resources[mention.resource]));
            None
        }
    }
}

fn at(
    source: Source<'_>,
    selected: &Selected<'_>,
    pass: usize,
    mention: &Mention<'_>,
    reason: FileReason,
) -> FileError {
    let (pass, resource) = (&selected.passes[pass].id.value, selected.resources[mention.resource]);
    source.error(mention.at, reason).of_pass(pass).of_resource(resource)
}

/// Checks that exports refer to the last version.
fn exports(source: Source<'_>, selected: &Selected<'_>, versions: &Versions, errors: &mut FileErrors) {
    for (_, mention) in &selected.exports {
        let id = |pass: usize| selected.passes[pass].id.value.clone();
        let version = match mention.version {
            Wanted::Newest => continue,
            Wanted::Entry => Ok(None),
            Wanted::By(pass) => {
                let writes = |(r, _, writes): &(usize, Version, bool)| *r == mention.resource && *writes;
                let written = versions.base[pass].iter().any(writes);
                let none = FileReason::NotWrittenBy { pass: id(pass), writers: Vec::new() };
                if written { Ok(Some(pass)) } else { Err(none) }
            }
            Wanted::Previous(_) => Err(FileReason::Value(ValueReason::ExportsEarlierFrame)),
        };
        let next = |version| versions.next.get(&(mention.resource, version));
        let reason = match version.map(next) {
            Ok(None) => continue,
            Ok(Some(&next)) => FileReason::NotLast { writer: id(next) },
            Err(reason) => reason,
        };
        errors.push(|| source.error(mention.at, reason).of_resource(selected.resources[mention.resource]));
    }
}

/// Returns for each pass the passes that must run after it.
fn edges(selected: &Selected<'_>, versions: &Versions) -> Vec<Vec<usize>> {
    let mut edges = vec![Vec::new(); selected.passes.len()];
    for (pass, bases) in versions.base.iter().enumerate() {
        for &(resource, base, writes) in bases {
            if let Some(writer) = base {
                edges[writer].push(pass);
            }
            if let (Some(&next), false) = (versions.next.get(&(resource, base)), writes) {
                edges[pass].push(next);
            }
        }
        for &before in &selected.passes[pass].after {
            edges[before].push(pass);
        }
    }
    edges
}

/// Returns the topological order closest to the order of the file, without passes on cycles.
fn sorted(passes: usize, edges: &[Vec<usize>]) -> Vec<usize> {
    let mut waits = vec![0usize; passes];
    for next in edges.iter().flatten() {
        waits[*next] += 1;
    }
    let mut ready: BinaryHeap<_> = (0..passes).filter(|p| waits[*p] == 0).map(Reverse).collect();
    let mut order = Vec::with_capacity(passes);
    while let Some(Reverse(pass)) = ready.pop() {
        order.push(pass);
        for &next in &edges[pass] {
            waits[next] -= 1;
            if waits[next] == 0 {
                ready.push(Reverse(next));
            }
        }
    }
    order
}

/// Reports each strongly connected component, with a shortest cycle. Kosaraju's algorithm uses its own stack, so long
/// cycles cannot overflow that of the thread.
fn cycles(source: Source<'_>, selected: &Selected<'_>, edges: &[Vec<usize>], errors: &mut FileErrors) {
    let mut graph = DiGraph::<(), (), usize>::default();
    for _ in edges {
        graph.add_node(());
    }
    for (from, to) in edges.iter().enumerate().flat_map(|(f, to)| to.iter().map(move |t| (f, *t))) {
        graph.add_edge(NodeIndex::new(from), NodeIndex::new(to), ());
    }
    for component in kosaraju_scc(&graph) {
        let mut members: Vec<_> = component.into_iter().map(NodeIndex::index).collect();
        members.sort_unstable();
        let first = members[0];
        if members.len() == 1 && !edges[first].contains(&first) {
            continue;
        }
        let passes = way_round(first, edges, &members);
        let name = |pass: &usize| selected.passes[*pass].id.value.clone();
        let passes = passes.iter().map(name).collect();
        let reason = FileReason::Compile(CompileReason::Cycle { passes });
        let first = selected.passes[first].id;
        errors.push(|| source.error(first, reason).of_pass(&first.value));
    }
}

/// Returns the passes of a shortest cycle through `first` within `members`.
fn way_round(first: usize, edges: &[Vec<usize>], members: &[usize]) -> Vec<usize> {
    let mut came_from = HashMap::new();
    let mut queue = VecDeque::from([first]);
    while let Some(pass) = queue.pop_front() {
        for &next in &edges[pass] {
            if next == first {
                let mut way = vec![pass];
                while let Some(&before) = came_from.get(&way[way.len() - 1]) {
                    way.push(before);
                }
                way.reverse();
                return way;
            }
            if members.binary_search(&next).is_ok() && !came_from.contains_key(&next) {
                came_from.insert(next, pass);
                queue.push_back(next);
            }
        }
    }
    members.to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_the_file_is_kept_where_it_can_be() {
        assert_eq!(sorted(4, &[vec![1], vec![], vec![], vec![]]), [0, 1, 2, 3]);
        // 0 depends on 2; 1 and 3 keep their positions.
        assert_eq!(sorted(4, &[vec![], vec![], vec![0], vec![]]), [1, 2, 0, 3]);
        assert_eq!(sorted(3, &[vec![1], vec![0], vec![]]), [2]);
    }

    #[test]
    fn the_way_round_is_a_shortest_one() {
        let edges = [vec![1, 2], vec![2], vec![3], vec![0]];
        assert_eq!(way_round(0, &edges, &[0, 1, 2, 3]), [0, 2, 3]);
        assert_eq!(way_round(0, &[vec![0]], &[0]), [0]);
    }
}
