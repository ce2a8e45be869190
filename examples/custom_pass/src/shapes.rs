//! Shapes as triangle lists: a cube, an octahedron, a torus.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Vertex of a triangle.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Position in object space, about one unit from the center.
    pub position: [f32; 3],
    /// Outward normal of length 1.
    pub normal: [f32; 3],
}

fn vertex(position: Vec3, normal: Vec3) -> Vertex {
    Vertex { position: position.to_array(), normal: normal.to_array() }
}

/// Returns a flat triangle, counter-clockwise from outside.
fn triangle(corners: [Vec3; 3]) -> [Vertex; 3] {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
    corners.map(|corner| vertex(corner, normal))
}

/// Returns a cube with edges of 1.2 units.
pub fn cube() -> Vec<Vertex> {
    let mut vertices = Vec::new();
    for (axis, sign) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        let out = axis * sign;
        // Two directions along the face that form a right-handed frame with its normal.
        let (u, v) = (out.any_orthonormal_vector(), out.cross(out.any_orthonormal_vector()));
        let corner = |a: f32, b: f32| (out + u * a + v * b) * 0.6;
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        vertices.extend([triangle([a, b, c]), triangle([a, c, d])].concat());
    }
    vertices
}

/// Returns an octahedron with its corners one unit from the center.
pub fn octahedron() -> Vec<Vertex> {
    let mut vertices = Vec::new();
    for octant in 0..8u32 {
        let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let (x, y, z) = (Vec3::X * sign(0), Vec3::Y * sign(1), Vec3::Z * sign(2));
        // An odd number of mirrored axes reverses the winding.
        let mirrored = octant.count_ones() % 2 == 1;
        vertices.extend(triangle(if mirrored { [x, z, y] } else { [x, y, z] }));
    }
    vertices
}

/// Returns a torus around the Y axis with radius 0.9 and tube radius 0.35.
pub fn torus() -> Vec<Vertex> {
    const AROUND: u32 = 48;
    const ACROSS: u32 = 24;
    let at = |i: u32, j: u32| {
        let full = std::f32::consts::TAU;
        let (u, v) = (full * i as f32 / AROUND as f32, full * j as f32 / ACROSS as f32);
        let outward = Vec3::new(u.cos(), 0.0, u.sin());
        let normal = outward * v.cos() + Vec3::Y * v.sin();
        vertex(outward * 0.9 + normal * 0.35, normal)
    };
    let quads = (0..AROUND).flat_map(|i| (0..ACROSS).map(move |j| (i, j)));
    let corners = quads.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        [a, b, c, a, c, d]
    });
    corners.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_face_outward_and_normals_have_length_one() {
        for (shape, triangles) in [(cube(), 12), (octahedron(), 8), (torus(), 48 * 24 * 2)] {
            assert_eq!(shape.len(), triangles * 3);
            for corners in shape.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|i| Vec3::from(corners[i].position));
                let face = (b - a).cross(c - a);
                for corner in corners {
                    let normal = Vec3::from(corner.normal);
                    assert!((normal.length() - 1.0).abs() < 1e-6 && face.dot(normal) > 0.0, "{corners:?}");
                }
            }
        }
    }
}
