//! Mirror of `wgsl/lib/gtao.wgsl`.

use glam::DVec2;
use std::f64::consts::FRAC_PI_2;

/// Returns the arc cosine of x clamped to ±1.
pub fn acos_held(x: f64) -> f64 {
    x.clamp(-1.0, 1.0).acos()
}

/// Integrates cosine-weighted light from the view direction to the angle h.
pub fn slice_arc(h: f64, n: f64) -> f64 {
    0.25 * (n.cos() - (2.0 * h - n).cos() + 2.0 * h * n.sin())
}

/// Integrates cosine-weighted light over a whole slice.
pub fn slice_whole(n: f64) -> f64 {
    n.cos() + n * n.sin()
}

/// Returns the share of a slice's light from below the angle.
pub fn slice_share(angle: f64, n: f64) -> f64 {
    let held = angle.clamp(n - FRAC_PI_2, n + FRAC_PI_2);
    let below = slice_arc(n - FRAC_PI_2, n) + if held < 0.0 { -1.0 } else { 1.0 } * slice_arc(held, n);
    (below / slice_whole(n)).clamp(0.0, 1.0)
}

/// Returns the mean direction, within a slice, of the light between the horizons.
pub fn slice_bent(h0: f64, h1: f64, n: f64) -> DVec2 {
    let sine = |h: f64| 6.0 * (h - n).sin() - (3.0 * h - n).sin() - 3.0 * (h + n).sin();
    let cosine = |h: f64| -(3.0 * h - n).cos() - 3.0 * (h + n).cos();
    DVec2::new(16.0 * n.sin() + sine(h0) + sine(h1), 8.0 * n.cos() + cosine(h0) + cosine(h1)) / 12.0
}

/// Returns a mask of those of 32 sectors that lie between two shares of a slice.
pub fn sector_bits(low: f64, high: f64, jitter: f64) -> u32 {
    let edge = |share: f64| (32.0 * share + jitter).floor().clamp(0.0, 32.0) as u32;
    (0..32).filter(|bit| (edge(low)..edge(high)).contains(bit)).fold(0, |bits, bit| bits | 1 << bit)
}

/// Returns the rotation of a texel's slices.
pub fn slice_turn([x, y]: [i32; 2]) -> f64 {
    f64::from((x + y).rem_euclid(4) * 4 + x.rem_euclid(4)) / 16.0
}

/// Returns the step offset of a texel.
pub fn slice_offset([x, y]: [i32; 2]) -> f64 {
    f64::from((y - x).rem_euclid(4)) / 4.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Sums the light of a slice, cos(θ - n)·|sin θ|, in small steps.
    fn added_up(from: f64, to: f64, n: f64, of: impl Fn(f64) -> f64) -> f64 {
        let steps = 20_000;
        let step = (to - from) / f64::from(steps);
        let light = |i| {
            let angle = from + (f64::from(i) + 0.5) * step;
            of(angle) * (angle - n).cos() * angle.sin().abs() * step
        };
        (0..steps).map(light).sum()
    }

    #[test]
    fn integrals_are_those_of_the_light_in_a_slice() {
        for n in [-1.2, -0.5, 0.0, 0.3, 1.0] {
            let (low, high) = (n - FRAC_PI_2, n + FRAC_PI_2);
            assert!((slice_whole(n) - added_up(low, high, n, |_| 1.0)).abs() < 1e-6, "{n}");
            for share in [0.0, 0.2, 0.6, 1.0] {
                let angle = low + share * (high - low);
                let expected = added_up(low, angle, n, |_| 1.0) / slice_whole(n);
                assert!((slice_share(angle, n) - expected).abs() < 1e-6, "{n} {angle}");
                let (h0, h1) = (angle.min(0.0).max(low), (0.5 * high).max(0.0));
                let bent = slice_bent(h0, h1, n);
                let parts = [added_up(h0, h1, n, f64::sin), added_up(h0, h1, n, f64::cos)];
                assert!((bent - DVec2::from_array(parts)).length() < 1e-6, "{n} {h0}: {bent} for {parts:?}");
            }
            assert_eq!((slice_share(-4.0, n), slice_share(4.0, n)), (0.0, 1.0));
        }
        // The directions together give the light of the hemisphere, with slices weighted by the length of the projected
        // normal.
        for tilt in [0.0_f64, 0.7, 1.4] {
            let slices = 1000;
            let mean = (0..slices).map(|slice| {
                let turn = PI * (f64::from(slice) + 0.5) / f64::from(slices);
                // The normal (sin tilt, 0, cos tilt), projected into a slice through z that points to `turn`.
                let along = tilt.sin() * turn.cos();
                slice_whole(along.atan2(tilt.cos())) * along.hypot(tilt.cos())
            });
            assert!((mean.sum::<f64>() / f64::from(slices) - 1.0).abs() < 1e-6, "{tilt}");
        }
    }

    #[test]
    fn sectors_lose_nothing_in_the_mean() {
        assert_eq!([sector_bits(0.0, 1.0, 0.0), sector_bits(0.0, 1.0, 0.9)], [u32::MAX; 2]);
        assert_eq!(sector_bits(0.5, 0.25, 0.5), 0);
        assert_eq!(sector_bits(0.0, 1.0 / 32.0, 0.0), 1);
        let mean = (0..100).map(|i| sector_bits(0.3, 0.31, f64::from(i) / 100.0).count_ones()).sum::<u32>();
        assert!((f64::from(mean) / 100.0 - 0.32).abs() < 0.011, "{mean}");
    }

    #[test]
    fn a_block_of_texels_has_every_turn_once() {
        let mut turns: Vec<i32> = (0..16).map(|i| (16.0 * slice_turn([i % 4 + 5, i / 4 - 2])).round() as i32).collect();
        turns.sort_unstable();
        assert!(turns.into_iter().eq(0..16));
        assert_eq!([[0, 0], [0, 1], [1, 0]].map(slice_offset), [0.0, 0.25, 0.75]);
    }
}
