//! Meshes and their levels of detail as ranges of shared buffers.

use framegraph_scene::{Mesh, MeshId, Topology};

/// The part of the shared buffers that holds a mesh in one level of detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRange {
    /// Whether its indices have 16 bits: it has 65,536 vertices at most. Others have 32.
    pub short: bool,
    /// Whether its vertices have colors.
    pub colored: bool,
    /// Primitives that its indices make up.
    pub topology: Topology,
    /// First index of the mesh among those of its kind in [`GpuScene::indices`](super::GpuScene::indices).
    pub first_index: u32,
    /// Number of indices.
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

/// Where meshes lie when all are laid one after another: vertices together, indices of 32 bits apart from those of 16, those of levels
/// behind those of all meshes, so that it does not depend on levels where meshes lie.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshRanges(Vec<Vec<MeshRange>>);

impl MeshRanges {
    pub fn new(meshes: &[Mesh]) -> Self {
        let mut base_vertex = 0;
        let whole = |mesh: &Mesh| {
            // Half the bytes where 16 bits are enough.
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

    /// A mesh in a level, 0 for the mesh itself; in the coarsest where it has fewer.
    ///
    /// # Panics
    /// Where there is no such mesh.
    pub fn of(&self, mesh: MeshId, level: u8) -> MeshRange {
        let own = &self.0[mesh.index()];
        own[usize::from(level).min(own.len() - 1)]
    }
}

/// All indices in the order in which they lie: mesh, level, and indices.
pub(super) fn indices_of(meshes: &[Mesh]) -> impl Iterator<Item = (usize, usize, &[u32])> {
    let whole = meshes.iter().enumerate().map(|(number, mesh)| (number, 0, mesh.indices.as_slice()));
    let levels = meshes.iter().enumerate().flat_map(|(number, mesh)| {
        mesh.all_indices().enumerate().skip(1).map(move |(level, indices)| (number, level, indices))
    });
    whole.chain(levels)
}
