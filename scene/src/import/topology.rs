//! Primitive modes into triangle lists (glTF 2.0, section 3.7.2.1).

use gltf_json::mesh::Mode;

/// The corners of a triangle list, or why there is none.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Triangles {
    /// Three a triangle, counter-clockwise.
    List(Vec<u32>),
    /// Points or lines: the name of the mode.
    Other(&'static str),
    /// A triangle list whose length is no multiple of three.
    Incomplete,
}

/// Turns `corners` of a mode into a triangle list. Strips and fans repeat corners to jump; triangles
/// that use one vertex twice cover nothing and are left out.
pub(super) fn triangles(mode: Mode, corners: &[u32]) -> Triangles {
    let list: Vec<[u32; 3]> = match mode {
        Mode::Points => return Triangles::Other("points"),
        Mode::Lines => return Triangles::Other("lines"),
        Mode::LineLoop => return Triangles::Other("a line loop"),
        Mode::LineStrip => return Triangles::Other("a line strip"),
        Mode::Triangles => {
            if !corners.len().is_multiple_of(3) {
                return Triangles::Incomplete;
            }
            corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
        }
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            // Every second triangle of a strip winds the other way round.
            .map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] })
            .collect(),
        Mode::TriangleFan => match corners.split_first() {
            Some((&hub, rim)) => rim.windows(2).map(|t| [t[0], t[1], hub]).collect(),
            None => Vec::new(),
        },
    };
    let proper = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    Triangles::List(list.into_iter().filter(proper).flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let of = |mode, corners: &[u32]| triangles(mode, corners);
        assert_eq!(of(Mode::TriangleStrip, &[0, 1, 2, 3, 4]), Triangles::List(vec![0, 1, 2, 1, 3, 2, 2, 3, 4]));
        assert_eq!(of(Mode::TriangleFan, &[9, 1, 2, 3]), Triangles::List(vec![1, 2, 9, 2, 3, 9]));
        // A strip that jumps by repeating corners.
        assert_eq!(of(Mode::TriangleStrip, &[0, 1, 2, 2, 5, 5, 6, 7]), Triangles::List(vec![0, 1, 2, 5, 7, 6]));
        assert_eq!(of(Mode::Triangles, &[0, 1, 2, 3]), Triangles::Incomplete);
        assert_eq!(of(Mode::Triangles, &[4, 4, 5]), Triangles::List(vec![]));
        for few in [&[][..], &[1], &[1, 2]] {
            assert_eq!(of(Mode::TriangleStrip, few), Triangles::List(vec![]));
            assert_eq!(of(Mode::TriangleFan, few), Triangles::List(vec![]));
        }
        assert_eq!(of(Mode::LineLoop, &[0, 1]), Triangles::Other("a line loop"));
    }
}
