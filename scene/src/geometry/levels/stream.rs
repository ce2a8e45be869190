//! Attributes of vertices that affect the image.

use crate::mesh::Mesh;
use glam::Vec4;

/// Optional vertex streams that the materials of a mesh read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadStreams {
    /// Tangents: read by normal maps and anisotropy.
    pub tangents: bool,
    /// Texels per unit of each set of texture coordinates, for the finest texture that uses it; 0 if nothing reads the
    /// set.
    pub uv_texels: [f32; 2],
}

/// An attribute of up to four numbers per vertex.
pub(super) struct Stream<'a> {
    of: Box<dyn Fn(usize) -> Vec4 + 'a>,
    /// Number of relevant components.
    pub width: usize,
    /// Maximum difference that counts as equal.
    pub unseen: f32,
    /// True if interpolated values are normalized.
    pub unit: bool,
}

/// Tolerance of normals and tangents, in radians.
const SAME_DIRECTION: f32 = 1.0 / 256.0;
/// Tolerance of texture coordinates, in texels.
const SAME_TEXELS: f32 = 1.0 / 8.0;
/// Tolerance of linear colors: less than half an 8-bit step near black, where steps are finest.
const SAME_COLOR: f32 = 1.0 / 8192.0;

impl Stream<'_> {
    pub fn of(&self, vertex: u32) -> Vec4 {
        (self.of)(vertex as usize)
    }
}

/// Returns the streams of a mesh that affect the image.
pub(super) fn streams(mesh: &Mesh, read: ReadStreams) -> Vec<Stream<'_>> {
    let mut all: Vec<Stream<'_>> = Vec::new();
    let normal = |i: usize| mesh.normals[i].extend(0.0);
    all.push(Stream { of: Box::new(normal), width: 3, unseen: SAME_DIRECTION, unit: true });
    if read.tangents && !mesh.tangents.is_empty() {
        let of = |i: usize| mesh.tangents[i].truncate().extend(0.0);
        all.push(Stream { of: Box::new(of), width: 3, unseen: SAME_DIRECTION, unit: true });
        // The sign of the bitangent is 1 or −1.
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
