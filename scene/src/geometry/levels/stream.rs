//! What vertices have beside their places, as far as it is seen.

use crate::mesh::Mesh;
use glam::Vec4;

/// Which of the optional streams of a mesh its materials read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadStreams {
    /// Tangents: where there are maps of normals, or grooves.
    pub tangents: bool,
    /// Of each set of texture coordinates how many texels there are from 0 to 1, of the finest texture that it is for; 0 where nothing
    /// reads it.
    pub uv_texels: [f32; 2],
}

/// One number of every vertex or up to four.
pub(super) struct Stream<'a> {
    of: Box<dyn Fn(usize) -> Vec4 + 'a>,
    /// How many numbers count.
    pub width: usize,
    /// What differs by no more is the same.
    pub unseen: f32,
    /// Whether what is between two is made of unit length.
    pub unit: bool,
}

/// Of normals and tangents, in radians.
const SAME_DIRECTION: f32 = 1.0 / 256.0;
/// Of texture coordinates, in texels.
const SAME_TEXELS: f32 = 1.0 / 8.0;
/// Of colors, which are linear: less than half a code of 255 near black, where codes are finest.
const SAME_COLOR: f32 = 1.0 / 8192.0;

impl Stream<'_> {
    pub fn of(&self, vertex: u32) -> Vec4 {
        (self.of)(vertex as usize)
    }
}

/// The streams of a mesh that are seen.
pub(super) fn streams(mesh: &Mesh, read: ReadStreams) -> Vec<Stream<'_>> {
    let mut all: Vec<Stream<'_>> = Vec::new();
    let normal = |i: usize| mesh.normals[i].extend(0.0);
    all.push(Stream { of: Box::new(normal), width: 3, unseen: SAME_DIRECTION, unit: true });
    if read.tangents && !mesh.tangents.is_empty() {
        let of = |i: usize| mesh.tangents[i].truncate().extend(0.0);
        all.push(Stream { of: Box::new(of), width: 3, unseen: SAME_DIRECTION, unit: true });
        // The side that the bitangent is on is 1 or -1.
        let side = |i: usize| Vec4::X * mesh.tangents[i].w;
        all.push(Stream { of: Box::new(side), width: 1, unseen: 0.5, unit: false });
    }
    for (uv, texels) in [&mesh.uv0, &mesh.uv1].into_iter().zip(read.uv_texels) {
        if texels > 0.0 && !uv.is_empty() {
            let of = |i: usize| uv[i].extend(0.0).extend(0.0);
            all.push(Stream { of: Box::new(of), width: 2, unseen: SAME_TEXELS / texels, unit: false });
        }
    }
    if !mesh.colors.is_empty() {
        all.push(Stream { of: Box::new(|i| mesh.colors[i]), width: 4, unseen: SAME_COLOR, unit: false });
    }
    all
}
