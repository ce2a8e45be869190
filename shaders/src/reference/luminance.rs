//! Mirror of `wgsl/lib/luminance.wgsl`.

use glam::DVec3;

/// Returns the weighted sum with the luminance weights of Rec.709.
pub fn luminance(color: DVec3) -> f64 {
    color.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_has_luminance_one() {
        assert!((luminance(DVec3::ONE) - 1.0).abs() < 1e-15);
        assert!(luminance(DVec3::Y) > luminance(DVec3::X) && luminance(DVec3::X) > luminance(DVec3::Z));
    }
}
