//! Splitting of vertices whose corners differ.

use std::collections::HashMap;
use std::hash::Hash;

/// Index buffer over new vertices, and the source of each new vertex.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Split {
    /// New vertex of each corner, in corner order.
    pub indices: Vec<u32>,
    /// Old vertex that each new vertex copies.
    pub source_vertex: Vec<u32>,
    /// First corner that uses each new vertex.
    pub source_corner: Vec<u32>,
}

/// Creates one new vertex for each distinct pair (old vertex, key), numbered by first appearance.
///
/// `indices` holds the old vertex of each corner; `key` returns, as bits, the other data of that corner. The result is
/// deterministic.
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
