//! Equirectangular maps: longitude along x, latitude along y.
//!
//! The image center shows −z, the default view direction; +x is a quarter of the width to its right; the top row shows
//! +y:
//!
//! ```text
//!  u = ½ + atan2(x, −z) / 2π      0 +z ── ¼ −x ── ½ −z ── ¾ +x ── 1 +z
//!  v = acos(y) / π                0 +y … ½ horizon … 1 −y
//! ```
//!
//! Shaders that sample such a map must use the same mapping.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

/// An equirectangular radiance map in linear Rec.709, alpha 1.
#[derive(Clone, Debug, PartialEq)]
pub struct EquirectMap {
    width: u32,
    height: u32,
    rgba: Vec<[f32; 4]>,
}

/// Returns the unit direction of a point in the image, u and v in 0…1.
#[must_use]
pub fn direction_from_equirect_uv(uv: DVec2) -> DVec3 {
    let (sin_phi, cos_phi) = ((uv.x - 0.5) * TAU).sin_cos();
    let (sin_theta, cos_theta) = (uv.y * PI).sin_cos();
    DVec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta)
}

/// Returns the image point of a unit direction. u is 0.5 at the poles.
#[must_use]
pub fn equirect_uv_from_direction(direction: DVec3) -> DVec2 {
    let around = if direction.x == 0.0 && direction.z == 0.0 { 0.0 } else { direction.x.atan2(-direction.z) };
    DVec2::new(0.5 + around / TAU, direction.y.clamp(-1.0, 1.0).acos() / PI)
}

impl EquirectMap {
    /// Creates a map from `rgba` texels, row 0 at the top.
    ///
    /// # Panics
    ///
    /// If the number of texels is not `width * height`, or is zero.
    #[must_use]
    pub fn new(width: u32, height: u32, rgba: Vec<[f32; 4]>) -> Self {
        assert!(width > 0 && height > 0);
        assert_eq!(rgba.len(), width as usize * height as usize);
        Self { width, height, rgba }
    }

    /// Creates a map from `radiance` in the directions of its texel centers.
    ///
    /// # Panics
    ///
    /// If a side is zero.
    #[must_use]
    pub fn from_fn(width: u32, height: u32, radiance: impl Fn(DVec3) -> DVec3) -> Self {
        let mut rgba = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let uv = texel_center(x, y, width, height);
                let [r, g, b] = radiance(direction_from_equirect_uv(uv)).as_vec3().to_array();
                rgba.push([r, g, b, 1.0]);
            }
        }
        Self::new(width, height, rgba)
    }

    /// Returns the width in texels, at least 1.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in texels, at least 1.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the texels, row 0 at the top.
    #[must_use]
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.rgba
    }

    /// Returns true if all texels are equal bit for bit.
    #[must_use]
    pub fn is_even(&self) -> bool {
        self.rgba.iter().all(|texel| texel.map(f32::to_bits) == self.rgba[0].map(f32::to_bits))
    }

    /// Calls `visit` with the direction, the solid angle in steradian and the radiance of each
    /// texel. The solid angles are exact and sum to 4π.
    pub fn for_each_texel(&self, mut visit: impl FnMut(DVec3, f64, DVec3)) {
        let columns: Vec<(f64, f64)> = (0..self.width)
            .map(|x| (texel_center(x, 0, self.width, self.height).x - 0.5) * TAU)
            .map(f64::sin_cos)
            .collect();
        for y in 0..self.height {
            let edge = |y: u32| (f64::from(y) / f64::from(self.height) * PI).cos();
            let solid_angle = TAU / f64::from(self.width) * (edge(y) - edge(y + 1));
            let v = texel_center(0, y, self.width, self.height).y;
            let (sin_theta, cos_theta) = (v * PI).sin_cos();
            let row = y as usize * self.width as usize;
            for (x, (sin_phi, cos_phi)) in columns.iter().enumerate() {
                let direction = DVec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta);
                let [r, g, b, _] = self.rgba[row + x];
                let radiance = DVec3::new(f64::from(r), f64::from(g), f64::from(b));
                visit(direction, solid_angle, radiance);
            }
        }
    }

    /// Returns the mean radiance over all directions.
    #[must_use]
    pub fn average(&self) -> DVec3 {
        let mut sum = DVec3::ZERO;
        self.for_each_texel(|_, solid_angle, radiance| sum += radiance * solid_angle);
        sum / (2.0 * TAU)
    }

    /// Returns the irradiance on a surface with unit normal `normal`, in the unit of the map times steradian. Sums
    /// every texel: slow, but the reference for spherical harmonics.
    #[must_use]
    pub fn irradiance(&self, normal: DVec3) -> DVec3 {
        let mut sum = DVec3::ZERO;
        self.for_each_texel(|direction, solid_angle, radiance| {
            sum += radiance * (solid_angle * direction.dot(normal).max(0.0));
        });
        sum
    }
}

fn texel_center(x: u32, y: u32, width: u32, height: u32) -> DVec2 {
    DVec2::new((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height))
}
