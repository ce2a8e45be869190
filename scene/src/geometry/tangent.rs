//! MikkTSpace tangents, against which normal maps are baked (glTF 2.0, section 3.7.2.1: "tangents SHOULD be calculated
//! using default MikkTSpace algorithms").

use glam::{Vec2, Vec3, Vec4};

use super::frame::tangent_of_normal;
use super::weld::split_by_key;
use crate::mesh::Mesh;

/// Computes tangents from texture coordinates of `uv_set`, splitting vertices where the two sides of a seam differ. A
/// mesh without that set, or without triangles, gets tangents from its normals.
pub(crate) fn generate_tangents(mesh: &mut Mesh, uv_set: u32) {
    let mut faces = Faces { mesh, uv: mesh.uv(uv_set), corners: vec![Vec4::ZERO; mesh.indices.len()] };
    if !faces.uv.is_empty() {
        // If generation fails, tangents stay zero and the repair below replaces them.
        mikktspace::generate_tangents(&mut faces);
    }
    let corners = faces.corners;
    let split = split_by_key(&mesh.indices, |corner| corners[corner].to_array().map(f32::to_bits));
    mesh.tangents.clear();
    mesh.gather_vertices(&split.source_vertex);
    mesh.tangents = split.source_corner.iter().map(|&corner| corners[corner as usize]).collect();
    mesh.indices = split.indices;
    repair_tangents(mesh);
}

/// Makes every tangent a unit vector perpendicular to its normal, with w = ±1. Tangents that are not finite, zero or
/// parallel to the normal (collapsed texture coordinates) are replaced by a perpendicular vector; their number is
/// returned.
pub(crate) fn repair_tangents(mesh: &mut Mesh) -> usize {
    let mut replaced = 0;
    for (tangent, &normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
        let w = if tangent.w < 0.0 { -1.0 } else { 1.0 };
        let along = tangent.truncate();
        // Within a thousandth of a radian of the normal, the direction is rounding noise.
        let across = along - normal * along.dot(normal);
        let usable = across.is_finite() && across.length_squared() > 1e-6 * along.length_squared().max(1e-12);
        let direction = if usable {
            across.normalize()
        } else {
            replaced += 1;
            tangent_of_normal(normal)
        };
        *tangent = direction.extend(w);
    }
    replaced
}

/// Mesh as seen by the generator: faces of three corners.
struct Faces<'a> {
    mesh: &'a Mesh,
    uv: &'a [Vec2],
    corners: Vec<Vec4>,
}

impl Faces<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.indices[face * 3 + corner] as usize
    }
}

impl mikktspace::Geometry for Faces<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangle_count()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.uv[self.vertex(face, corner)].to_array()
    }

    fn set_tangent_encoded(&mut self, tangent: [f32; 4], face: usize, corner: usize) {
        // The generator measures v upward, glTF downward; the bitangent and thus w change sign.
        let [x, y, z, w] = tangent;
        self.corners[face * 3 + corner] = Vec3::new(x, y, z).extend(-w);
    }
}
