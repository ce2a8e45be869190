//! Mirror of `wgsl/lib/screen_ray.wgsl`.

use super::math::saturate;
use glam::DVec2;

/// Returns the length of a ray, shortened to stay behind the near plane.
pub fn ray_length_m(from_z: f64, way_z: f64, near_z: f64, reach_m: f64) -> f64 {
    let left = near_z - from_z;
    if left <= 0.0 {
        0.0
    } else if way_z * reach_m > left {
        left / way_z
    } else {
        reach_m
    }
}

/// Returns the share of the ray that stays on a screen of `size` texels.
pub fn share_in_picture(start: DVec2, way: DVec2, size: DVec2) -> f64 {
    let inside = |at: DVec2| at.cmpge(DVec2::ZERO).all() && at.cmple(size).all();
    if !inside(start) {
        return 0.0;
    }
    let axis = |start: f64, way: f64, size: f64| {
        let border = if way > 0.0 { size - start } else { start };
        border / way.abs().max(1e-6)
    };
    axis(start.x, way.x, size.x).min(axis(start.y, way.y, size.y)).min(1.0)
}

/// Returns true if a ray meets a surface with this thickness.
pub fn ray_meets(before_z: f64, here_z: f64, surface_z: f64, thickness_m: f64) -> bool {
    before_z.max(here_z) >= surface_z - thickness_m && before_z.min(here_z) <= surface_z
}

/// Returns the ray parameter, between two limits, at which its depth equals that of a surface.
pub fn share_at_depth(surface: f64, start: f64, way: f64, low: f64, high: f64) -> f64 {
    if way.abs() < 1e-30 { high } else { ((surface - start) / way).clamp(low, high) }
}

/// Returns true if the hit is not on the surface that the ray left.
pub fn rises_from_plane(met_m: f64, ray_m: f64) -> bool {
    ray_m > 0.0 && met_m > 0.5 * ray_m
}

/// Returns the fade factor of a hit, by the share of the ray's reach.
pub fn reach_fade(share: f64) -> f64 {
    saturate(12.0 * (1.0 - share))
}

/// Returns the weight of traced reflections at a perceptual roughness.
pub fn roughness_fade(roughness: f64, most: f64) -> f64 {
    saturate(4.0 * (1.0 - roughness / most.max(1e-6)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that rays toward the eye end at the near plane and all others have their full reach.
    #[test]
    fn rays_end_before_the_near_plane() {
        assert_eq!(ray_length_m(-1.0, 1.0, -0.1, 3.0), 0.9);
        assert_eq!([0.0, -1.0, 0.2].map(|way_z| ray_length_m(-1.0, way_z, -0.1, 3.0)), [3.0; 3]);
        assert_eq!([0.0, 1.0, -1.0].map(|way_z| ray_length_m(-0.05, way_z, -0.1, 3.0)), [0.0; 3]);
    }

    #[test]
    fn ways_end_at_the_border_that_they_come_to() {
        let size = DVec2::new(64.0, 32.0);
        let share = |x: f64, y: f64| share_in_picture(DVec2::new(32.0, 8.0), DVec2::new(x, y), size);
        assert_eq!(
            [share(64.0, 0.0), share(0.0, 48.0), share(0.0, -16.0), share(-64.0, -64.0)],
            [0.5, 0.5, 0.5, 0.125]
        );
        // A ray along the view direction, which is a point on the screen, and one that stays on the screen.
        assert_eq!([share(0.0, 0.0), share(3.0, 3.0)], [1.0; 2]);
        assert_eq!(share_in_picture(DVec2::new(-0.5, 8.0), DVec2::X, size), 0.0);
        assert_eq!(share_in_picture(DVec2::ZERO, DVec2::NEG_X, size), 0.0, "it starts on the border, and leaves");
    }

    /// Verifies hits between −2 m and −3 m: a front in between, one that ends in between, one behind, and one far in
    /// front.
    #[test]
    fn rays_meet_what_is_between_their_ends() {
        let meets = |surface_z: f64| ray_meets(-2.0, -3.0, surface_z, 0.1);
        assert_eq!([-2.5, -2.0, -3.0, -1.95].map(meets), [true; 4]);
        assert_eq!([-3.01, -1.85].map(meets), [false; 2]);
        assert!(ray_meets(-3.0, -2.0, -2.5, 0.0) && ray_meets(-2.0, -2.0, -2.0, 0.0), "either way, and along");
    }

    #[test]
    fn rays_have_a_depth_at_one_share() {
        assert_eq!(share_at_depth(0.3, 0.5, -0.4, 0.2, 0.8), 0.5);
        assert_eq!([0.45, 0.1].map(|surface| share_at_depth(surface, 0.5, -0.4, 0.2, 0.8)), [0.2, 0.8], "held");
        assert_eq!(share_at_depth(0.5, 0.5, 0.0, 0.2, 0.8), 0.8);
    }

    #[test]
    fn nothing_meets_the_surface_that_it_leaves() {
        assert!(rises_from_plane(1.0, 1.0) && rises_from_plane(3.0, 1.0));
        assert!(!rises_from_plane(0.0, 0.01) && !rises_from_plane(-1.0, 1.0), "the plane itself, and below");
        assert!(!rises_from_plane(1.0, 0.0) && !rises_from_plane(1.0, -1.0), "a ray into its own surface");
    }

    #[test]
    fn fades_begin_and_end_where_they_say() {
        assert_eq!([0.0, 0.9, 1.0, 1.1].map(reach_fade), [1.0, 1.0, 0.0, 0.0]);
        assert_eq!([0.0, 0.375, 0.5, 1.0].map(|r| roughness_fade(r, 0.5)), [1.0, 1.0, 0.0, 0.0]);
        assert!((reach_fade(1.0 - 1.0 / 24.0) - 0.5).abs() < 1e-12 && (roughness_fade(0.7, 0.8) - 0.5).abs() < 1e-12);
        assert_eq!(roughness_fade(0.0, 0.0), 1.0, "a mirror is one whatever the limit");
    }
}
