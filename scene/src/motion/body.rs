//! Meshes whose vertices follow joints and morph targets.

use crate::mesh::{Mesh, MeshId};
use crate::moves::{MorphTarget, Moves};
use glam::{DMat3, DMat4, DVec3, Vec3, Vec4};

/// Joints that vertices follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Nodes.
    pub joints: Vec<usize>,
    /// For each joint, from the mesh's axes to the joint's, when the mesh is as it was modelled.
    pub joint_from_mesh: Vec<DMat4>,
}

/// A mesh whose vertices move. One instance draws it.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// What is drawn; its vertices are those of the last pose.
    pub mesh: MeshId,
    /// The instance that draws it, by its number.
    pub instance: usize,
    /// The node that it hangs on, whose weights its targets have.
    pub node: usize,
    /// What its vertices follow.
    pub skin: Option<usize>,
    /// The vertices as they were modelled: positions, normals, and tangents if it has any.
    pub rest: Shape,
    /// What moves them.
    pub moves: Moves,
}

/// Streams that move.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// In meters.
    pub positions: Vec<Vec3>,
    /// Of unit length.
    pub normals: Vec<Vec3>,
    /// Of unit length; w is the side of the bitangent. May be empty.
    pub tangents: Vec<Vec4>,
}

impl Body {
    /// Moves the vertices of `mesh`: morph targets by `weights` first, then each vertex with its joints, whose matrices are
    /// given from the mesh as it was modelled to the axes that it is drawn in.
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
            // Lines and points may have no normals.
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
            // What collapses keeps the direction that it had.
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

/// What turns normals where `linear` moves positions; the inverse's transpose times the determinant, which a singular matrix has
/// too.
fn cofactor(linear: DMat3) -> DMat3 {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}
