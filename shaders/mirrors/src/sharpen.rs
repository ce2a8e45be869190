//! Mirror of `wgsl/lib/sharpen.wgsl`.

use glam::DVec3;

/// Sharpens a texel by its four neighbors.
pub fn sharpened(middle: DVec3, neighbors: [DVec3; 4], strength: f64) -> DVec3 {
    let least = neighbors.into_iter().fold(DVec3::INFINITY, DVec3::min);
    let most = neighbors.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
    let to_black = least.min(middle) / (4.0 * most).max(DVec3::splat(1e-5));
    let to_white = (1.0 - most.max(middle)) / (4.0 * least - 4.0).min(DVec3::splat(-1e-5));
    let lobe = (-to_black).max(to_white).max_element().clamp(-0.1875, 0.0) * strength;
    (middle + lobe * neighbors.into_iter().sum::<DVec3>()) / (1.0 + 4.0 * lobe)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_even_stays_and_edges_get_steeper_within_the_display() {
        for even in [0.0, 0.3, 1.0, 50.0] {
            let even = DVec3::splat(even);
            assert!((sharpened(even, [even; 4], 1.0) - even).length() < 1e-12);
        }
        let [dark, bright] = [0.2, 0.8].map(DVec3::splat);
        let neighbors = [dark, dark, dark, bright];
        assert_eq!(sharpened(dark, neighbors, 0.0), dark);
        let sharper = sharpened(dark, neighbors, 1.0);
        assert!(sharper.x < 0.2 && sharper.x >= 0.0, "{sharper}");
        assert!(sharpened(DVec3::splat(2.0), neighbors, 1.0).x == 2.0, "what is brighter than white is left");
    }
}
