//! Radiance gathered by a GGX lobe from an environment if viewer, normal and reflection coincide: the first factor of
//! the split sum.

use super::sphere::frame;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Rows and columns of the grid of directions.
const ROWS: u32 = 320;
const COLUMNS: u32 = 256;

/// Returns ∫ L(l)·D(h)·cos over the hemisphere about n, divided by the integral without L; `radiance` has up to three
/// channels.
///
/// The grid is uniform in azimuth, and in the fourth root of the angle. A third of its rows therefore cover the lobe,
/// regardless of its width.
pub fn gathered(n: DVec3, roughness: f64, radiance: impl Fn(DVec3) -> DVec3) -> DVec3 {
    let (t, b) = frame(n);
    let alpha2 = roughness.powi(4);
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for row in 0..ROWS {
        let u = (f64::from(row) + 0.5) / f64::from(ROWS);
        let angle = 0.5 * PI * u.powi(4);
        let cos_half = (0.5 * angle).cos();
        let d = alpha2 / (cos_half * cos_half * (alpha2 - 1.0) + 1.0).powi(2);
        // D · cos · sin dθ, with dθ = 2π u³ du; constants cancel.
        let weight = d * angle.cos() * angle.sin() * u.powi(3);
        let (sin, cos) = angle.sin_cos();
        let mut ring = DVec3::ZERO;
        for column in 0..COLUMNS {
            // Rows are rotated relative to each other, so that edges do not align with the grid.
            let turn = (f64::from(column) + 0.618_034 * f64::from(row)) / f64::from(COLUMNS);
            let (s, c) = (turn * TAU).sin_cos();
            ring += radiance(t * (sin * c) + b * (sin * s) + n * cos);
        }
        sum += ring * weight;
        weights += weight * f64::from(COLUMNS);
    }
    sum / weights
}

/// Returns the radiance gathered from a disc of radiance 1 around `axis`, by a grid over the disc. Small discs fall
/// between the directions of [`gathered`].
pub fn gathered_of_disc(n: DVec3, roughness: f64, axis: DVec3, radius_rad: f64) -> f64 {
    let (t, b) = frame(axis);
    let alpha2 = roughness.powi(4);
    let lobe = |cos: f64| {
        // cos²(θ/2) = (1 + cos θ)/2; the sine of the difference is precise for narrow lobes.
        let cos2 = 0.5 * (1.0 + cos);
        let d = alpha2 / (PI * (cos2 * alpha2 + 0.5 * (1.0 - cos)).powi(2));
        d * cos.max(0.0)
    };
    let whole: f64 = (0..100_000)
        .map(|i| {
            let u = (f64::from(i) + 0.5) / 1e5;
            let angle = 0.5 * PI * u.powi(4);
            lobe(angle.cos()) * angle.sin() * TAU * 2.0 * PI * u.powi(3) / 1e5
        })
        .sum();
    let (rings, columns) = (200, 256);
    let cap = 2.0 * (0.5 * radius_rad).sin().powi(2);
    let mut sum = 0.0;
    for ring in 0..rings {
        // Uniform in the cosine, so that every point has the same solid angle.
        let cos = 1.0 - cap * (f64::from(ring) + 0.5) / f64::from(rings);
        let sin = (1.0 - cos * cos).sqrt();
        for column in 0..columns {
            let turn = (f64::from(column) + 0.618_034 * f64::from(ring)) / f64::from(columns);
            let (s, c) = (turn * TAU).sin_cos();
            sum += lobe(n.dot(t * (sin * c) + b * (sin * s) + axis * cos));
        }
    }
    sum / f64::from(rings * columns) * TAU * cap / whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_grids_agree_on_a_large_disc() {
        let axis = DVec3::new(0.6, 0.0, 0.8);
        let radius = 20.0_f64.to_radians();
        for (n, r) in [(axis, 0.3), (DVec3::Z, 0.5), (DVec3::new(0.8, 0.6, 0.0), 1.0)] {
            let a = gathered(n, r, |l| DVec3::splat(f64::from(u8::from(l.dot(axis) > radius.cos())))).x;
            let b = gathered_of_disc(n, r, axis, radius);
            assert!((a - b).abs() < 5e-3, "{n} {r}: {a} {b}");
        }
    }

    #[test]
    fn a_constant_is_kept_and_a_gradient_is_dimmed_by_the_lobes_mean_cosine() {
        let n = DVec3::new(0.36, 0.48, 0.8);
        for r in [0.1, 0.5, 1.0] {
            assert!((gathered(n, r, |_| DVec3::ONE) - DVec3::ONE).length() < 1e-12);
        }
        // At roughness 1, the lobe is a cosine lobe, whose mean cosine is 2/3.
        let mean = gathered(n, 1.0, |l| DVec3::splat(l.dot(n))).x;
        assert!((mean - 2.0 / 3.0).abs() < 1e-4, "{mean}");
    }
}
