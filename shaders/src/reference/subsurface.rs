//! Mirror of `wgsl/lib/subsurface.wgsl`.

use glam::DVec3;

use super::math::{PI, mix, saturate};

/// BSDF times cosine, in 1/sr, of the light that is scattered below a surface of color one.
pub fn subsurface_scatter(vol: f64, nol: f64, power: f64, thickness: f64) -> f64 {
    let forward = ((saturate(-vol) - 1.0) * power).exp2();
    let back = 0.5 * (saturate(nol) * thickness + (1.0 - thickness));
    mix(back, 1.0, forward) * (1.0 - thickness) / PI
}

/// Factor on the ambient light that is scattered below a surface.
pub fn subsurface_ambient(thickness: f64) -> f64 {
    (1.0 - thickness) * 0.5 / PI
}

/// Perceptual roughness of the level of the environment that stands for light through a body.
pub fn subsurface_roughness(alpha: f64, thickness: f64) -> f64 {
    1.0 - (1.0 - saturate(alpha + 0.25 * (1.0 + thickness))).sqrt()
}

/// Cosine wrapped half about the terminator.
pub fn wrapped_cosine(nol: f64) -> f64 {
    saturate((nol + 0.5) / 2.25)
}

/// Tint of light that cloth scatters.
pub fn cloth_tint(color: DVec3, cosine: f64) -> DVec3 {
    (color + saturate(cosine)).clamp(DVec3::ZERO, DVec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The wrapped cosine sums up to π over the sphere, as the cosine does over the hemisphere.
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

    /// Lights behind shine through by the lobe alone, and nothing through a thickness of one.
    #[test]
    fn light_comes_through_thin_bodies() {
        assert!((subsurface_scatter(-1.0, -1.0, 12.0, 0.25) - 0.75 / PI).abs() < 1e-12);
        assert!((subsurface_scatter(1.0, 1.0, 12.0, 0.0) * PI - mix(0.5, 1.0, (-12.0_f64).exp2())).abs() < 1e-12);
        assert_eq!(subsurface_scatter(-1.0, -1.0, 12.0, 1.0), 0.0);
        assert!(subsurface_roughness(0.0, 0.0) < subsurface_roughness(0.1, 0.5));
    }
}
