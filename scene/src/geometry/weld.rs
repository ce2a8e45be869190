//! Splitting vertices whose corners disagree.

use std::collections::HashMap;
use std::hash::Hash;

/// An index buffer over new vertices, and where each new vertex came from.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Split {
    /// One new vertex number a corner, in corner order.
    pub indices: Vec<u32>,
    /// For each new vertex, the old vertex it copies.
    pub source_vertex: Vec<u32>,
    /// For each new vertex, the first corner that asked for it.
    pub source_corner: Vec<u32>,
}

/// Gives every distinct pair (old vertex, key) one new vertex, numbered by first appearance.
///
/// `indices` holds the old vertex of each corner, `key` what that corner wants of its vertex
/// besides, as bits. The result depends on the input alone: the map is only ever looked up.
pub(crate) fn split_by_key<K: Eq + Hash>(indices: &[u32], key: impl Fn(usize) -> K) -> Split {
    let mut known: HashMap<(u32, K), u32> = HashMap::with_capacity(indices.len());
    let mut split =
        Split { indices: Vec::with_capacity(indices.len()), source_vertex: Vec::new(), source_corner: Vec::new() };
    for (corner, &vertex) in indices.iter().enumerate() {
        let next = split.source_vertex.len() as u32;
        let number = *known.entry((vertex, key(corner))).or_insert(next);
        if number == next {
            split.source_vertex.push(vertex);
            split.source_corner.push(corner as u32);
        }
        split.indices.push(number);
    }
    split
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_that_agree_share_a_vertex() {
        let keys = [7, 7, 7, 8, 7, 7];
        let split = split_by_key(&[0, 1, 2, 0, 2, 3], |corner| keys[corner]);
        assert_eq!(split.indices, [0, 1, 2, 3, 2, 4]);
        assert_eq!(split.source_vertex, [0, 1, 2, 0, 3]);
        assert_eq!(split.source_corner, [0, 1, 2, 3, 5]);
    }
}
