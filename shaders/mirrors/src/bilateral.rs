//! Mirror of `wgsl/lib/bilateral.wgsl`.

/// Returns the weight of a sample whose surface is `apart_m` away in depth.
pub fn bilateral_weight(apart_m: f64, threshold_m: f64) -> f64 {
    (1.0 - (apart_m / threshold_m).powi(2)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_surface_counts_and_another_does_not() {
        assert_eq!([0.0, 0.05, -0.05, 3.0].map(|d| bilateral_weight(d, 0.05)), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(bilateral_weight(0.025, 0.05), 0.75);
    }
}
