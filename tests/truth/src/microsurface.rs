//! Random walk of light on a rough conductor, for GGX and heights uniform over [-1, 1]. Source: Heitz, Hanika, d'Eon
//! and Dachsbacher, "Multiple-Scattering Microfacet BSDFs with the Smith Model", SIGGRAPH 2016.

use glam::DVec3;
use std::f64::consts::TAU;

/// SplitMix64 generator (Steele, Lea, Flood 2014) of numbers in [0, 1).
pub struct Random(pub u64);

impl Random {
    /// Returns the next number.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Returns Smith's Λ, for directions up and down.
fn lambda(w: DVec3, alpha: f64) -> f64 {
    if w.z > 0.999_999 {
        return 0.0;
    }
    if w.z < -0.999_999 {
        return -1.0;
    }
    let tan2 = (1.0 - w.z * w.z) / (w.z * w.z);
    0.5 * (w.z.signum() * (1.0 + alpha * alpha * tan2).sqrt() - 1.0)
}

/// Returns the share of heights below h.
fn below(h: f64) -> f64 {
    (0.5 * (h + 1.0)).clamp(0.0, 1.0)
}

/// Returns the height at which light along `w` from height `h` hits the surface; `None` if it leaves.
fn next_height(w: DVec3, h: f64, alpha: f64, u: f64) -> Option<f64> {
    if w.z > 0.999_999 {
        return None;
    }
    if w.z < -0.999_999 {
        return Some((2.0 * u * below(h) - 1.0).clamp(-1.0, 1.0));
    }
    if w.z.abs() < 1e-6 {
        return Some(h);
    }
    let lambda = lambda(w, alpha);
    // Downward light always hits.
    let leaves = if w.z > 0.0 { below(h).powf(lambda) } else { 0.0 };
    if u > 1.0 - leaves {
        return None;
    }
    Some((2.0 * below(h) / (1.0 - u).powf(1.0 / lambda) - 1.0).clamp(-1.0, 1.0))
}

/// Returns a random normal visible from `w`, up or down: points on the silhouette of the stretched hemisphere, sampled
/// again if below the surface.
fn visible_normal(w: DVec3, alpha: f64, random: &mut Random) -> DVec3 {
    let stretched = DVec3::new(alpha * w.x, alpha * w.y, w.z).normalize();
    let (t, b) = super::sphere::frame(stretched);
    loop {
        let (radius2, (s, c)) = (random.uniform(), (random.uniform() * TAU).sin_cos());
        let n = (t * c + b * s) * radius2.sqrt() + stretched * (1.0 - radius2).sqrt();
        if n.z > 0.0 {
            return DVec3::new(alpha * n.x, alpha * n.y, n.z).normalize();
        }
    }
}

/// Returns the share of light from direction (n·v) that is reflected, for each f0, with Schlick's Fresnel at each
/// bounce; the mean of `paths` walks.
pub fn albedo<const N: usize>(nov: f64, roughness: f64, f0: [f64; N], paths: u32, random: &mut Random) -> [f64; N] {
    let alpha = roughness * roughness;
    let mut sums = [0.0; N];
    for _ in 0..paths {
        let mut w = DVec3::new(-(1.0 - nov * nov).sqrt(), 0.0, -nov);
        let mut height = 1.0;
        let mut weights = [1.0; N];
        // A share of the light leaves at each bounce, so walks end long before 1000 bounces.
        for _ in 0..1000 {
            let Some(next) = next_height(w, height, alpha, random.uniform()) else { break };
            height = next;
            let m = visible_normal(-w, alpha, random);
            let cos = (-w).dot(m).clamp(0.0, 1.0);
            for (weight, f0) in weights.iter_mut().zip(f0) {
                *weight *= f0 + (1.0 - f0) * (1.0 - cos).powi(5);
            }
            w += m * (2.0 * cos);
        }
        sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight);
    }
    sums.map(|sum| sum / f64::from(paths))
}

#[cfg(test)]
mod tests {
    use super::super::albedo::{Masking, ggx};
    use super::*;

    #[test]
    fn a_perfect_reflector_loses_nothing() {
        let [all] = albedo(0.5, 0.8, [1.0], 2000, &mut Random(1));
        assert!((all - 1.0).abs() < 1e-12);
    }

    /// The share that leaves after one bounce is the single-scattering albedo.
    #[test]
    fn its_first_bounce_is_the_single_scattering_lobe() {
        for (nov, roughness) in [(0.3, 0.5), (0.9, 1.0), (0.1, 0.8)] {
            let (alpha, mut random, paths) = (roughness * roughness, Random(7), 40_000);
            let mut left = 0;
            for _ in 0..paths {
                let w = DVec3::new(-(1.0_f64 - nov * nov).sqrt(), 0.0, -nov);
                let h = next_height(w, 1.0, alpha, random.uniform()).expect("what goes down hits");
                let m = visible_normal(-w, alpha, &mut random);
                let out = w + m * (2.0 * (-w).dot(m));
                left += u32::from(next_height(out, h, alpha, random.uniform()).is_none());
            }
            let share = f64::from(left) / f64::from(paths);
            let single = ggx(nov, roughness, Masking::Smith)[1];
            // Three standard errors of 40,000 walks.
            assert!((share - single).abs() < 0.0075, "{nov} {roughness}: {share} for {single}");
        }
    }
}
