//! Mirror of `wgsl/lib/vignette.wgsl`.

use glam::DVec2;

/// Returns the transmitted share of light, by the cosine-fourth law.
pub fn vignette_transmittance(radius2: f64, falloff: f64) -> f64 {
    (1.0 + falloff * radius2).powi(-2)
}

/// Returns the share of the image that remains in a fade toward the edges.
pub fn edge_share(from_middle: DVec2, [scale, aspect, radius, falloff]: [f64; 4]) -> f64 {
    let d = (from_middle.abs() * scale * DVec2::new(aspect, 1.0)).clamp(DVec2::ZERO, DVec2::ONE);
    let corner = d.max(DVec2::splat(1e-10)).powf(radius);
    (1.0 - corner.length_squared()).clamp(1e-10, 1.0).powf(falloff)
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_shaders::layout::VignetteUniforms;

    #[test]
    fn corners_are_as_dark_as_asked_and_the_middle_is_bright() {
        for ev in [0.0, 0.5, 1.0, 3.0] {
            let uniforms = VignetteUniforms::new([1920, 1080], ev);
            let at = |x: f32, y: f32| {
                let radius = [x - uniforms.centre_px[0], y - uniforms.centre_px[1]].map(|d| d * uniforms.per_corner_px);
                let radius2 = f64::from(radius[0] * radius[0] + radius[1] * radius[1]);
                -vignette_transmittance(radius2, f64::from(uniforms.falloff)).log2()
            };
            assert!((at(0.0, 0.0) - f64::from(ev)).abs() < 1e-5, "{ev}");
            assert!((at(1920.0, 1080.0) - f64::from(ev)).abs() < 1e-5, "{ev}");
            assert_eq!(at(960.0, 540.0), 0.0);
            assert!(at(0.0, 540.0) <= f64::from(ev), "the sides are no darker than the corners");
        }
    }

    #[test]
    fn it_is_the_cosine_to_the_fourth() {
        for degrees in [0.0_f64, 10.0, 30.0, 60.0] {
            let angle = degrees.to_radians();
            let share = vignette_transmittance(angle.tan().powi(2), 1.0);
            assert!((share - angle.cos().powi(4)).abs() < 1e-12, "{degrees}");
        }
    }
}
