//! Mirror of `wgsl/lib/flare.wgsl`.

use super::math::smoothstep;
use glam::DVec2;

/// Returns 1 at `middle`, falling smoothly to 0 at `reach` on both sides.
pub fn flare_ring(x: f64, middle: f64, reach: f64) -> f64 {
    1.0 - smoothstep(0.0, 1.0, ((x - middle).abs() / reach.max(1e-6)).min(1.0))
}

/// Returns the source position of ghost `number` at `uv`.
pub fn ghost_place(uv: DVec2, spacing: f64, number: f64) -> DVec2 {
    let mirrored = 1.0 - uv;
    let place = mirrored + (0.5 - mirrored) * spacing * number;
    place - place.floor()
}

/// Returns the unit vector toward the image center, in texture coordinates.
pub fn flare_direction(uv: DVec2, aspect: f64) -> DVec2 {
    let v = (0.5001 - uv) * DVec2::new(aspect, 1.0);
    v / v.length_squared().max(1e-12).sqrt() * DVec2::new(1.0 / aspect, 1.0)
}

/// Returns noise with 256 cells per unit. The sine's argument has low precision in f32, so the noise differs between
/// devices.
pub fn starburst_noise(x: f64) -> f64 {
    let at = (x - x.floor()) * 256.0 - 0.5;
    let hash = |cell: f64| {
        let v = ((cell + 256.0) % 256.0 * 12.9898).sin() * 437.585453;
        v - v.floor()
    };
    let cell = at.floor();
    0.5 + 0.5 * (hash(cell) + (hash(cell + 1.0) - hash(cell)) * (at - cell))
}

/// Returns the share of the flare that remains at `uv`.
pub fn starburst(uv: DVec2, turn: f64) -> f64 {
    let v = uv - 0.5001;
    let d = v.length();
    let angle = (v.x / d.max(1e-6)).clamp(-1.0, 1.0).acos();
    let rays = starburst_noise(angle + turn) * starburst_noise(angle - 0.5 * turn);
    (rays + 1.0 - smoothstep(0.0, 0.3, d)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that ghost 0 is the image mirrored about its center, and that a spacing of 1 moves ghost 1 to the
    /// center.
    #[test]
    fn ghosts_lie_on_the_line_through_the_middle() {
        let uv = DVec2::new(0.2, 0.7);
        assert!((ghost_place(uv, 0.6, 0.0) - DVec2::new(0.8, 0.3)).length() < 1e-12);
        assert!((ghost_place(uv, 1.0, 1.0) - 0.5).length() < 1e-12);
        let aside = ghost_place(uv, 0.6, 1.0) - 0.5;
        assert!(aside.perp_dot(uv - 0.5).abs() < 1e-12);
    }

    /// Verifies that the halo has the same radius in every direction, in image heights, and that nothing divides by
    /// zero.
    #[test]
    fn directions_have_a_length_everywhere() {
        for uv in [DVec2::splat(0.5), DVec2::splat(0.5001), DVec2::new(0.0, 1.0), DVec2::new(0.9, 0.5)] {
            let v = flare_direction(uv, 2.0) * DVec2::new(2.0, 1.0);
            assert!(v.is_finite() && v.length() < 1.0 + 1e-9, "{uv}: {v}");
        }
        assert!((flare_direction(DVec2::new(0.9, 0.2), 2.0) * DVec2::new(2.0, 1.0)).length() > 1.0 - 1e-9);
    }

    /// Verifies the range of Filament's random numbers: 0.5 to 1, with a mean of 0.75 and no step within 256 cells.
    #[test]
    fn rays_are_shares() {
        let all: Vec<f64> = (0..4096).map(|i| starburst_noise(f64::from(i) / 4096.0)).collect();
        let mean = all.iter().sum::<f64>() / 4096.0;
        assert!(all.iter().all(|x| (0.5..=1.0).contains(x)) && (mean - 0.75).abs() < 0.03, "{mean}");
        assert!(all.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 0.5 / 15.0));
        assert_eq!(starburst(DVec2::splat(0.5001), 1.0), 1.0);
        assert!((0.25..0.9).contains(&starburst(DVec2::new(0.0, 0.9), 1.0)));
    }
}
