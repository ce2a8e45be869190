//! Surfaces of revolution around the y axis: spheres, cylinders, tori, columns.
//!
//! A profile is a polyline in the half plane (radius, y), listed in the direction of increasing v. With the radius
//! pointing right, the outside of the surface is to its left. The position at u is (r sin φ, y, r cos φ) with φ = 2πu;
//! for a viewer outside, u grows to the right.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};

use crate::bounds::Aabb;
use crate::mesh::Mesh;

/// Point of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    /// (radius ≥ 0, y) in meters.
    pub at: Vec2,
    /// Unit normal as (along the radius, along y).
    pub normal: Vec2,
    /// Second texture coordinate; the first runs around the axis.
    pub v: f32,
}

/// Sweeps each of `profiles` around the y axis in `segments` steps (at least 3). Profiles are not connected to each
/// other, which makes hard edges. A point of radius 0 makes a fan, so no triangle is degenerate if consecutive points
/// differ.
#[must_use]
pub fn profile_of_revolution(profiles: &[&[ProfilePoint]], segments: u32) -> Mesh {
    let segments = segments.max(3);
    let mut mesh = Mesh::default();
    for profile in profiles {
        sweep(&mut mesh, profile, segments);
    }
    mesh.bounds = Aabb::from_points(&mesh.positions);
    mesh
}

fn sweep(mesh: &mut Mesh, profile: &[ProfilePoint], segments: u32) {
    let first = mesh.positions.len() as u32;
    let columns = segments + 1;
    for point in profile {
        let pole = point.at.x == 0.0;
        for column in 0..columns {
            // A pole has no angle: each of its triangles uses the angle of its own middle.
            let shift = if pole { 0.5 } else { 0.0 };
            let u = (column as f32 + shift) / segments as f32;
            // The two columns of the seam must be equal bit for bit, which sin(2π) would not be.
            let turn = if column == segments { shift / segments as f32 } else { u };
            let (sin, cos) = (turn * TAU).sin_cos();
            let (r, y) = (point.at.x, point.at.y);
            let (nr, ny) = (point.normal.x, point.normal.y);
            mesh.positions.push(Vec3::new(r * sin, y, r * cos));
            mesh.normals.push(Vec3::new(nr * sin, ny, nr * cos).normalize());
            mesh.tangents.push(Vec3::new(cos, 0.0, -sin).extend(1.0));
            mesh.uv0.push(Vec2::new(u, point.v));
        }
    }
    for (row, pair) in profile.windows(2).enumerate() {
        let upper = first + row as u32 * columns;
        for column in 0..segments {
            let (a, c) = (upper + column, upper + columns + column);
            if pair[0].at.x > 0.0 && pair[1].at.x > 0.0 {
                mesh.indices.extend([a, c, a + 1, a + 1, c, c + 1]);
            } else if pair[1].at.x > 0.0 {
                mesh.indices.extend([a, c, c + 1]);
            } else if pair[0].at.x > 0.0 {
                mesh.indices.extend([a, c, a + 1]);
            }
        }
    }
}

/// Returns a sphere around the origin, in meters: `segments` around (at least 3) and `rings` from pole to pole (at
/// least 2).
#[must_use]
pub fn sphere(radius: f32, segments: u32, rings: u32) -> Mesh {
    let rings = rings.max(2);
    let profile: Vec<ProfilePoint> = (0..=rings)
        .map(|ring| {
            let v = ring as f32 / rings as f32;
            let (sin, cos) = (v * PI).sin_cos();
            // Exact poles: sin(π) in f32 is not zero.
            let sin = if ring == 0 || ring == rings { 0.0 } else { sin };
            let normal = Vec2::new(sin, cos);
            ProfilePoint { at: normal * radius, normal, v }
        })
        .collect();
    let mut mesh = profile_of_revolution(&[&profile], segments);
    mesh.name = "sphere".into();
    mesh
}

/// Returns an upright cylinder around the origin with flat caps, in meters.
#[must_use]
pub fn cylinder(radius: f32, half_height: f32, segments: u32) -> Mesh {
    let point = |r: f32, y: f32, normal: Vec2, v: f32| ProfilePoint { at: Vec2::new(r, y), normal, v };
    let (h, r) = (half_height, radius);
    let top = [point(0.0, h, Vec2::Y, 0.0), point(r, h, Vec2::Y, 1.0)];
    let side = [point(r, h, Vec2::X, 0.0), point(r, -h, Vec2::X, 1.0)];
    let bottom = [point(r, -h, Vec2::NEG_Y, 0.0), point(0.0, -h, Vec2::NEG_Y, 1.0)];
    let mut mesh = profile_of_revolution(&[&top, &side, &bottom], segments);
    mesh.name = "cylinder".into();
    mesh
}

/// Returns a torus around the y axis: `major` meters from the axis to the center of the tube, whose radius is `minor`
/// (below `major`).
#[must_use]
pub fn torus(major: f32, minor: f32, segments: u32, rings: u32) -> Mesh {
    let rings = rings.max(3);
    let profile: Vec<ProfilePoint> = (0..=rings)
        .map(|ring| {
            let v = ring as f32 / rings as f32;
            let turn = if ring == rings { 0.0 } else { v };
            let angle = FRAC_PI_2 - turn * TAU;
            let normal = Vec2::new(angle.cos(), angle.sin());
            ProfilePoint { at: Vec2::new(major, 0.0) + normal * minor, normal, v }
        })
        .collect();
    let mut mesh = profile_of_revolution(&[&profile], segments);
    mesh.name = "torus".into();
    mesh
}
