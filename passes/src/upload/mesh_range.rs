//! Meshes as ranges of shared buffers.

/// The part of the shared buffers that holds a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRange {
    /// Whether its indices have 16 bits: it has 65,536 vertices at most. Others have 32.
    pub short: bool,
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
