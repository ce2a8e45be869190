//! Cameras of the built-in scenes.

use glam::DVec3;

use crate::camera::{Camera, Projection};

/// Returns an upright camera of a built-in scene, with the far plane at infinity.
pub(super) fn camera(name: &str, eye: DVec3, target: DVec3, fov_y_deg: f64) -> Camera {
    let projection = Projection::perspective(fov_y_deg.to_radians(), 0.05);
    let mut camera =
        Camera::look_at(eye, target, DVec3::Y, projection).expect("the cameras of built-in scenes look somewhere");
    camera.name = name.into();
    camera
}
