//! Directional albedo of lobes, integrated over a grid of half vectors.

use glam::DVec3;
use std::f64::consts::PI;

/// Masking-shadowing function of GGX.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Masking {
    /// Height-correlated Smith.
    Smith,
    /// Hammon's approximation of height-correlated Smith.
    Hammon,
}

/// Rows and columns of the grid.
const ROWS: u32 = 600;
const COLUMNS: u32 = 300;

/// Integrates f over half vectors of the upper hemisphere; f gets (v·h, n·l, h). The grid is uniform in the fourth root
/// of the angle.
fn over_half_vectors(nov: f64, f: impl Fn(f64, f64, DVec3) -> [f64; 2]) -> [f64; 2] {
    let v = DVec3::new((1.0 - nov * nov).sqrt(), 0.0, nov);
    let mut sums = [0.0; 2];
    for row in 0..ROWS {
        let u = (f64::from(row) + 0.5) / f64::from(ROWS);
        let (sin, cos) = (0.5 * PI * u.powi(4)).sin_cos();
        let area = sin * 2.0 * PI * u.powi(3) / f64::from(ROWS) * 2.0 * PI / f64::from(COLUMNS);
        for column in 0..COLUMNS {
            // Half of the azimuths; the other half is symmetric.
            let (s, c) = ((f64::from(column) + 0.5) / f64::from(COLUMNS) * PI).sin_cos();
            let h = DVec3::new(sin * c, sin * s, cos);
            let voh = v.dot(h);
            let nol = 2.0 * voh * h.z - nov;
            if voh > 0.0 && nol > 0.0 {
                let [a, b] = f(voh, nol, h);
                // Conversion from half vectors to light directions.
                sums[0] += a * area * 4.0 * voh;
                sums[1] += b * area * 4.0 * voh;
            }
        }
    }
    sums
}

/// Returns (∫ D·V·(1-v·h)⁵·cos, ∫ D·V·cos) of GGX.
pub fn ggx(nov: f64, roughness: f64, masking: Masking) -> [f64; 2] {
    let a = roughness * roughness;
    let tail = |c: f64| (a * a * (1.0 - c * c) + c * c).sqrt();
    over_half_vectors(nov, |voh, nol, h| {
        let d = a * a / (PI * (1.0 - h.z * h.z * (1.0 - a * a)).powi(2));
        let v = match masking {
            Masking::Smith => 0.5 / (nol * tail(nov) + nov * tail(nol)),
            Masking::Hammon => 0.5 / (2.0 * nol * nov * (1.0 - a) + (nol + nov) * a),
        };
        [d * v * nol * (1.0 - voh).powi(5), d * v * nol]
    })
}

/// Returns ∫ D·V·F·cos of GGX with height-correlated Smith masking, for a Fresnel term of v·h.
pub fn ggx_of(nov: f64, roughness: f64, fresnel: impl Fn(f64) -> f64) -> f64 {
    let a = roughness * roughness;
    let tail = |c: f64| (a * a * (1.0 - c * c) + c * c).sqrt();
    over_half_vectors(nov, |voh, nol, h| {
        let d = a * a / (PI * (1.0 - h.z * h.z * (1.0 - a * a)).powi(2));
        [d * nol * fresnel(voh) * 0.5 / (nol * tail(nov) + nov * tail(nol)), 0.0]
    })[0]
}

/// Returns ∫ D·V·cos of the Charlie distribution with Ashikhmin's visibility.
pub fn cloth(nov: f64, roughness: f64) -> f64 {
    let inverse = 1.0 / (roughness * roughness);
    over_half_vectors(nov, |_, nol, h| {
        let sin2 = (1.0 - h.z * h.z).max(1.0 / 128.0);
        let d = (2.0 + inverse) * sin2.powf(inverse / 2.0) / (2.0 * PI);
        [0.0, d * nol / (4.0 * (nol + nov - nol * nov))]
    })[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_albedos_are_met() {
        // At normal incidence, the albedo is 1 - ln 2 at roughness 1, and 1 for a smooth surface.
        let rough = ggx(1.0, 1.0, Masking::Smith)[1];
        assert!((rough - (1.0 - 2.0_f64.ln())).abs() < 1e-4, "{rough}");
        let smooth = ggx(0.5, 0.1, Masking::Smith);
        assert!((smooth[1] - 1.0).abs() < 1e-3, "{smooth:?}");
        assert!((smooth[0] - 0.5_f64.powi(5)).abs() < 1e-3, "{smooth:?}");
        let all = ggx_of(0.4, 0.6, |_| 1.0);
        assert!((all - ggx(0.4, 0.6, Masking::Smith)[1]).abs() < 1e-12, "{all}");
    }
}
