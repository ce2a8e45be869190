//! Mirror of `wgsl/lib/shadow.wgsl`.

use glam::{DVec2, DVec3, DVec4};

use super::math::saturate;

/// Returns the offset along the normal, in m.
pub fn normal_offset(normal: DVec3, right: DVec3, up: DVec3, scale: DVec2) -> DVec3 {
    normal * DVec2::new(normal.dot(right), normal.dot(up)).abs().dot(scale)
}

/// Returns (u, v, depth) in the map.
pub fn shadow_uvz_from_clip(clip: DVec4) -> DVec3 {
    let ndc = clip.truncate() / clip.w;
    DVec3::new(ndc.x * 0.5 + 0.5, 0.5 - ndc.y * 0.5, ndc.z)
}

/// Four bilinear taps that together form a 3×3 tent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TentTaps {
    /// Left and right u of the taps.
    pub u: DVec2,
    /// Top and bottom v of the taps.
    pub v: DVec2,
    /// Weights of the columns.
    pub column_weight: DVec2,
    /// Weights of the rows.
    pub row_weight: DVec2,
}

/// Returns the taps of a 3×3 tent centered on `uv`, in a map of `size` texels.
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

/// Returns depth per texture coordinate along a receiver's plane; 0 for edge-on receivers.
pub fn receiver_plane_slope(a: DVec3, b: DVec3) -> DVec2 {
    let det = a.x * b.y - a.y * b.x;
    if det.abs() <= 1e-3 * a.truncate().length() * b.truncate().length() {
        return DVec2::ZERO;
    }
    DVec2::new(a.z * b.y - b.z * a.y, b.z * a.x - a.z * b.x) / det
}

/// Returns a tap of a Vogel disc with unit radius.
pub fn vogel_tap(index: u32, count: u32, turn: f64) -> DVec2 {
    let radius = ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
    DVec2::from_angle(f64::from(index) * 2.399_963_2 + turn) * radius
}

/// Returns the share of taps in shadow, with increased contrast.
pub fn hardened_kernel(share: f64) -> f64 {
    let x = 2.0 * share - 1.0;
    let s = if x == 0.0 { 0.0 } else { x.signum() };
    0.5 * (s - s * (1.0 - s * x).powi(3)) + 0.5
}

/// Returns the width of a penumbra divided by that of the light source, for linear reversed depths.
pub fn penumbra_ratio_parallel(receiver: f64, blocker: f64) -> f64 {
    (blocker - receiver).max(0.0) / (1.0 - blocker).max(1e-4)
}

/// Returns the width of a penumbra divided by that of the light source, for perspective reversed depths.
pub fn penumbra_ratio_perspective(receiver: f64, blocker: f64, near_over_range: f64) -> f64 {
    ((near_over_range + blocker) / (near_over_range + receiver).max(1e-7) - 1.0).max(0.0)
}

/// Returns the cascade at a distance ahead of the eye.
pub fn cascade_at(ahead_m: f64, far_ends: [f64; 4]) -> u32 {
    far_ends.iter().filter(|end| **end < ahead_m).count() as u32
}

/// Returns visibility, faded to one at the far end.
pub fn faded_visibility(visibility: f64, ahead_m: f64, inv_far2: f64) -> f64 {
    1.0 - (1.0 - visibility) * saturate(5.0 - 5.0 * ahead_m * ahead_m * inv_far2)
}

/// Returns the visibility of a light with this shadow strength.
pub fn weakened_visibility(visibility: f64, strength: f64) -> f64 {
    visibility * strength + (1.0 - strength)
}

/// Returns the cube face that a direction points to.
pub fn cube_face_of(direction: DVec3) -> u32 {
    let a = direction.abs();
    if a.x >= a.y && a.x >= a.z {
        u32::from(direction.x < 0.0)
    } else if a.y >= a.z {
        2 + u32::from(direction.y < 0.0)
    } else {
        4 + u32::from(direction.z < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the filter weight of each texel center along one axis.
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
        // Each of the four texel weights is the overlap of its cell with a box of width two around the center,
        // convolved with the texel.
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
            // The edge fades over about three texels, so it changes by at most 0.5 per texel.
            assert!((now - last).abs() < 0.51 * 16.0 * 0.3 / 1000.0, "{u}");
            last = now;
        }
        assert!(lit(0.35) == 1.0 && last == 0.0);
    }

    /// Verifies that the offset moves the receiver's plane past every depth in the kernel, but no farther than the
    /// kernel's corner (hard case 42).
    #[test]
    fn hard_case_42_bias_covers_the_kernel_and_no_more() {
        let (right, up, toward) = (DVec3::X, DVec3::Y, DVec3::Z);
        let (texel, reach) = (DVec2::new(0.01, 0.03), 2.0);
        let (right, up) = (right * texel.x * reach, up * texel.y * reach);
        for degrees in [0.0, 10.0, 45.0, 80.0, 89.9, 90.0] {
            for turn in 0..12 {
                let (tilt, turn) = (f64::to_radians(degrees), f64::from(turn) * 0.5);
                let across = DVec3::new(turn.cos(), turn.sin(), 0.0);
                let normal = across * tilt.sin() + toward * tilt.cos();
                let offset = normal_offset(normal, right, up, DVec2::ONE);
                assert!(offset.length() <= reach * texel.length() + 1e-12, "{degrees}: {offset}");
                // Any point of the plane within the kernel lies behind the moved receiver, seen along the light.
                for corner in [DVec2::new(1.0, 1.0), DVec2::new(1.0, -1.0), DVec2::new(-1.0, 1.0), -DVec2::ONE] {
                    let at = (corner * texel * reach).extend(0.0);
                    let height = normal.dot(offset) - normal.dot(at);
                    assert!(height >= -1e-12, "{degrees}, {turn}: {height}");
                }
            }
        }
        assert_eq!(normal_offset(toward, right, up, DVec2::ONE), DVec3::ZERO);
    }

    #[test]
    fn a_slope_is_that_of_the_plane_and_none_edge_on() {
        let slope = DVec2::new(0.3, -2.0);
        let along = |d: DVec2| d.extend(d.dot(slope));
        let found = receiver_plane_slope(along(DVec2::new(0.01, 0.002)), along(DVec2::new(-0.004, 0.03)));
        assert!((found - slope).length() < 1e-9, "{found}");
        let edge_on = receiver_plane_slope(DVec3::new(0.1, 0.1, 5.0), DVec3::new(0.2, 0.2, -3.0));
        assert_eq!((edge_on, receiver_plane_slope(DVec3::ZERO, DVec3::ZERO)), (DVec2::ZERO, DVec2::ZERO));
    }

    /// Hard case 43: penumbrae are finite for blockers at the near end, at the receiver, and without blockers.
    #[test]
    fn hard_case_43_penumbrae_stay_finite() {
        for (receiver, blocker) in [(0.2, 1.0), (1.0, 1.0), (0.3, 0.3), (0.5, 0.4), (0.0, 0.0)] {
            let ratios = [
                penumbra_ratio_parallel(receiver, blocker),
                penumbra_ratio_perspective(receiver, blocker, 0.001),
                penumbra_ratio_perspective(receiver, blocker, 0.0),
            ];
            assert!(ratios.iter().all(|r| r.is_finite() && *r >= 0.0), "{receiver} {blocker}: {ratios:?}");
        }
        // Half-way between the near end and the receiver, the penumbra is as wide as the light source.
        assert!((penumbra_ratio_parallel(0.2, 0.6) - 1.0).abs() < 1e-12);
    }

    /// Hard case 46: an edge between faces belongs to one of them.
    #[test]
    fn hard_case_46_ties_of_faces_go_to_the_first() {
        assert_eq!(cube_face_of(DVec3::ONE), 0);
        assert_eq!(cube_face_of(DVec3::new(0.0, -1.0, 1.0)), 3);
        assert_eq!(cube_face_of(DVec3::ZERO), 0);
        let faces = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z].map(cube_face_of);
        assert_eq!(faces, [0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn the_map_is_upright() {
        let at = shadow_uvz_from_clip(DVec4::new(-2.0, 2.0, 0.5, 2.0));
        assert_eq!(at, DVec3::new(0.0, 0.0, 0.25));
    }
}
