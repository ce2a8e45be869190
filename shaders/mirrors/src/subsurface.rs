//! Mirror of `wgsl/lib/subsurface.wgsl`.

use glam::DVec3;

use super::math::{PI, mix, saturate};

/// Evaluates BSDF times cosine, in 1/sr, of subsurface scattering with white color.
pub fn subsurface_scatter(vol: f64, nol: f64, power: f64, thickness: f64) -> f64 {
    let forward = ((saturate(-vol) - 1.0) * power).exp2();
    let back = 0.5 * (saturate(nol) * thickness + (1.0 - thickness));
    mix(back, 1.0, forward) * (1.0 - thickness) / PI
}

/// Returns the factor on ambient light from subsurface scattering.
pub fn subsurface_ambient(thickness: f64) -> f64 {
    (1.0 - thickness) * 0.5 / PI
}

/// Returns the perceptual roughness of the environment level that represents light through an object.
pub fn subsurface_roughness(alpha: f64, thickness: f64) -> f64 {
    1.0 - (1.0 - saturate(alpha + 0.25 * (1.0 + thickness))).sqrt()
}

/// Returns the cosine, wrapped around the terminator by half.
pub fn wrapped_cosine(nol: f64) -> f64 {
    saturate((nol + 0.5) / 2.25)
}

/// Returns the tint of light scattered by cloth.
pub fn cloth_tint(color: DVec3, cosine: f64) -> DVec3 {
    (color + saturate(cosine)).clamp(DVec3::ZERO, DVec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that the wrapped cosine integrates to π over the sphere, as the cosine does over the hemisphere.
    #[test]
    fn wrapping_adds_no_light() {
        let n = 10_000;
        let cell = |i: i32| {
            let cos = -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(n);
            wrapped_cosine(cos) * 2.0 * PI * 2.0 / f64::from(n)
        };
        let sum: f64 = (0..n).map(cell).sum();
        assert!((sum - PI).abs() < 1e-4, "{sum}");
    }

    /// Verifies that lights behind shine through in the lobe only, and that a thickness of one blocks all light.
    #[test]
    fn light_comes_through_thin_bodies() {
        assert!((subsurface_scatter(-1.0, -1.0, 12.0, 0.25) - 0.75 / PI).abs() < 1e-12);
        assert!((subsurface_scatter(1.0, 1.0, 12.0, 0.0) * PI - mix(0.5, 1.0, (-12.0_f64).exp2())).abs() < 1e-12);
        assert_eq!(subsurface_scatter(-1.0, -1.0, 12.0, 1.0), 0.0);
        assert!(subsurface_roughness(0.0, 0.0) < subsurface_roughness(0.1, 0.5));
    }
}
