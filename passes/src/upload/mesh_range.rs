//! Meshes as ranges of shared buffers.

use framegraph_scene::Mesh;

/// The part of the shared buffers that holds a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRange {
    /// Whether its indices have 16 bits: it has 65,536 vertices at most. Others have 32.
    pub short: bool,
    /// Whether its vertices have colors.
    pub colored: bool,
    /// First index of the mesh among those of its kind in [`GpuScene::indices`](super::GpuScene::indices).
    pub first_index: u32,
    /// Number of indices: three a triangle.
    pub index_count: u32,
    /// Number of the mesh's first vertex, added to every index.
    pub base_vertex: i32,
}

impl MeshRange {
    /// The indices to draw.
    #[must_use]
    pub fn indices(&self) -> std::ops::Range<u32> {
        self.first_index..self.first_index + self.index_count
    }
}

/// Where each mesh lies when all are laid one after another: vertices together, indices of 32 bits apart from those of 16.
pub(crate) fn mesh_ranges(meshes: &[Mesh]) -> Vec<MeshRange> {
    let (mut base_vertex, mut first_long, mut first_short) = (0, 0, 0);
    let range = |mesh: &Mesh| {
        // Half the bytes where 16 bits are enough.
        let short = mesh.vertex_count() <= 1 << 16;
        let first = if short { &mut first_short } else { &mut first_long };
        let own = MeshRange {
            short,
            colored: !mesh.colors.is_empty(),
            first_index: *first,
            index_count: mesh.indices.len() as u32,
            base_vertex,
        };
        *first += own.index_count;
        base_vertex += mesh.vertex_count() as i32;
        own
    };
    meshes.iter().map(range).collect()
}
