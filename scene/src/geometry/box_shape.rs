//! Box with hard edges.

use glam::{Vec2, Vec3};

use crate::bounds::Aabb;
use crate::mesh::Mesh;

/// Returns a box around the origin with these half edge lengths in meters. Each face shows the texture once, upright on
/// the sides.
#[must_use]
pub fn cuboid(half: Vec3) -> Mesh {
    // The normal of each face and the direction in which u grows on it.
    let faces = [
        (Vec3::X, Vec3::NEG_Z),
        (Vec3::NEG_X, Vec3::Z),
        (Vec3::Y, Vec3::X),
        (Vec3::NEG_Y, Vec3::X),
        (Vec3::Z, Vec3::X),
        (Vec3::NEG_Z, Vec3::NEG_X),
    ];
    let mut mesh = Mesh { name: "box".into(), ..Mesh::default() };
    for (normal, right) in faces {
        let up = normal.cross(right);
        let first = mesh.positions.len() as u32;
        for uv in [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE] {
            let (x, y) = (2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
            mesh.positions.push((normal + right * x + up * y) * half);
            mesh.normals.push(normal);
            mesh.tangents.push(right.extend(1.0));
            mesh.uv0.push(uv);
        }
        mesh.indices.extend([0, 2, 1, 1, 2, 3].map(|corner| first + corner));
    }
    mesh.bounds = Aabb::from_points(&mesh.positions);
    mesh
}
