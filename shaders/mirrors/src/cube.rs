//! Mirror of `wgsl/lib/cube.wgsl`, and the texels of a cube map.

use glam::{DVec2, DVec3};

/// Returns the direction through uv of a face, with a largest component of ±1.
pub fn direction_from_cube_uv(face: u32, uv: DVec2) -> DVec3 {
    let DVec2 { x: s, y: t } = uv * 2.0 - 1.0;
    match face {
        0 => DVec3::new(1.0, -t, -s),
        1 => DVec3::new(-1.0, -t, s),
        2 => DVec3::new(s, 1.0, t),
        3 => DVec3::new(s, -1.0, -t),
        4 => DVec3::new(s, -t, 1.0),
        _ => DVec3::new(-s, -t, -1.0),
    }
}

/// Returns the solid angle per uv area, relative to the center of the face.
pub fn cube_solid_angle_weight(uv: DVec2) -> f64 {
    (1.0 + (uv * 2.0 - 1.0).length_squared()).powf(-1.5)
}

#[cfg(test)]
mod tests {
    use super::super::math::PI;
    use super::*;

    /// Returns the face and uv of a direction of any length: the inverse of [`direction_from_cube_uv`].
    fn cube_uv_from_direction(d: DVec3) -> (u32, DVec2) {
        let a = d.abs();
        let (face, s, t, major) = if a.x >= a.y && a.x >= a.z {
            if d.x > 0.0 { (0, -d.z, -d.y, a.x) } else { (1, d.z, -d.y, a.x) }
        } else if a.y >= a.z {
            if d.y > 0.0 { (2, d.x, d.z, a.y) } else { (3, d.x, -d.z, a.y) }
        } else if d.z > 0.0 {
            (4, d.x, -d.y, a.z)
        } else {
            (5, -d.x, -d.y, a.z)
        };
        (face, (DVec2::new(s, t) / major + 1.0) * 0.5)
    }

    /// Returns the exact solid angle, in sr, of texel (x, y) of a face of `size`² texels.
    fn cube_texel_solid_angle_sr(x: u32, y: u32, size: u32) -> f64 {
        // Solid angle of the rectangle from the center of the face to a corner.
        let corner = |x: u32, y: u32| {
            let [s, t] = [x, y].map(|i| 2.0 * f64::from(i) / f64::from(size) - 1.0);
            (s * t).atan2((s * s + t * t + 1.0).sqrt())
        };
        corner(x, y) - corner(x + 1, y) - corner(x, y + 1) + corner(x + 1, y + 1)
    }

    #[test]
    fn faces_look_where_they_are_named_and_come_back() {
        let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        for (face, axis) in (0..).zip(axes) {
            assert_eq!(direction_from_cube_uv(face, DVec2::splat(0.5)), axis);
            for uv in [DVec2::new(0.1, 0.7), DVec2::new(0.9, 0.2)] {
                let (back, at) = cube_uv_from_direction(direction_from_cube_uv(face, uv) * 3.0);
                assert!(back == face && (at - uv).length() < 1e-12, "{face} {uv}");
            }
        }
    }

    #[test]
    fn right_and_down_on_a_face_follow_the_specification() {
        // On +Z, the image's right is +X and down is -Y; on +Y, down is +Z.
        assert!(direction_from_cube_uv(4, DVec2::new(1.0, 0.5)).x > 0.0);
        assert!(direction_from_cube_uv(4, DVec2::new(0.5, 1.0)).y < 0.0);
        assert!(direction_from_cube_uv(2, DVec2::new(0.5, 1.0)).z > 0.0);
    }

    #[test]
    fn texels_cover_the_sphere_and_weights_follow_their_solid_angles() {
        let size = 64;
        let mut whole = 0.0;
        let middle = cube_texel_solid_angle_sr(32, 32, size);
        for y in 0..size {
            for x in 0..size {
                let exact = cube_texel_solid_angle_sr(x, y, size);
                whole += 6.0 * exact;
                let uv = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / f64::from(size);
                let ratio = cube_solid_angle_weight(uv) / (exact / middle);
                // Approximation by the texel center; the error is largest in the corners.
                assert!((ratio - 1.0).abs() < 2e-3, "{x} {y}: {ratio}");
            }
        }
        assert!((whole - 4.0 * PI).abs() < 1e-9, "{whole}");
        let corner = cube_solid_angle_weight(DVec2::ZERO);
        assert!((corner - 3.0_f64.powf(-1.5)).abs() < 1e-12);
    }
}
