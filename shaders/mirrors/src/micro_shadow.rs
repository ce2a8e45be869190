//! Mirror of `wgsl/lib/micro_shadow.wgsl`.

use super::math::saturate;

/// Returns the share of a light that reaches the bottom of a cavity.
pub fn micro_shadowing(nol: f64, visibility: f64) -> f64 {
    saturate(nol / (1.0 - visibility.min(0.9999)).sqrt()).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that light inside the opening arrives completely and fades outside. An opening of half angle θ has a
    /// visibility of sin²θ.
    #[test]
    fn light_within_the_opening_arrives() {
        for degrees in [10.0_f64, 30.0, 60.0, 80.0] {
            let opening = degrees.to_radians();
            let visibility = opening.sin().powi(2);
            let at = |angle: f64| micro_shadowing(angle.to_radians().cos(), visibility);
            assert!((at(degrees - 1.0) - 1.0).abs() < 1e-12 && at(degrees + 1.0) < 1.0 && at(90.0) < 1e-12);
        }
        assert_eq!((micro_shadowing(0.5, 1.0), micro_shadowing(0.0, 0.0), micro_shadowing(-0.3, 0.5)), (1.0, 0.0, 0.0));
    }
}
