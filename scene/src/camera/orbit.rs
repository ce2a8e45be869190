//! Orbit camera: shows a whole scene from the front right, slightly above.

use glam::DVec3;

use super::definition::{Camera, rotation_towards};
use super::projection::Projection;
use crate::bounds::Aabb;

/// Azimuth in degrees, around the y axis from +z toward +x: from the front right.
pub const ORBIT_AZIMUTH_DEG: f64 = 30.0;
/// Elevation above the horizon, in degrees.
pub const ORBIT_ELEVATION_DEG: f64 = 18.0;
/// Vertical field of view in degrees.
const FOV_Y_DEG: f64 = 40.0;
/// Margin around the box, as a factor on the distance.
const MARGIN: f64 = 1.06;

/// Returns the three-quarter view in which the eight corners of `bounds` just fit an image of aspect ratio
/// `width_over_height`. Independent of the position and scale of the bounds, and deterministic.
///
/// An empty or single-point box is treated as a box of 1 mm half extent, so that a camera always exists.
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
    // A corner at (x, y, z) from the center, z toward the eye, is visible if |x| ≤ (d − z) tan.
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

/// Returns a near-plane distance in meters that clips nothing of `bounds` seen from an `eye` outside, and is small
/// enough for moving inside.
fn near_for(bounds: &Aabb, eye: DVec3) -> f64 {
    let nearest = eye.clamp(bounds.min, bounds.max).distance(eye);
    (nearest * 0.5).max(bounds.radius() * 1e-3)
}
