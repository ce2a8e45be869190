//! Deformable meshes: vertices follow joints and morph targets.

use crate::mesh::{Mesh, MeshId};
use crate::moves::{MorphTarget, Moves};
use glam::{DMat3, DMat4, DVec3, Vec3, Vec4};

/// Skin: joints that deform vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Node of each joint.
    pub joints: Vec<usize>,
    /// Inverse bind matrix of each joint: from the mesh's axes to the joint's in the bind pose.
    pub joint_from_mesh: Vec<DMat4>,
}

/// Deformable mesh, drawn by a single instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Drawn mesh; its vertices are those of the last pose.
    pub mesh: MeshId,
    /// Number of the instance that draws it.
    pub instance: usize,
    /// Node to which it is attached, and whose weights its morph targets use.
    pub node: usize,
    /// Index of its skin, if any.
    pub skin: Option<usize>,
    /// Undeformed vertices: positions, normals, and tangents if it has any.
    pub rest: Shape,
    /// Skin influences and morph targets.
    pub moves: Moves,
}

/// Deformable vertex streams.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Positions in meters.
    pub positions: Vec<Vec3>,
    /// Unit normals; may be empty for lines and points.
    pub normals: Vec<Vec3>,
    /// Unit tangents; w is the sign of the bitangent. May be empty.
    pub tangents: Vec<Vec4>,
}

impl Body {
    /// Deforms the vertices of `mesh`: first with morph targets by `weights`, then with joints. Each matrix in `joints`
    /// maps the undeformed mesh to the axes in which it is drawn.
    pub(super) fn deform(&self, weights: &[f64], joints: &[DMat4], mesh: &mut Mesh) {
        for vertex in 0..self.rest.positions.len() {
            let sum = |rest: DVec3, of: fn(&MorphTarget) -> &Vec<Vec3>| {
                let moved = self
                    .moves
                    .targets
                    .iter()
                    .zip(weights)
                    .filter_map(|(target, weight)| of(target).get(vertex).map(|way| *weight * way.as_dvec3()));
                rest + moved.sum::<DVec3>()
            };
            let mut position = sum(self.rest.positions[vertex].as_dvec3(), |target| &target.positions);
            // Lines and points may lack normals.
            let rest_normal = self.rest.normals.get(vertex).copied();
            let mut normal = sum(rest_normal.unwrap_or_default().as_dvec3(), |target| &target.normals);
            let side = self.rest.tangents.get(vertex).map(|tangent| tangent.w);
            let rest = self.rest.tangents.get(vertex).map_or(DVec3::ZERO, |tangent| tangent.truncate().as_dvec3());
            let mut tangent = sum(rest, |target| &target.tangents);
            if !self.moves.influences.is_empty() {
                let sets = self.moves.influences.iter();
                let pairs = sets.flat_map(|set| set.joints[vertex].iter().zip(&set.weights[vertex]));
                let matrix = pairs
                    .fold(DMat4::ZERO, |sum, (joint, weight)| sum + joints[usize::from(*joint)] * f64::from(*weight));
                position = matrix.transform_point3(position);
                let linear = DMat3::from_mat4(matrix);
                normal = cofactor(linear) * normal;
                tangent = linear * tangent;
            }
            mesh.positions[vertex] = position.as_vec3();
            // A collapsed vector keeps its undeformed direction.
            if let Some(rest) = rest_normal {
                mesh.normals[vertex] = normal.try_normalize().map_or(rest, DVec3::as_vec3);
            }
            if let Some(side) = side {
                let along = tangent.try_normalize().map_or(self.rest.tangents[vertex].truncate(), DVec3::as_vec3);
                mesh.tangents[vertex] = along.extend(side);
            }
        }
    }
}

/// Returns the matrix that transforms normals if `linear` transforms positions: the inverse transpose times the
/// determinant, which exists for singular matrices too.
fn cofactor(linear: DMat3) -> DMat3 {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}
