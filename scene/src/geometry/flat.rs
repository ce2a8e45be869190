//! Flat normals for meshes that bring none (glTF 2.0, section 3.7.2.1).

use glam::Vec3;

use super::weld::split_by_key;
use crate::mesh::Mesh;

/// Gives each triangle the normal of its plane, splitting vertices where planes meet. Triangles
/// without area have no plane and no pixels: they are removed, and their number is returned.
/// Tangents, if any, belonged to other normals and are dropped.
pub(crate) fn make_flat(mesh: &mut Mesh) -> usize {
    let before = mesh.triangle_count();
    let mut indices = Vec::with_capacity(mesh.indices.len());
    let mut normals = Vec::with_capacity(before);
    for triangle in mesh.indices.chunks_exact(3) {
        let corner = |i: usize| mesh.positions[triangle[i] as usize];
        if let Some(normal) = normal_of_triangle([corner(0), corner(1), corner(2)]) {
            indices.extend_from_slice(triangle);
            normals.push(normal);
        }
    }
    let split = split_by_key(&indices, |corner| normals[corner / 3].to_array().map(f32::to_bits));
    mesh.tangents.clear();
    mesh.normals.clear();
    mesh.gather_vertices(&split.source_vertex);
    mesh.normals = split.source_corner.iter().map(|&corner| normals[corner as usize / 3]).collect();
    mesh.indices = split.indices;
    before - mesh.triangle_count()
}

/// The unit normal of a counter-clockwise triangle; `None` without area. Computed in f64 on edges
/// scaled by their largest component, so that neither tiny nor huge triangles lose it. Zeros come
/// out positive, so that equal normals have equal bits.
fn normal_of_triangle(p: [Vec3; 3]) -> Option<Vec3> {
    let [a, b, c] = p.map(|v| v.as_dvec3());
    let (u, v) = (b - a, c - a);
    let size = u.abs().max(v.abs()).max_element();
    if size == 0.0 {
        return None;
    }
    (u / size).cross(v / size).try_normalize().map(|n| n.as_vec3() + Vec3::ZERO)
}
