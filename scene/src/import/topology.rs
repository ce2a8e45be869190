//! Conversion of primitive modes to lists of triangles, lines or points (glTF 2.0, section 3.7.2.1).

use gltf_json::mesh::Mode;

use crate::mesh::Topology;

/// All modes, in the order of their numbers.
pub(super) const MODES: [Mode; 7] = [
    Mode::Points,
    Mode::Lines,
    Mode::LineLoop,
    Mode::LineStrip,
    Mode::Triangles,
    Mode::TriangleStrip,
    Mode::TriangleFan,
];

/// Returns the topology of a mode after conversion to a list.
pub(super) const fn topology(mode: Mode) -> Topology {
    match mode {
        Mode::Points => Topology::Points,
        Mode::Lines | Mode::LineLoop | Mode::LineStrip => Topology::Lines,
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => Topology::Triangles,
    }
}

/// Converts indices of a mode to a list of its [`topology`]. Degenerate triangles and lines, which strips and fans use
/// to restart, are removed, as are the [`left_over`] indices.
pub(super) fn list(mode: Mode, corners: &[u32]) -> Vec<u32> {
    match topology(mode) {
        Topology::Points => corners.to_vec(),
        Topology::Lines => lines(mode, corners),
        Topology::Triangles => triangles(mode, corners),
    }
}

/// Returns the number of trailing indices that form no complete triangle or line.
pub(super) fn left_over(mode: Mode, corners: usize) -> usize {
    match mode {
        Mode::Triangles | Mode::Lines => corners % topology(mode).corners(),
        _ => 0,
    }
}

fn lines(mode: Mode, corners: &[u32]) -> Vec<u32> {
    let list: Vec<[u32; 2]> = match mode {
        Mode::Lines => corners.chunks_exact(2).map(|line| [line[0], line[1]]).collect(),
        _ => {
            let strip = corners.windows(2).map(|line| [line[0], line[1]]);
            // The last line of a loop returns to its first vertex.
            let back = match corners {
                [first, .., last] if mode == Mode::LineLoop => Some([*last, *first]),
                _ => None,
            };
            strip.chain(back).collect()
        }
    };
    list.into_iter().filter(|line| line[0] != line[1]).flatten().collect()
}

fn triangles(mode: Mode, corners: &[u32]) -> Vec<u32> {
    let list: Vec<[u32; 3]> = match mode {
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            // Every second triangle of a strip has the opposite winding.
            .map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] })
            .collect(),
        Mode::TriangleFan => match corners.split_first() {
            Some((&hub, rim)) => rim.windows(2).map(|t| [t[0], t[1], hub]).collect(),
            None => Vec::new(),
        },
        _ => corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    };
    let proper = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    list.into_iter().filter(proper).flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let of = |mode, corners: &[u32]| list(mode, corners);
        assert_eq!(of(Mode::TriangleStrip, &[0, 1, 2, 3, 4]), [0, 1, 2, 1, 3, 2, 2, 3, 4]);
        assert_eq!(of(Mode::TriangleFan, &[9, 1, 2, 3]), [1, 2, 9, 2, 3, 9]);
        // A strip that restarts with repeated indices.
        assert_eq!(of(Mode::TriangleStrip, &[0, 1, 2, 2, 5, 5, 6, 7]), [0, 1, 2, 5, 7, 6]);
        assert!(of(Mode::Triangles, &[4, 4, 5]).is_empty());
        for few in [&[][..], &[1], &[1, 2]] {
            assert!(of(Mode::TriangleStrip, few).is_empty());
            assert!(of(Mode::TriangleFan, few).is_empty());
        }
    }

    /// Section 3.7.2.1: lines of a strip join neighbors, and a loop also joins its last vertex to its first.
    #[test]
    fn lines_join_neighbors_and_loops_close() {
        let of = |mode, corners: &[u32]| list(mode, corners);
        assert_eq!(of(Mode::Points, &[3, 3, 1]), [3, 3, 1]);
        assert_eq!(of(Mode::Lines, &[0, 1, 7, 7, 2, 5]), [0, 1, 2, 5]);
        assert_eq!(of(Mode::LineStrip, &[4, 5, 5, 6]), [4, 5, 5, 6]);
        assert_eq!(of(Mode::LineLoop, &[4, 5, 6]), [4, 5, 5, 6, 6, 4]);
        assert_eq!(of(Mode::LineLoop, &[4, 5]), [4, 5, 5, 4]);
        for few in [&[][..], &[1], &[1, 1]] {
            assert!(of(Mode::LineStrip, few).is_empty());
            assert!(of(Mode::LineLoop, few).is_empty());
        }
    }

    #[test]
    fn lists_of_other_lengths_are_no_primitives() {
        for (mode, left) in [(Mode::Triangles, 1), (Mode::Lines, 0), (Mode::TriangleStrip, 0)] {
            assert_eq!(left_over(mode, 4), left);
        }
        assert_eq!((list(Mode::Triangles, &[0, 1, 2, 3]), list(Mode::Lines, &[0, 1, 2])), (vec![0, 1, 2], vec![0, 1]));
    }
}
