//! Meshes as ranges of shared buffers.

/// Where a mesh lies in the shared buffers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRange {
    /// First index of the mesh in [`GpuScene::indices`].
    pub first_index: u32,
    /// Three a triangle.
    pub index_count: u32,
    /// Added to every index.
    pub base_vertex: i32,
}

impl MeshRange {
    /// The indices to draw.
    #[must_use]
    pub fn indices(&self) -> std::ops::Range<u32> {
        self.first_index..self.first_index + self.index_count
    }
}
