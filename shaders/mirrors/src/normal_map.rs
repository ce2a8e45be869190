//! Mirror of `wgsl/lib/normal_map.wgsl`.

use glam::DVec3;

use super::numerics::{DEGENERATE_LENGTH2, normalize_or};

/// Returns the tangent-space normal of a texel, not normalized.
pub fn unpack_normal(texel: DVec3, scale: f64) -> DVec3 {
    let n = texel * 2.0 - 1.0;
    DVec3::new(n.x * scale, n.y * scale, n.z)
}

/// Returns a unit vector perpendicular to the unit vector n.
pub fn duff_tangent(n: DVec3) -> DVec3 {
    let s = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (s + n.z);
    DVec3::new(1.0 + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x)
}

/// Normalizes an interpolated normal; returns `geometric` for a zero vector.
pub fn vertex_normal(interpolated: DVec3, geometric: DVec3) -> DVec3 {
    if interpolated.length_squared() < DEGENERATE_LENGTH2 {
        return geometric;
    }
    normalize_or(interpolated, geometric)
}

/// Returns the world-space unit normal of a tangent-space normal.
pub fn apply_normal_map(tangent_space: DVec3, normal: DVec3, tangent: DVec3, handedness: f64) -> DVec3 {
    let (mut t, mut b) = (tangent, normal.cross(tangent));
    if b.length_squared() < DEGENERATE_LENGTH2 {
        t = duff_tangent(normalize_or(normal, DVec3::Z));
        b = normal.cross(t);
    }
    let n = t * tangent_space.x + b * (handedness * tangent_space.y) + normal * tangent_space.z;
    normalize_or(n, normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> impl Iterator<Item = DVec3> {
        (0..100).map(|i| {
            let z = f64::from(i) / 49.5 - 1.0;
            let (s, c) = (f64::from(i) * 2.4).sin_cos();
            let r = (1.0 - z * z).max(0.0).sqrt();
            DVec3::new(r * c, r * s, z)
        })
    }

    #[test]
    fn duff_frames_are_orthonormal() {
        for n in directions().chain([DVec3::Z, DVec3::NEG_Z, DVec3::new(1.0, 0.0, -0.0)]) {
            let t = duff_tangent(n);
            assert!((t.length() - 1.0).abs() < 1e-12 && t.dot(n).abs() < 1e-12, "{n}");
        }
    }

    #[test]
    fn a_flat_map_changes_nothing() {
        let flat = unpack_normal(DVec3::new(0.5, 0.5, 1.0), 1.0);
        for n in directions() {
            let mapped = apply_normal_map(flat, n, duff_tangent(n), 1.0);
            assert!((mapped - n).length() < 1e-12);
        }
    }

    #[test]
    fn red_leans_along_the_tangent_and_green_along_the_bitangent() {
        let (n, t) = (DVec3::Z, DVec3::X);
        let red = apply_normal_map(DVec3::new(0.6, 0.0, 0.8), n, t, 1.0);
        assert!((red - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-12);
        let green = DVec3::new(0.0, 0.6, 0.8);
        assert!((apply_normal_map(green, n, t, 1.0) - green).length() < 1e-12);
        assert!((apply_normal_map(green, n, t, -1.0).y + 0.6).abs() < 1e-12, "mirrored");
    }

    #[test]
    fn degenerate_frames_give_unit_normals() {
        let bump = DVec3::new(0.6, 0.3, 0.7);
        for (normal, tangent) in [
            (DVec3::Z, DVec3::ZERO),
            (DVec3::Z, DVec3::Z),
            (DVec3::NEG_Z, DVec3::NEG_Z),
            (DVec3::X, DVec3::splat(1e-9)),
        ] {
            let n = apply_normal_map(bump, normal, tangent, 1.0);
            assert!((n.length() - 1.0).abs() < 1e-12, "{normal} {tangent}: {n}");
            assert!(n.dot(normal) > 0.0);
        }
        assert_eq!(vertex_normal(DVec3::splat(1e-8), DVec3::Y), DVec3::Y);
        assert_eq!(vertex_normal(DVec3::X * 0.1, DVec3::Y), DVec3::X);
    }
}
