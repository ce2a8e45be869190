//! Mirror of `wgsl/lib/cone_trace.wgsl`.

/// Returns the share of a cone slice that the visible surface occludes.
pub fn cone_slice(axis_m: f64, scene_m: f64, radius_m: f64, across: f64, bias_m: f64, contact_m: f64) -> f64 {
    let half = radius_m * (1.0 - across * across).max(0.0).sqrt();
    let behind = axis_m + half - scene_m;
    ((behind - bias_m) / (2.0 * half).max(1e-6)).clamp(0.0, 1.0) * (1.0 - behind / contact_m).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_is_filled_by_what_is_in_it() {
        let filled = |scene_m| cone_slice(5.0, scene_m, 0.1, 0.0, 0.0, 1e9);
        // Surface behind the slice, at its back, in its middle, at its front, and in front of it.
        for (scene_m, share) in [(5.2, 0.0), (5.1, 0.0), (5.0, 0.5), (4.9, 1.0), (4.5, 1.0)] {
            assert!((filled(scene_m) - share).abs() < 1e-8, "{scene_m}");
        }
        // A surface one meter in front of the cone is not a contact.
        assert_eq!(cone_slice(5.0, 4.0, 0.1, 0.0, 0.0, 1.0), 0.0);
        assert_eq!(cone_slice(5.0, 5.095, 0.1, 0.0, 0.01, 1.0), 0.0);
    }
}
