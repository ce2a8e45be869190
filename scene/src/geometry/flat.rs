//! Normals from triangles: flat ones for meshes without normals (glTF 2.0, section 3.7.2.1), smooth ones to replace
//! invalid normals.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};

use super::weld::split_by_key;
use crate::mesh::Mesh;

/// Gives each triangle its face normal, splitting vertices between planes. Degenerate triangles are removed, and their
/// number is returned. Tangents are dropped, since they belong to other normals.
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

/// Normalizes the normals of a mesh and returns the number of recomputed ones. A normal that is not finite or shorter
/// than 1e-6 is recomputed from adjacent triangles, weighted by area. A vertex whose triangles have no area gets +z.
pub(crate) fn repair_normals(mesh: &mut Mesh) -> usize {
    let unit = |normal: Vec3| {
        let (normal, length) = (normal.as_dvec3(), normal.as_dvec3().length());
        (length.is_finite() && length >= 1e-6).then(|| (normal / length).as_vec3())
    };
    let mut bad = BTreeMap::new();
    for (vertex, normal) in mesh.normals.iter_mut().enumerate() {
        match unit(*normal) {
            Some(unit) => *normal = unit,
            None => _ = bad.insert(vertex, DVec3::ZERO),
        }
    }
    if bad.is_empty() {
        return 0;
    }
    // Areas relative to the mesh size neither vanish nor overflow.
    let size = mesh.bounds.half_extent().max_element().max(f64::MIN_POSITIVE);
    for corners in mesh.triangles() {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner].as_dvec3() / size);
        let area = (b - a).cross(c - a);
        for corner in corners {
            if let Some(sum) = bad.get_mut(&corner) {
                *sum += area;
            }
        }
    }
    for (vertex, sum) in &bad {
        mesh.normals[*vertex] = sum.try_normalize().unwrap_or(DVec3::Z).as_vec3();
    }
    bad.len()
}

/// Returns the unit normal of a counter-clockwise triangle; `None` if its area is zero. Computed in f64 with edges
/// scaled by their largest component, which handles tiny and huge triangles. Zeros are positive, so that equal normals
/// have equal bits.
fn normal_of_triangle(p: [Vec3; 3]) -> Option<Vec3> {
    let [a, b, c] = p.map(|v| v.as_dvec3());
    let (u, v) = (b - a, c - a);
    let size = u.abs().max(v.abs()).max_element();
    if size == 0.0 {
        return None;
    }
    (u / size).cross(v / size).try_normalize().map(|n| n.as_vec3() + Vec3::ZERO)
}
