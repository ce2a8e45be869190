//! Sharpness of an edge behind a slab with a rough face, by Walter's microfacet BTDF.
//!
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces", 2007.

use std::f64::consts::PI;

/// Number of rings of the grid of facets.
const RINGS: u32 = 4000;

/// A slab seen straight on: a GGX face toward the eye and a flat face behind.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    /// Perceptual roughness of the face toward the eye; the GGX parameter is its square.
    pub roughness: f64,
    /// Index of refraction.
    pub ior: f64,
    /// Thickness in meters.
    pub thickness_m: f64,
    /// Distance from the far face to the background in meters.
    pub behind_m: f64,
}

impl Slab {
    /// Returns, for each `x`, the fraction of light through a point of the slab that comes from background positions
    /// less than `x` m to the side. This is the profile of an edge over the distance from it.
    ///
    /// Sums facets in rings around the normal; the fraction of a ring has a closed form.
    pub fn edge(&self, xs: &[f64]) -> Vec<f64> {
        let Self { roughness, ior, thickness_m, behind_m } = *self;
        let alpha2 = roughness.powi(4);
        let (mut seen, mut whole) = (vec![0.0; xs.len()], 0.0);
        for ring in 0..RINGS {
            let u = (f64::from(ring) + 0.5) / f64::from(RINGS);
            let tilt = 0.5 * PI * u.powi(3);
            let (sin, cos) = tilt.sin_cos();
            // Refracts toward the normal, by the difference of the angles at the facet.
            let inside = tilt - (sin / ior).asin();
            let leaving = ior * inside.sin();
            if leaving >= 1.0 {
                continue;
            }
            let d = alpha2 / (PI * (cos * cos * (alpha2 - 1.0) + 1.0).powi(2));
            // The eye is on the normal: its masking is 1, and |i·n| is 1.
            let passed = (1.0 - fresnel(cos, ior)) * (1.0 - fresnel(inside.cos(), 1.0 / ior));
            let weight = d * cos * masking(inside, alpha2) * passed * sin * u * u;
            let radius = thickness_m * inside.tan() + behind_m * leaving.asin().tan();
            whole += weight;
            for (share, x) in seen.iter_mut().zip(xs) {
                *share += weight * (1.0 - (x / radius.max(1e-12)).clamp(-1.0, 1.0).acos() / PI);
            }
        }
        seen.into_iter().map(|share| share / whole).collect()
    }
}

/// Returns Smith masking of GGX at an angle from the normal.
fn masking(angle: f64, alpha2: f64) -> f64 {
    2.0 / (1.0 + (1.0 + alpha2 * angle.tan().powi(2)).sqrt())
}

/// Fresnel's reflectance of unpolarized light at a cosine, into a medium whose index is `ratio` times that before it.
fn fresnel(cos: f64, ratio: f64) -> f64 {
    let cos = cos.clamp(0.0, 1.0);
    let beyond2 = 1.0 - (1.0 - cos * cos) / (ratio * ratio);
    if beyond2 <= 0.0 {
        return 1.0;
    }
    let beyond = beyond2.sqrt();
    let across = (cos - ratio * beyond) / (cos + ratio * beyond);
    let along = (ratio * cos - beyond) / (ratio * cos + beyond);
    0.5 * (across * across + along * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLAB: Slab = Slab { roughness: 0.4, ior: 1.5, thickness_m: 0.1, behind_m: 1.0 };

    /// A random walk through facets drawn one by one agrees with the rings.
    #[test]
    fn rings_agree_with_single_rays() {
        let xs = [-0.2, -0.05, 0.0, 0.03, 0.1];
        let rings = SLAB.edge(&xs);
        let alpha2 = SLAB.roughness.powi(4);
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut seen, mut whole) = ([0.0; 5], 0.0);
        for _ in 0..400_000 {
            // Walter's sampling of D·cos, and his weight: |i·m| over |i·n| |m·n| times masking.
            let u = random();
            let tilt = (SLAB.roughness.powi(2) * (u / (1.0 - u)).sqrt()).atan();
            let (turn, cos) = (random() * 2.0 * PI, tilt.cos());
            let inside = tilt - (tilt.sin() / SLAB.ior).asin();
            let leaving = SLAB.ior * inside.sin();
            if leaving >= 1.0 {
                continue;
            }
            let passed = (1.0 - fresnel(cos, SLAB.ior)) * (1.0 - fresnel(inside.cos(), 1.0 / SLAB.ior));
            let weight = passed * masking(inside, alpha2);
            let side = turn.cos() * (SLAB.thickness_m * inside.tan() + SLAB.behind_m * leaving.asin().tan());
            whole += weight;
            for (share, x) in seen.iter_mut().zip(xs) {
                *share += if side < x { weight } else { 0.0 };
            }
        }
        for (ring, ray) in rings.iter().zip(seen) {
            assert!((ring - ray / whole).abs() < 4e-3, "{rings:?} for {seen:?} of {whole}");
        }
    }

    #[test]
    fn an_edge_is_sharp_behind_clear_glass_and_halved_at_its_place() {
        let clear = Slab { roughness: 0.01, ..SLAB };
        let shares = clear.edge(&[-0.01, 0.0, 0.01]);
        assert!(shares[0] < 1e-3 && (shares[1] - 0.5).abs() < 1e-9 && shares[2] > 0.999, "{shares:?}");
        // Index one bends nothing.
        let none = Slab { ior: 1.0, ..SLAB };
        assert!(none.edge(&[1e-6])[0] > 0.999);
    }

    #[test]
    fn reflectance_is_fresnels() {
        assert!((fresnel(1.0, 1.5) - 0.04).abs() < 1e-12 && (fresnel(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-12);
        assert_eq!((fresnel(0.0, 1.5), fresnel(0.1, 1.0 / 1.5)), (1.0, 1.0));
        // Brewster's angle: half of what the other polarization reflects.
        let brewster = 1.5_f64.atan();
        let across = (brewster.cos() - 1.5 * (brewster.sin() / 1.5).asin().cos()).powi(2)
            / (brewster.cos() + 1.5 * (brewster.sin() / 1.5).asin().cos()).powi(2);
        assert!((fresnel(brewster.cos(), 1.5) - 0.5 * across).abs() < 1e-12);
    }
}
