//! Diffuse reflection and transmission of a surface, by a grid of directions over the whole sphere.

use glam::DVec3;
use std::f64::consts::PI;

/// A surface of Lambert's law on both sides (KHR_materials_diffuse_transmission), without any specular reflection.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    /// Unit normal toward the viewer.
    pub normal: DVec3,
    /// Albedo of diffuse reflection.
    pub front: DVec3,
    /// Albedo of diffuse transmission.
    pub back: DVec3,
    /// Share of the light that is transmitted, 0…1.
    pub factor: f64,
    /// Share of the transmitted light that the volume does not absorb.
    pub left: DVec3,
}

impl Sheet {
    /// Returns BSDF times cosine for light from the unit vector `to_light`.
    pub fn scattered(&self, to_light: DVec3) -> DVec3 {
        let cosine = self.normal.dot(to_light);
        let albedo = if cosine > 0.0 { self.front * (1.0 - self.factor) } else { self.back * self.left * self.factor };
        albedo * (cosine.abs() / PI)
    }

    /// Returns the radiance toward the viewer under an environment; the grid has `rows` rows of latitude about the y
    /// axis.
    pub fn seen(&self, rows: u32, radiance: impl Fn(DVec3) -> DVec3) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for row in 0..rows {
            let (sin, cos) = ((f64::from(row) + 0.5) / f64::from(rows) * PI).sin_cos();
            for column in 0..2 * rows {
                let (s, c) = ((f64::from(column) + 0.5) / f64::from(rows) * PI).sin_cos();
                let direction = DVec3::new(sin * c, cos, sin * s);
                sum += self.scattered(direction) * radiance(direction) * sin;
            }
        }
        sum * (PI / f64::from(rows)).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A surface that is white on both sides preserves energy, and light from one side is split by the factor.
    #[test]
    fn nothing_is_lost() {
        let normal = DVec3::new(0.36, 0.48, 0.8);
        let sheet = Sheet { normal, front: DVec3::ONE, back: DVec3::ONE, factor: 0.3, left: DVec3::ONE };
        assert!((sheet.seen(128, |_| DVec3::ONE) - DVec3::ONE).abs().max_element() < 1e-3);
        let behind = sheet.seen(128, |d| if normal.dot(d) < 0.0 { DVec3::ONE } else { DVec3::ZERO });
        assert!((behind - DVec3::splat(0.3)).abs().max_element() < 1e-3, "{behind}");
    }
}
