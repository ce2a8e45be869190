//! What moves the vertices of a mesh: joints and morph targets.

use glam::Vec3;

/// Skin influences and morph targets of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moves {
    /// Skin influences in sets of four, as glTF stores them (`JOINTS_n`, `WEIGHTS_n`); empty without a skin. Over all sets
    /// the weights of a vertex add up to 1.
    pub influences: Vec<InfluenceSet>,
    /// Morph targets, one for each weight of the node.
    pub targets: Vec<MorphTarget>,
}

/// Four skin influences for each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InfluenceSet {
    /// Places in [`Skin::joints`](crate::motion::Skin::joints).
    pub joints: Vec<[u16; 4]>,
    /// Weight of each joint, 0 to 1.
    pub weights: Vec<[f32; 4]>,
}

impl Moves {
    /// Replaces vertices by copies of `source[i]`, as `Mesh::gather_vertices` does.
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

/// What a morph target adds to each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// In meters; empty for nothing.
    pub positions: Vec<Vec3>,
    /// Empty for nothing.
    pub normals: Vec<Vec3>,
    /// Empty for nothing.
    pub tangents: Vec<Vec3>,
}

/// Copies of `source[i]`, of a stream that there is.
pub(crate) fn gather<T: Copy>(stream: &mut Vec<T>, source: &[u32]) {
    if !stream.is_empty() {
        *stream = source.iter().map(|&s| stream[s as usize]).collect();
    }
}
