//! Mirror of `wgsl/lib/dither.wgsl`.

use glam::DVec2;

/// Returns interleaved gradient noise in [0, 1).
pub fn interleaved_gradient_noise(pixel: DVec2, frame: u32) -> f64 {
    let p = pixel + DVec2::splat(5.588_238 * f64::from(frame % 64));
    let inner = p.dot(DVec2::new(0.067_110_56, 0.005_837_15));
    let outer = 52.982_918_9 * (inner - inner.floor());
    outer - outer.floor()
}

/// Returns the offset to add to an encoded value before quantization to `levels` steps.
pub fn dither_offset(pixel: DVec2, frame: u32, levels: f64) -> f64 {
    (interleaved_gradient_noise(pixel, frame) - 0.5) / levels
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(frame: u32) -> Vec<f64> {
        (0..64 * 64)
            .map(|i| DVec2::new(f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5))
            .map(|p| interleaved_gradient_noise(p, frame))
            .collect()
    }

    #[test]
    fn noise_is_uniform() {
        for frame in [0, 1, 63, 64, 1_000_000] {
            let values = field(frame);
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
            assert!(values.iter().all(|v| (0.0..1.0).contains(v)));
            assert!((mean - 0.5).abs() < 0.01, "frame {frame}: mean {mean}");
            // A uniform distribution has a standard deviation of 1/√12 = 0.289.
            assert!((variance.sqrt() - 0.289).abs() < 0.01, "frame {frame}");
        }
    }

    #[test]
    fn the_pattern_moves_and_repeats_after_64_frames() {
        assert_ne!(field(0), field(1));
        assert_eq!(field(3), field(67));
    }

    #[test]
    fn dither_keeps_the_mean_of_a_flat_area() {
        for value in [0.3, 0.3 + 0.25 / 255.0, 0.3 + 0.5 / 255.0] {
            let codes = (0..64 * 64).map(|i| {
                let p = DVec2::new(f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5);
                ((value + dither_offset(p, 0, 255.0)) * 255.0).round()
            });
            let mean = codes.sum::<f64>() / 4096.0;
            assert!((mean - value * 255.0).abs() < 0.02, "in codes: {mean}");
        }
    }
}
