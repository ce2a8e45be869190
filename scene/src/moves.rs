//! What moves the vertices of a mesh: joints and morph targets.

use glam::Vec3;

/// What moves the vertices of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moves {
    /// The joints of each vertex, places in [`Skin::joints`](crate::motion::Skin::joints); none without a skin.
    pub joints: Vec<[u16; 4]>,
    /// How much it follows each; their sum is 1.
    pub weights: Vec<[f32; 4]>,
    /// What is added by each weight of the node.
    pub targets: Vec<MorphTarget>,
}

impl Moves {
    /// Replaces vertices by copies of `source[i]`, as `Mesh::gather_vertices` does.
    pub(crate) fn gather_vertices(&mut self, source: &[u32]) {
        gather(&mut self.joints, source);
        gather(&mut self.weights, source);
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
