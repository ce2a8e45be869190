//! A camera that shows a whole scene from the front right, slightly above.

use glam::DVec3;

use super::definition::{Camera, rotation_towards};
use super::projection::Projection;
use crate::bounds::Aabb;

/// Around the y axis from +z towards +x, in degrees: from the front right.
pub const ORBIT_AZIMUTH_DEG: f64 = 30.0;
/// Above the horizon, in degrees.
pub const ORBIT_ELEVATION_DEG: f64 = 18.0;
/// Vertical field of view in degrees.
const FOV_Y_DEG: f64 = 40.0;
/// Room left around the box, as a share of the distance.
const MARGIN: f64 = 1.06;

/// The three-quarter view from which the eight corners of `bounds` just fit a picture of
/// `width_over_height`, wherever they are and whatever their size. Depends on its arguments alone.
///
/// An empty or single-point box is treated as one of 1 mm half extent, so that the result is always
/// a camera.
#[must_use]
pub fn orbit(bounds: &Aabb, width_over_height: f64) -> Camera {
    let center = bounds.center();
    let half = bounds.half_extent().max(DVec3::splat(1e-3));
    let bounds = Aabb { min: center - half, max: center + half };
    let (azimuth, elevation) = (ORBIT_AZIMUTH_DEG.to_radians(), ORBIT_ELEVATION_DEG.to_radians());
    let toward_eye = DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos());
    let fov_y_rad = FOV_Y_DEG.to_radians();
    let tan_y = (fov_y_rad * 0.5).tan();
    let tan_x = tan_y * width_over_height;

    let mut camera = Camera {
        name: "orbit".into(),
        eye: center,
        world_from_view: rotation_towards(-toward_eye, DVec3::Y),
        projection: Projection::perspective(fov_y_rad, 1.0),
    };
    let view_from_world = camera.world_from_view.inverse();
    // A corner at (x, y, z) from the center, z towards the eye, fits when |x| ≤ (d − z) tan.
    let distance = bounds
        .corners()
        .into_iter()
        .map(|corner| view_from_world * (corner - center))
        .map(|p| p.z + (p.x.abs() / tan_x).max(p.y.abs() / tan_y))
        .fold(0.0, f64::max)
        * MARGIN;
    camera.eye = center + toward_eye * distance;
    camera.projection = Projection::perspective(fov_y_rad, near_for(&bounds, camera.eye));
    camera
}

/// A near plane in meters that cuts nothing of `bounds` seen from `eye` outside, and that is small
/// enough to look around inside.
fn near_for(bounds: &Aabb, eye: DVec3) -> f64 {
    let nearest = eye.clamp(bounds.min, bounds.max).distance(eye);
    (nearest * 0.5).max(bounds.radius() * 1e-3)
}
