//! Shapes compared with closed forms, and geometry algorithms on difficult input.

use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3, Vec4};

use super::*;
use crate::bounds::Aabb;
use crate::mesh::Mesh;

/// Returns the signed volume of a closed mesh, by the divergence theorem.
fn volume(mesh: &Mesh) -> f64 {
    mesh.triangles()
        .map(|[a, b, c]| {
            let p = |i: usize| mesh.positions[i].as_dvec3();
            p(a).dot(p(b).cross(p(c))) / 6.0
        })
        .sum()
}

/// Returns the derivatives of position along u and v over a triangle.
fn gradients(mesh: &Mesh, [a, b, c]: [usize; 3]) -> (DVec3, DVec3) {
    let p = |i: usize| mesh.positions[i].as_dvec3();
    let t = |i: usize| mesh.uv0[i].as_dvec2();
    let (e1, e2) = (p(b) - p(a), p(c) - p(a));
    let (d1, d2) = (t(b) - t(a), t(c) - t(a));
    let det = d1.perp_dot(d2);
    ((e1 * d2.y - e2 * d1.y) / det, (e2 * d1.x - e1 * d2.x) / det)
}

/// Checks the guarantees of [`Mesh`]. Triangles have area, normals are on their front side, tangents follow increasing
/// u, and bitangents decreasing v.
fn assert_sound(mesh: &Mesh) {
    assert_eq!(mesh.check(), Ok(()), "{}", mesh.name);
    assert!(mesh.triangle_count() > 0);
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|i| mesh.positions[i].as_dvec3());
        let face = (b - a).cross(c - a);
        assert!(face.length() > 1e-9, "{} {triangle:?}", mesh.name);
        let (along_u, along_v) = gradients(mesh, triangle);
        for i in triangle {
            let normal = mesh.normals[i].as_dvec3();
            assert!(normal.dot(face) > 0.0, "{} normal {i}", mesh.name);
            let tangent = mesh.tangents[i].truncate().as_dvec3();
            assert!(tangent.dot(normal).abs() < 1e-5, "{} {i}", mesh.name);
            assert!(tangent.dot(along_u) > 0.0, "{} tangent {i}", mesh.name);
            let bitangent = normal.cross(tangent) * f64::from(mesh.tangents[i].w);
            assert!(bitangent.dot(along_v) < 0.0, "{} bitangent {i}", mesh.name);
        }
    }
    let corners = mesh.positions.iter().map(|p| p.as_dvec3());
    for corner in corners {
        assert!(corner.cmpge(mesh.bounds.min).all() && corner.cmple(mesh.bounds.max).all());
    }
}

#[test]
fn shapes_are_sound() {
    for mesh in [
        plane(Vec2::new(3.0, 2.0), 4, Vec2::splat(2.0)),
        cuboid(Vec3::new(1.0, 2.0, 0.5)),
        sphere(1.5, 24, 12),
        sphere(1.0, 3, 2),
        cylinder(0.5, 2.0, 16),
        torus(1.0, 0.25, 24, 12),
    ] {
        assert_sound(&mesh);
    }
}

/// The volume of a polyhedron inscribed in a smooth body converges with the square of the step; the bounds are that
/// second-order error.
#[test]
fn closed_shapes_enclose_their_volume() {
    let near = |mesh: &Mesh, exact: f64, relative: f64| {
        let got = volume(mesh);
        assert!((got / exact - 1.0).abs() < relative, "{}: {got} for {exact}", mesh.name);
    };
    near(&cuboid(Vec3::new(1.0, 2.0, 0.5)), 8.0, 1e-6);
    near(&sphere(1.5, 128, 64), 4.0 / 3.0 * PI * 1.5_f64.powi(3), 2e-3);
    near(&cylinder(0.5, 2.0, 128), PI * 0.25 * 4.0, 1e-3);
    near(&torus(1.0, 0.25, 128, 64), 2.0 * PI * PI * 0.0625, 5e-3);
}

fn folded_quad() -> Mesh {
    // Two triangles that share an edge, at right angles.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.0, 0.0, -1.0)];
    Mesh {
        bounds: Aabb::from_points(&positions),
        normals: Vec::new(),
        uv0: vec![Vec2::Y, Vec2::ONE, Vec2::ZERO, Vec2::X],
        positions,
        indices: vec![0, 1, 2, 0, 2, 3, 0, 0, 1],
        ..Mesh::default()
    }
}

#[test]
fn flat_normals_split_edges_and_drop_triangles_without_area() {
    let mut mesh = folded_quad();
    assert_eq!(make_flat(&mut mesh), 1);
    assert_eq!(mesh.check(), Ok(()));
    assert_eq!(mesh.triangle_count(), 2);
    assert_eq!(mesh.vertex_count(), 6, "the shared edge must be split");
    assert_eq!(mesh.normals[..3], [Vec3::Z; 3]);
    assert_eq!(mesh.normals[3..], [Vec3::NEG_X; 3]);
}

#[test]
fn flat_normals_survive_tiny_and_huge_triangles() {
    for scale in [1e-30_f32, 1e30] {
        let mut mesh = folded_quad();
        for p in &mut mesh.positions {
            *p *= scale;
        }
        assert_eq!(make_flat(&mut mesh), 1);
        assert_eq!(mesh.normals[0], Vec3::Z);
    }
}

/// Generated tangents equal the analytic ones of a sphere within a few degrees, since the generator averages flat
/// triangles. Their handedness is glTF's: v points down.
#[test]
fn generated_tangents_agree_with_analytic_ones() {
    let exact = sphere(1.0, 64, 32);
    let mut mesh = exact.clone();
    mesh.tangents.clear();
    generate_tangents(&mut mesh, 0);
    assert_eq!(mesh.check(), Ok(()));
    let mut compared = 0;
    for (i, tangent) in mesh.tangents.iter().enumerate() {
        let normal = mesh.normals[i];
        if normal.y.abs() > 0.95 {
            continue;
        }
        let expected = Vec3::new(normal.z, 0.0, -normal.x).normalize();
        assert!(tangent.truncate().dot(expected) > 0.995, "vertex {i}");
        assert_eq!(tangent.w, 1.0, "vertex {i}");
        compared += 1;
    }
    assert!(compared > 1000);
    // Mirrored coordinates flip both the tangent and the handedness.
    let mut mirrored = exact;
    for uv in &mut mirrored.uv0 {
        uv.x = 1.0 - uv.x;
    }
    generate_tangents(&mut mirrored, 0);
    let i = mirrored.normals.iter().position(|n| n.z > 0.99).expect("a sphere has a vertex towards +z");
    assert!(mirrored.tangents[i].x < -0.9);
    assert_eq!(mirrored.tangents[i].w, -1.0);
}

/// Tangents have unit length even with collapsed texture coordinates, no coordinates, or no triangles.
#[test]
fn tangents_exist_without_usable_coordinates() {
    for uv in [Vec::new(), vec![Vec2::splat(0.5); 6]] {
        let mut mesh = folded_quad();
        mesh.uv0.clear();
        make_flat(&mut mesh);
        mesh.uv0 = uv;
        generate_tangents(&mut mesh, 0);
        assert_eq!(mesh.check(), Ok(()));
        assert_eq!(mesh.tangents.len(), mesh.vertex_count());
    }
    let mut nothing = Mesh::default();
    generate_tangents(&mut nothing, 0);
    assert_eq!(nothing.check(), Ok(()));
}

#[test]
fn repair_replaces_only_what_cannot_be_used() {
    let mut mesh = folded_quad();
    make_flat(&mut mesh);
    mesh.tangents = vec![
        Vec4::new(2.0, 0.0, 0.0, 1.0),
        Vec4::ZERO,
        Vec4::new(0.0, 0.0, 1.0, -1.0),
        Vec4::new(0.0, 1.0, 1.0, -0.5),
        Vec4::new(0.0, 1.0, 0.0, 1.0),
        Vec4::new(0.0, 1.0, 0.0, 1.0),
    ];
    assert_eq!(repair_tangents(&mut mesh), 2);
    assert_eq!(mesh.check(), Ok(()));
    assert_eq!(mesh.tangents[0], Vec4::new(1.0, 0.0, 0.0, 1.0));
    assert_eq!(mesh.tangents[3].w, -1.0);
}
