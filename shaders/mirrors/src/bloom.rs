//! Mirror of `wgsl/lib/bloom.wgsl`.

use glam::DVec3;

/// Returns the weights of four texels in a row.
pub fn tent_weights(beyond: f64) -> [f64; 4] {
    [1.0 - beyond, 2.0 - beyond, 1.0 + beyond, beyond].map(|weight| weight * 0.25)
}

/// Returns the largest channel.
pub fn brightest(color: DVec3) -> f64 {
    color.max_element()
}

/// Returns the weight of a color in a mean, reduced for bright texels.
pub fn firefly_weight(color: DVec3) -> f64 {
    1.0 / (1.0 + brightest(color))
}

/// Returns the part of a color that glows.
pub fn glowing(color: DVec3, threshold: f64, hard: f64, per_highlight: f64) -> DVec3 {
    let all = if brightest(color) >= threshold { color } else { DVec3::ZERO };
    let above = (color - threshold).max(DVec3::ZERO).lerp(all, hard);
    above / (1.0 + brightest(above) * per_highlight)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that four texels represent a tent of width three: their weighted mean position equals the sample
    /// position.
    #[test]
    fn weights_are_a_tent_about_the_place() {
        for step in 0..=16 {
            let beyond = f64::from(step) / 16.0;
            let weights = tent_weights(beyond);
            let moment: f64 = weights.iter().zip([-1.0, 0.0, 1.0, 2.0]).map(|(w, x)| w * x).sum();
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12 && (moment - beyond).abs() < 1e-12, "{beyond}");
            assert!(weights.iter().all(|w| *w >= 0.0));
        }
    }

    /// Verifies that one texel of 65504 among three black texels gives a mean of 0.33 instead of 16376.
    #[test]
    fn hard_case_24_a_firefly_does_not_rule_the_mean() {
        let colors = [DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::splat(65504.0)];
        let weights = colors.map(firefly_weight);
        let mean = colors.iter().zip(weights).map(|(c, w)| *c * w).sum::<DVec3>() / weights.iter().sum::<f64>();
        assert!(mean.min_element() > 0.3 && mean.max_element() < 0.34, "{mean}");
    }

    #[test]
    fn hard_case_25_black_and_thresholds_of_nothing_glow_finitely() {
        for threshold in [0.0, 1.0, 1e4] {
            for hard in [0.0, 1.0] {
                assert_eq!(glowing(DVec3::ZERO, threshold, hard, 1e-3), DVec3::ZERO);
                let bright = glowing(DVec3::new(65504.0, 0.0, 1.0), threshold, hard, 1e-3);
                assert!(bright.is_finite() && bright.max_element() < 1000.0 && bright.min_element() >= 0.0, "{bright}");
            }
        }
        let below = DVec3::new(0.5, 0.99, 0.0);
        assert_eq!((glowing(below, 1.0, 0.0, 0.0), glowing(below, 1.0, 1.0, 0.0)), (DVec3::ZERO, DVec3::ZERO));
        let at = DVec3::new(0.5, 1.0, 2.0);
        assert_eq!((glowing(at, 1.0, 0.0, 0.0), glowing(at, 1.0, 1.0, 0.0)), (DVec3::new(0.0, 0.0, 1.0), at));
    }
}
