//! Filter samples of a lobe: directions, each with the level of the source to read.
//!
//! Viewer, normal and reflection coincide, so all texels of a level share the samples. Half vectors are
//! GGX-distributed (Walter et al. 2007) along a golden spiral, which is more even than a Hammersley set. Each sample
//! reads the level whose texels cover a few times its solid angle, so that neighboring samples overlap.

use std::f64::consts::{PI, TAU};

use framegraph_shaders::layout::IBL_KERNEL_ROWS;
use glam::Vec4;

/// Footprint of a sample as a multiple of its solid angle. Křivánek and Colbert choose 4, which is best for many
/// samples: the error of a one-texel source is 4 % instead of 11 %. With few samples, 4 would widen the lobe.
const OVERLAP: f64 = 4.0;
/// Footprint of a sample in levels of at most [`FEW`] samples, as a multiple of its solid angle.
const OVERLAP_OF_FEW: f64 = 2.0;
/// Maximum number of samples of a level that counts as having few.
const FEW: u32 = 256;
/// Turns between consecutive points of the spiral: the golden ratio minus one.
const GOLDEN_TURNS: f64 = 0.618_033_988_749_894_9;
/// Maximum number of samples over all texels of a level, which limits its time.
const SAMPLES_PER_LEVEL: u32 = 6 << 20;

/// Sample: a direction about +Z whose z is also its weight, and the source level.
pub type KernelRow = Vec4;

/// Returns the number of samples of a level with `size`² texels per face. Large levels have narrow lobes and get
/// fewer, so that all levels take a similar time.
#[must_use]
pub fn kernel_rows(size_texels: u32) -> u32 {
    (SAMPLES_PER_LEVEL / (6 * size_texels * size_texels)).clamp(64, IBL_KERNEL_ROWS as u32)
}

/// Returns `samples` samples of a lobe of this perceptual roughness, over a source cube of `source_texels`² per face.
/// All are above the horizon. Below roughness 0.001, returns a single direction.
#[must_use]
pub fn lobe_kernel(roughness: f64, samples: u32, source_texels: u32) -> Vec<KernelRow> {
    if roughness < 1e-3 {
        return vec![Vec4::new(0.0, 0.0, 1.0, 0.0)];
    }
    let alpha2 = roughness.powi(4);
    let texel_sr = 4.0 * PI / (6.0 * f64::from(source_texels).powi(2));
    let overlap = if samples <= FEW { OVERLAP_OF_FEW } else { OVERLAP };
    // Fraction of half vectors whose reflection is above the horizon: those below 45°.
    let above = 1.0 / (1.0 + alpha2);
    let row = |i: u32| {
        let u = (f64::from(i) + 0.5) / f64::from(samples) * above;
        let cos2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
        // Reflecting about h doubles its angle.
        let z = 2.0 * cos2 - 1.0;
        let ring = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = ((f64::from(i) * GOLDEN_TURNS).fract() * TAU).sin_cos();
        // The density of l is D(h)·noh / (4·voh), and noh = voh here.
        let d = alpha2 / (PI * (cos2 * (alpha2 - 1.0) + 1.0).powi(2));
        let sample_sr = 4.0 * above / (f64::from(samples) * d);
        let level = 0.5 * (overlap * sample_sr / texel_sr).log2();
        Vec4::new((ring * cos) as f32, (ring * sin) as f32, z as f32, level.max(0.0) as f32)
    };
    (0..samples).map(row).collect()
}

/// Returns the sum of the weights.
pub(super) fn weight_sum(rows: &[KernelRow]) -> f64 {
    rows.iter().map(|row| f64::from(row.z)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_directions_above_the_horizon() {
        for roughness in [0.1, 0.5, 1.0] {
            let rows = lobe_kernel(roughness, 256, 256);
            assert_eq!(rows.len(), 256);
            for row in rows {
                assert!((row.truncate().length() - 1.0).abs() < 1e-6 && row.z > 0.0 && row.w >= 0.0, "{row}");
            }
        }
        assert_eq!(lobe_kernel(0.0, 64, 256), [Vec4::new(0.0, 0.0, 1.0, 0.0)]);
    }

    /// The weighted mean of z and z² over the samples against ∫ D·cos over directions, by quadrature.
    #[test]
    fn moments_are_those_of_the_lobe() {
        for roughness in [0.134, 0.293, 0.5, 1.0_f64] {
            let alpha2 = roughness.powi(4);
            let (mut weight, mut first, mut second) = (0.0, 0.0, 0.0);
            let n = 200_000;
            for i in 0..n {
                // The half vector's angle, squeezed toward the pole.
                let u = (f64::from(i) + 0.5) / f64::from(n);
                let half = 0.25 * PI * u * u;
                let (cos, l) = (half.cos(), 2.0 * half);
                let d = alpha2 / (cos * cos * (alpha2 - 1.0) + 1.0).powi(2);
                let w = d * l.cos() * l.sin() * u;
                weight += w;
                first += w * l.cos();
                second += w * l.cos().powi(2);
            }
            let rows = lobe_kernel(roughness, 1024, 256);
            let sum = weight_sum(&rows);
            let mean = |power: i32| rows.iter().map(|r| f64::from(r.z).powi(power + 1)).sum::<f64>() / sum;
            assert!((mean(1) - first / weight).abs() < 1e-3, "{roughness}: {} for {}", mean(1), first / weight);
            assert!((mean(2) - second / weight).abs() < 2e-3, "{roughness}");
        }
    }

    #[test]
    fn directions_are_spread_around() {
        let rows = lobe_kernel(0.5, 256, 256);
        let sum = weight_sum(&rows) as f32;
        let lean = rows.iter().map(|r| r.truncate() * r.z).sum::<glam::Vec3>() / sum;
        assert!(lean.truncate().length() < 5e-3, "{lean}");
    }

    #[test]
    fn fewer_texels_get_more_samples() {
        assert_eq!([128, 64, 32, 16, 2].map(kernel_rows), [64, 256, 1024, 4096, 4096]);
    }
}
