//! Horizontal rectangle.

use glam::{Vec2, Vec3, Vec4};

use crate::bounds::Aabb;
use crate::mesh::Mesh;

/// Returns a rectangle of `size` meters along x and z around the origin, facing up, in `cells` × `cells` quads. The
/// texture repeats `tiles` times along each side; u grows along +x, v along +z.
#[must_use]
pub fn plane(size: Vec2, cells: u32, tiles: Vec2) -> Mesh {
    let cells = cells.max(1);
    let row = cells + 1;
    let mut mesh = Mesh { name: "plane".into(), ..Mesh::default() };
    for j in 0..row {
        for i in 0..row {
            let uv = Vec2::new(i as f32, j as f32) / cells as f32;
            let at = (uv - 0.5) * size;
            mesh.positions.push(Vec3::new(at.x, 0.0, at.y));
            mesh.uv0.push(uv * tiles);
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = j * row + i;
            mesh.indices.extend([a, a + row, a + 1, a + 1, a + row, a + row + 1]);
        }
    }
    mesh.normals = vec![Vec3::Y; mesh.positions.len()];
    mesh.tangents = vec![Vec4::new(1.0, 0.0, 0.0, 1.0); mesh.positions.len()];
    mesh.bounds = Aabb::from_points(&mesh.positions);
    mesh
}
