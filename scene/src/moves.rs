//! Vertex deformation: joints and morph targets.

use glam::Vec3;

/// Skin influences and morph targets of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moves {
    /// Skin influences in sets of four, as in glTF (`JOINTS_n`, `WEIGHTS_n`); empty without a skin. The weights of a
    /// vertex over all sets sum to 1.
    pub influences: Vec<InfluenceSet>,
    /// Morph targets, one per weight of the node.
    pub targets: Vec<MorphTarget>,
}

/// Four skin influences for each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InfluenceSet {
    /// Indices into [`Skin::joints`](crate::motion::Skin::joints).
    pub joints: Vec<[u16; 4]>,
    /// Weight of each joint, 0 to 1.
    pub weights: Vec<[f32; 4]>,
}

impl Moves {
    /// Replaces vertices by copies of `source[i]`, like `Mesh::gather_vertices`.
    pub(crate) fn gather_vertices(&mut self, source: &[u32]) {
        for set in &mut self.influences {
            gather(&mut set.joints, source);
            gather(&mut set.weights, source);
        }
        for target in &mut self.targets {
            gather(&mut target.positions, source);
            gather(&mut target.normals, source);
            gather(&mut target.tangents, source);
        }
    }
}

/// Displacements of a morph target, one per vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// Displacements of positions in meters; empty for none.
    pub positions: Vec<Vec3>,
    /// Changes of normals; empty for none.
    pub normals: Vec<Vec3>,
    /// Changes of tangents; empty for none.
    pub tangents: Vec<Vec3>,
}

/// Replaces a stream by copies of `source[i]`, unless it is empty.
pub(crate) fn gather<T: Copy>(stream: &mut Vec<T>, source: &[u32]) {
    if !stream.is_empty() {
        *stream = source.iter().map(|&s| stream[s as usize]).collect();
    }
}
