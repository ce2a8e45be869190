//! Mirror of `wgsl/lib/environment.wgsl`, and the texels of an equirectangular panorama.

use glam::{DVec2, DVec3};

use super::math::PI;

/// Rotates d about the Y axis.
pub fn rotate_about_y(d: DVec3, cos_sin: DVec2) -> DVec3 {
    let DVec2 { x: c, y: s } = cos_sin;
    DVec3::new(c * d.x + s * d.z, d.y, c * d.z - s * d.x)
}

/// Returns the texture coordinates of a unit direction.
pub fn equirect_uv_from_direction(d: DVec3) -> DVec2 {
    let azimuth = if d.x == 0.0 && d.z == 0.0 { 0.0 } else { d.x.atan2(-d.z) };
    DVec2::new(azimuth / (2.0 * PI) + 0.5, d.y.clamp(-1.0, 1.0).acos() / PI)
}

/// Returns the unit direction at texture coordinates.
pub fn direction_from_equirect_uv(uv: DVec2) -> DVec3 {
    let (azimuth, polar) = ((uv.x - 0.5) * 2.0 * PI, uv.y * PI);
    DVec3::new(polar.sin() * azimuth.sin(), polar.cos(), -polar.sin() * azimuth.cos())
}

/// Returns the dominant reflection direction, not normalized: between r and n by alpha².
pub fn specular_dominant_direction(n: DVec3, r: DVec3, alpha: f64) -> DVec3 {
    r + (n - r) * (alpha * alpha)
}

/// Texel of an equirectangular panorama. CPU only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquirectTexel {
    /// Column, starting at 0.
    pub x: u32,
    /// Row, starting at 0 at the top.
    pub y: u32,
    /// Unit vector through the texel's center.
    pub direction: DVec3,
    /// Exact solid angle; all texels together cover 4π.
    pub solid_angle_sr: f64,
}

/// Returns the texels of a `width` × `height` panorama, row by row. CPU only.
pub fn equirect_texels(width: u32, height: u32) -> impl Iterator<Item = EquirectTexel> {
    let edge = move |row: u32| (f64::from(row) / f64::from(height) * PI).cos();
    (0..height).flat_map(move |y| {
        let solid_angle_sr = 2.0 * PI / f64::from(width) * (edge(y) - edge(y + 1));
        (0..width).map(move |x| EquirectTexel {
            x,
            y,
            direction: direction_from_equirect_uv(DVec2::new(
                (f64::from(x) + 0.5) / f64::from(width),
                (f64::from(y) + 0.5) / f64::from(height),
            )),
            solid_angle_sr,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_is_minus_z_and_x_is_right_of_it() {
        for (d, uv) in [(DVec3::NEG_Z, (0.5, 0.5)), (DVec3::X, (0.75, 0.5)), (DVec3::NEG_X, (0.25, 0.5))] {
            assert!((equirect_uv_from_direction(d) - DVec2::from(uv)).length() < 1e-12, "{d}");
        }
        assert_eq!(equirect_uv_from_direction(DVec3::Y).y, 0.0);
        assert_eq!(equirect_uv_from_direction(DVec3::NEG_Y), DVec2::new(0.5, 1.0));
    }

    #[test]
    fn texels_map_to_themselves_and_cover_the_sphere() {
        let (width, height) = (16, 8);
        let mut total = 0.0;
        for texel in equirect_texels(width, height) {
            total += texel.solid_angle_sr;
            let uv = equirect_uv_from_direction(texel.direction);
            let at = uv * DVec2::new(f64::from(width), f64::from(height));
            assert_eq!((at.x as u32, at.y as u32), (texel.x, texel.y));
            assert!((texel.direction.length() - 1.0).abs() < 1e-12);
        }
        assert!((total - 4.0 * PI).abs() < 1e-12);
    }

    #[test]
    fn a_quarter_turn_moves_z_to_x() {
        let turned = rotate_about_y(DVec3::Z, DVec2::new(0.0, 1.0));
        assert!((turned - DVec3::X).length() < 1e-12);
        let d = DVec3::new(0.3, 0.4, -0.5);
        assert_eq!(rotate_about_y(d, DVec2::X), d);
    }

    #[test]
    fn rough_lobes_lean_toward_the_normal_by_alpha_squared() {
        assert_eq!(specular_dominant_direction(DVec3::Y, DVec3::X, 1.0), DVec3::Y);
        assert_eq!(specular_dominant_direction(DVec3::Y, DVec3::X, 0.0), DVec3::X);
        assert_eq!(specular_dominant_direction(DVec3::Y, DVec3::X, 0.5), DVec3::new(0.75, 0.25, 0.0));
    }
}
