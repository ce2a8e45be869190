//! Mirror of `wgsl/lib/contact_shadow.wgsl`.

use super::math::saturate;
use glam::DVec2;

/// Returns true if a ray is slightly behind a surface, within the tolerance.
pub fn contact_hides(surface: f64, ray: f64, tolerance: f64) -> bool {
    (tolerance - (surface - ray)).abs() < tolerance
}

/// Returns the weight of a contact shadow, by texture coordinates on the screen.
pub fn contact_fade(uv: DVec2) -> f64 {
    let edge = (12.0 * (uv - 0.5).abs() - 5.0).max(DVec2::ZERO);
    saturate(1.0 - edge.length_squared())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_a_little_behind_is_hidden() {
        let hides = |behind: f64| contact_hides(0.5 + behind, 0.5, 0.01);
        assert!(hides(0.001) && hides(0.019) && !hides(0.0) && !hides(-0.001) && !hides(0.021));
        assert!(!contact_hides(0.0, 0.5, 0.01), "nothing is there");
    }

    /// Hard case 36: surfaces outside the screen are unknown and occlude nothing.
    #[test]
    fn hard_case_36_nothing_hides_at_the_edge() {
        for uv in [DVec2::new(-0.01, 0.5), DVec2::new(0.5, 1.01), DVec2::ZERO, DVec2::ONE] {
            assert_eq!(contact_fade(uv), 0.0, "{uv}");
        }
        assert_eq!(contact_fade(DVec2::splat(0.5)), 1.0);
    }
}
