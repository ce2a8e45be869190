//! Mirror of `wgsl/lib/shadow.wgsl`.

use glam::{DVec2, DVec3, DVec4};

use super::math::saturate;

/// Offset in m along the normal.
pub fn normal_offset(normal: DVec3, to_light: DVec3, texel_m: f64, texels: f64) -> DVec3 {
    let c = saturate(normal.dot(to_light));
    normal * ((1.0 - c * c).max(0.0).sqrt() * texel_m * texels)
}

/// (u, v, depth) inside the map.
pub fn shadow_uvz_from_clip(clip: DVec4) -> DVec3 {
    let ndc = clip.truncate() / clip.w;
    DVec3::new(ndc.x * 0.5 + 0.5, 0.5 - ndc.y * 0.5, ndc.z)
}

/// Four bilinear taps that together form a 3×3 tent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TentTaps {
    /// (left, right) u of the taps.
    pub u: DVec2,
    /// (top, bottom) v of the taps.
    pub v: DVec2,
    /// Weights of the columns.
    pub column_weight: DVec2,
    /// Weights of the rows.
    pub row_weight: DVec2,
}

/// Taps of the 3×3 tent centred on `uv` of a map of `size` texels.
pub fn tent_3x3(uv: DVec2, size: DVec2) -> TentTaps {
    let texel = uv * size + 0.5;
    let base = texel.floor() - 0.5;
    let s = texel - texel.floor();
    let low = 3.0 - 2.0 * s;
    let high = 1.0 + 2.0 * s;
    let low_at = (base + (2.0 - s) / low - 1.0) / size;
    let high_at = (base + s / high + 1.0) / size;
    TentTaps {
        u: DVec2::new(low_at.x, high_at.x),
        v: DVec2::new(low_at.y, high_at.y),
        column_weight: DVec2::new(low.x, high.x) / 4.0,
        row_weight: DVec2::new(low.y, high.y) / 4.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Filter weight that the taps give each texel centre along one axis.
    fn texel_weights(u: f64, size: i32) -> Vec<f64> {
        let taps = tent_3x3(DVec2::splat(u), DVec2::splat(f64::from(size)));
        let mut weights = vec![0.0; size as usize];
        for (at, weight) in [(taps.u.x, taps.column_weight.x), (taps.u.y, taps.column_weight.y)] {
            let x = at * f64::from(size) - 0.5;
            let fraction = x - x.floor();
            weights[x.floor() as usize] += weight * (1.0 - fraction);
            weights[x.floor() as usize + 1] += weight * fraction;
        }
        weights
    }

    #[test]
    fn the_taps_are_a_box_two_wide_smeared_by_a_texel() {
        // Four texels with weights (1 - s, 2 - ... ) / 4: each is the overlap of its cell with
        // a box of width two about the centre, convolved with the texel.
        let size = 16;
        for step in 0..40 {
            let u = 0.4 + f64::from(step) / 400.0;
            let weights = texel_weights(u, size);
            let sum: f64 = weights.iter().sum();
            assert!((sum - 1.0).abs() < 1e-12, "{u}: {sum}");
            let centre: f64 = weights.iter().enumerate().map(|(i, w)| w * (i as f64 + 0.5)).sum();
            assert!((centre - u * f64::from(size)).abs() < 0.26, "{u}: centred at {centre}");
            assert!(weights.iter().filter(|w| **w > 1e-12).count() <= 4);
            assert!(weights.iter().all(|w| *w >= 0.0 && *w <= 0.5 + 1e-12));
        }
    }

    #[test]
    fn the_filter_has_no_steps() {
        let lit = |u: f64| texel_weights(u, 16).iter().take(8).sum::<f64>();
        let mut last = lit(0.35);
        for i in 1..=1000 {
            let u = 0.35 + 0.3 * f64::from(i) / 1000.0;
            let now = lit(u);
            assert!(now <= last + 1e-12, "monotone across an edge");
            // The edge fades over about three texels, so by at most 0.5 a texel.
            assert!((now - last).abs() < 0.51 * 16.0 * 0.3 / 1000.0, "{u}");
            last = now;
        }
        assert!(lit(0.35) == 1.0 && last == 0.0);
    }

    #[test]
    fn bias_grows_to_its_limit_and_no_further() {
        let at = |degrees: f64| {
            let l = DVec3::new(degrees.to_radians().sin(), degrees.to_radians().cos(), 0.0);
            normal_offset(DVec3::Y, l, 0.01, 2.0).y
        };
        assert!(at(0.0).abs() < 1e-9);
        assert!((at(30.0) - 0.01).abs() < 1e-9);
        assert!(at(89.9) <= 0.02 && at(90.0) <= 0.02 && at(135.0) <= 0.02);
    }

    #[test]
    fn the_map_is_upright() {
        let at = shadow_uvz_from_clip(DVec4::new(-2.0, 2.0, 0.5, 2.0));
        assert_eq!(at, DVec3::new(0.0, 0.0, 0.25));
    }
}
