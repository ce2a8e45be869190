//! Directions and panoramas, implemented independently of the project's own conversions.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Returns `count` unit vectors spread uniformly over the sphere (a Fibonacci lattice).
pub fn directions(count: u32) -> Vec<DVec3> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let direction = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (sin, cos) = (golden * f64::from(i)).sin_cos();
        let ring = (1.0 - z * z).sqrt();
        DVec3::new(ring * cos, ring * sin, z)
    };
    (0..count).map(direction).collect()
}

/// Returns irradiance over π on a surface facing `normal`, by a grid of `rows`² directions. The grid is uniform in the
/// squared cosine, so that each direction has the same weight.
pub fn irradiance_over_pi(normal: DVec3, rows: u32, radiance: impl Fn(DVec3) -> f64) -> f64 {
    let (t, b) = frame(normal);
    let mut sum = 0.0;
    for row in 0..rows {
        let sin2 = (f64::from(row) + 0.5) / f64::from(rows);
        let (sin, cos) = (sin2.sqrt(), (1.0 - sin2).sqrt());
        for column in 0..2 * rows {
            let (s, c) = ((f64::from(column) + 0.5) / f64::from(2 * rows) * TAU).sin_cos();
            sum += radiance(t * (sin * c) + b * (sin * s) + normal * cos);
        }
    }
    sum / f64::from(2 * rows * rows)
}

/// Returns two unit vectors that are perpendicular to n and to each other.
pub fn frame(n: DVec3) -> (DVec3, DVec3) {
    let other = if n.x.abs() < 0.6 { DVec3::X } else { DVec3::Y };
    let t = (other - n * n.dot(other)).normalize();
    (t, n.cross(t))
}

/// A panorama with rows from +Y to -Y, whose middle column looks along -Z, interpolated bilinearly.
pub struct Panorama<'a> {
    /// Width, in texels.
    pub width: u32,
    /// Height, in texels.
    pub height: u32,
    /// Texels, row by row.
    pub texels: &'a [[f32; 4]],
}

impl Panorama<'_> {
    /// Returns the radiance from a direction.
    pub fn radiance(&self, d: DVec3) -> DVec3 {
        let x = (d.x.atan2(-d.z) / TAU + 0.5) * f64::from(self.width) - 0.5;
        let y = d.y.clamp(-1.0, 1.0).acos() / PI * f64::from(self.height) - 0.5;
        let (x0, y0) = (x.floor(), y.floor());
        let at = |x: f64, y: f64| {
            let column = (x as i64).rem_euclid(i64::from(self.width)) as usize;
            let row = (y as i64).clamp(0, i64::from(self.height) - 1) as usize;
            let [r, g, b, _] = self.texels[row * self.width as usize + column];
            DVec3::new(f64::from(r), f64::from(g), f64::from(b))
        };
        let top = at(x0, y0).lerp(at(x0 + 1.0, y0), x - x0);
        let bottom = at(x0, y0 + 1.0).lerp(at(x0 + 1.0, y0 + 1.0), x - x0);
        top.lerp(bottom, y - y0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_even_and_a_constant_sky_is_its_irradiance() {
        let all = directions(1000);
        let lean = all.iter().sum::<DVec3>() / 1000.0;
        assert!(lean.length() < 1e-3);
        assert!((irradiance_over_pi(DVec3::new(0.6, 0.0, 0.8), 8, |_| 3.0) - 3.0).abs() < 1e-12);
        // A sky that is bright above: E/π of the cosine lobe toward its axis is 2/3.
        let lobe = irradiance_over_pi(DVec3::Y, 200, |d| d.y.max(0.0));
        assert!((lobe - 2.0 / 3.0).abs() < 1e-4, "{lobe}");
    }
}
