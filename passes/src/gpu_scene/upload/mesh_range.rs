//! Meshes and their levels of detail as ranges of shared buffers.

use framegraph_scene::{Mesh, MeshId, Topology};

/// Range of a mesh in the shared buffers, in one level of detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRange {
    /// True if the indices have 16 bits (at most 65,536 vertices); otherwise they have 32.
    pub short: bool,
    /// True if the vertices have colors.
    pub colored: bool,
    /// Primitive topology.
    pub topology: Topology,
    /// First index of the mesh among 16-bit or 32-bit indices in [`GpuScene::indices`](super::GpuScene::indices).
    pub first_index: u32,
    /// Number of indices.
    pub index_count: u32,
    /// Index of the mesh's first vertex, added to every index.
    pub base_vertex: i32,
}

impl MeshRange {
    /// Returns the range of indices to draw.
    #[must_use]
    pub fn indices(&self) -> std::ops::Range<u32> {
        self.first_index..self.first_index + self.index_count
    }
}

/// Layout of the mesh buffers: vertices, then 32-bit, 16-bit and LOD indices. Levels of detail do not change the
/// ranges of meshes.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshRanges(Vec<Vec<MeshRange>>);

impl MeshRanges {
    pub fn new(meshes: &[Mesh]) -> Self {
        let mut base_vertex = 0;
        let whole = |mesh: &Mesh| {
            // 16-bit indices need half the memory.
            let (short, colored) = (mesh.vertex_count() <= 1 << 16, !mesh.colors.is_empty());
            let own = MeshRange { short, colored, topology: mesh.topology, base_vertex, ..MeshRange::default() };
            base_vertex += mesh.vertex_count() as i32;
            vec![own; 1 + mesh.levels.len()]
        };
        let mut own = Self(meshes.iter().map(whole).collect());
        let mut firsts = [0, 0];
        for (mesh, level, indices) in indices_of(meshes) {
            let range = &mut own.0[mesh][level];
            let first = &mut firsts[usize::from(range.short)];
            (range.first_index, range.index_count) = (*first, indices.len() as u32);
            *first += range.index_count;
        }
        own
    }

    /// Returns the range of a mesh in a level of detail; 0 is the mesh itself. Clamps to the coarsest level.
    ///
    /// # Panics
    /// Panics if the mesh does not exist.
    pub fn of(&self, mesh: MeshId, level: u8) -> MeshRange {
        let own = &self.0[mesh.index()];
        own[usize::from(level).min(own.len() - 1)]
    }
}

/// Returns all indices in buffer order: mesh, level, and indices.
pub(super) fn indices_of(meshes: &[Mesh]) -> impl Iterator<Item = (usize, usize, &[u32])> {
    let whole = meshes.iter().enumerate().map(|(number, mesh)| (number, 0, mesh.indices.as_slice()));
    let levels = meshes.iter().enumerate().flat_map(|(number, mesh)| {
        mesh.all_indices().enumerate().skip(1).map(move |(level, indices)| (number, level, indices))
    });
    whole.chain(levels)
}
