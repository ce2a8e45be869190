//! The sun of a scene, and its orthographic view: fitted to what receives shadows, deep enough for whatever casts them.
//!
//! The fit depends on the scene and the sun alone, not on a camera; so all views of a scene share one shadow map. Each
//! expresses the fit relative to an origin near its camera, in meters, so that single precision suffices far from the
//! world's origin. Depth is reversed: 1 nearest the sun, 0 farthest.

use framegraph_scene::{Aabb, Light, LightKind, Scene};
use glam::{DMat4, DVec3, DVec4};

/// The light that casts the shadow, and all others of the scene that are on. It is `own`, the sun that came with the
/// environment, if that is on; else the scene's brightest directional light.
pub(crate) fn sun_and_others<'a>(scene: &'a Scene, own: Option<&'a Light>) -> (Option<&'a Light>, Vec<&'a Light>) {
    let directional = |light: &&Light| matches!(light.kind, LightKind::Directional { .. }) && light.is_on();
    let brightest = || {
        let suns = scene.lights.iter().filter(directional);
        suns.max_by(|a, b| illuminance_lux(a).total_cmp(&illuminance_lux(b)))
    };
    let sun = own.filter(|sun| sun.is_on()).or_else(brightest);
    let is_sun = |light: &&Light| sun.is_some_and(|sun| std::ptr::eq(sun, *light));
    (sun, scene.lights.iter().filter(|l| l.is_on() && !is_sun(l)).collect())
}

/// Illuminance of a directional light in lux, on a surface that faces it; 0 for others.
pub(crate) fn illuminance_lux(light: &Light) -> f32 {
    match light.kind {
        LightKind::Directional { illuminance_lux, .. } => illuminance_lux,
        _ => 0.0,
    }
}

/// Angular radius of a directional light's disc in radians; 0 for others.
pub(crate) fn angular_radius_rad(light: &Light) -> f32 {
    match light.kind {
        LightKind::Directional { angular_radius_rad, .. } => angular_radius_rad,
        _ => 0.0,
    }
}

/// A fitted view of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunView {
    /// Rows of the rotation and scale from world space to clip space.
    rows: [DVec3; 3],
    /// The world position in meters that is at clip (0, 0, 0).
    center: DVec3,
    /// World size of a texel of the shadow map in meters, the larger of both axes.
    pub texel_m: f64,
}

impl SunView {
    /// Fits the view to `receivers` across and to `receivers` and `casters` in depth, for a map of `map_texels`² texels.
    /// `toward_sun` is a unit vector.
    ///
    /// The view is snapped to whole texels of the world, so that it does not crawl when the bounds move a little. Bounds
    /// that are empty give a view of a millimeter around the world's origin.
    pub fn fit(receivers: &Aabb, casters: &Aabb, toward_sun: DVec3, map_texels: u32) -> Self {
        let toward = toward_sun.try_normalize().unwrap_or(DVec3::Y);
        // Any axis that is not parallel to the light does; the choice only turns the map.
        let up = if toward.y.abs() > 0.99 { DVec3::Z } else { DVec3::Y };
        let right = up.cross(toward).normalize();
        let up = toward.cross(right);
        let axes = [right, up, toward];

        let across = range(receivers, &axes);
        let deep = range(&receivers.union(*casters), &axes);
        let texels = f64::from(map_texels.max(4));
        // One texel of border on each side keeps filter taps inside the map.
        let extent = |axis: usize| (across[axis].1 - across[axis].0).max(MIN_EXTENT_M) * texels / (texels - 2.0);
        let texel = [extent(0) / texels, extent(1) / texels];
        let snapped = |axis: usize| {
            let middle = 0.5 * (across[axis].0 + across[axis].1);
            (middle / texel[axis]).round() * texel[axis]
        };
        let (far, near) = (deep[2].0, deep[2].1.max(deep[2].0 + MIN_EXTENT_M));
        let center = right * snapped(0) + up * snapped(1) + toward * far;

        let scale = DVec3::new(2.0 / extent(0), 2.0 / extent(1), 1.0 / (near - far));
        let rows = [right * scale.x, up * scale.y, toward * scale.z];
        Self { rows, center, texel_m: texel[0].max(texel[1]) }
    }

    /// From positions relative to `origin`, a world position in meters, to the sun's clip space. The origin is subtracted
    /// in double precision.
    pub fn clip_from_world(&self, origin: DVec3) -> DMat4 {
        let center = self.center - origin;
        let row = |axis: usize| self.rows[axis].extend(-self.rows[axis].dot(center));
        DMat4::from_cols(row(0), row(1), row(2), DVec4::W).transpose()
    }
}

/// The smallest extent of the view in meters: an empty or flat scene still gives a finite matrix.
const MIN_EXTENT_M: f64 = 1e-3;

/// Smallest and largest coordinate of the bounds along each axis; zero for empty bounds.
fn range(bounds: &Aabb, axes: &[DVec3; 3]) -> [(f64, f64); 3] {
    if bounds.is_empty() {
        return [(0.0, 0.0); 3];
    }
    axes.map(|axis| {
        let along = bounds.corners().map(|corner| corner.dot(axis));
        along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| (low.min(*c), high.max(*c)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(min: [f64; 3], max: [f64; 3]) -> Aabb {
        Aabb { min: DVec3::from(min), max: DVec3::from(max) }
    }

    #[test]
    fn every_corner_lies_in_the_map_and_nearer_means_larger_depth() {
        let scene = bounds([-3.0, 0.0, -2.0], [4.0, 2.0, 5.0]);
        let directions =
            [DVec3::Y, -DVec3::Y, DVec3::X, DVec3::new(0.3, 0.8, -0.5).normalize(), DVec3::new(1e-9, 1.0, 0.0)];
        for toward in directions {
            let origin = DVec3::new(100.0, 2.0, -7.0);
            let clip_from_world = SunView::fit(&scene, &scene, toward, 1024).clip_from_world(origin);
            let mut depths: Vec<(f64, f64)> = Vec::new();
            for corner in scene.corners() {
                let clip = clip_from_world * (corner - origin).extend(1.0);
                assert!(clip.is_finite() && clip.x.abs() <= 1.0 && clip.y.abs() <= 1.0, "{toward}: {clip}");
                assert!((-1e-9..=1.0 + 1e-9).contains(&clip.z), "{toward}: {clip}");
                depths.push((corner.dot(toward), clip.z));
            }
            depths.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(depths.windows(2).all(|w| w[0].1 <= w[1].1 + 1e-9), "{toward}: {depths:?}");
        }
    }

    #[test]
    fn casters_outside_of_the_receivers_are_in_front() {
        // A caster high above: its shadow must not be clipped away (hard case 41).
        let (ground, bird) = (bounds([-1.0, 0.0, -1.0], [1.0, 0.0, 1.0]), bounds([0.0, 50.0, 0.0], [0.1, 50.1, 0.1]));
        let view = SunView::fit(&ground, &bird, DVec3::Y, 512);
        let top = view.clip_from_world(DVec3::ZERO) * DVec4::new(0.0, 50.1, 0.0, 1.0);
        assert!((top.z - 1.0).abs() < 1e-9, "{top}");
    }

    #[test]
    fn empty_and_flat_bounds_give_finite_views() {
        let point = bounds([1.0; 3], [1.0; 3]);
        for scene in [Aabb::EMPTY, point] {
            let view = SunView::fit(&scene, &scene, DVec3::Y, 16);
            let clip_from_world = view.clip_from_world(DVec3::ZERO);
            assert!(clip_from_world.is_finite() && view.texel_m > 0.0);
            assert!(clip_from_world.determinant().abs() > 0.0);
        }
    }

    #[test]
    fn the_view_moves_in_whole_texels() {
        let scene = bounds([-5.0, 0.0, -5.0], [5.0, 1.0, 5.0]);
        let toward = DVec3::new(0.4, 0.8, 0.3).normalize();
        let view = |scene: &Aabb| SunView::fit(scene, scene, toward, 256).clip_from_world(DVec3::ZERO);
        let a = view(&scene);
        let shifted = bounds([-4.97, 0.0, -5.0], [5.03, 1.0, 5.0]);
        let b = view(&shifted);
        let p = DVec4::new(1.0, 0.5, 2.0, 1.0);
        let moved = ((a * p) - (b * p)) * 128.0;
        assert!((moved.x - moved.x.round()).abs() < 1e-6 && (moved.y - moved.y.round()).abs() < 1e-6, "{moved}");
    }
}
