//! The camera as a user writes it: `NAME`, `orbit`, or `EX,EY,EZ:TX,TY,TZ:FOVY`.

use std::str::FromStr;

use glam::DVec3;

use super::{Camera, Projection, orbit};
use crate::Scene;
use crate::error::{SceneError, one_line};

/// Which camera a user asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraChoice {
    /// A camera of the scene, by name.
    Named(String),
    /// The whole scene from a friendly side.
    Orbit,
    /// Eye, target and vertical field of view.
    LookAt {
        /// In meters.
        eye: DVec3,
        /// In meters.
        target: DVec3,
        /// Full vertical field of view in degrees, in 0…180 exclusive.
        fov_y_deg: f64,
    },
}

impl FromStr for CameraChoice {
    type Err = SceneError;

    /// A text that holds both `:` and `,` is taken for coordinates, anything else for a name.
    fn from_str(text: &str) -> Result<Self, SceneError> {
        let error = |reason: String| SceneError::Camera { text: one_line(text), reason: one_line(&reason) };
        if text == "orbit" {
            return Ok(Self::Orbit);
        }
        if !(text.contains(':') && text.contains(',')) {
            if text.is_empty() {
                return Err(error("the name is empty".into()));
            }
            return Ok(Self::Named(text.into()));
        }
        let parts: Vec<&str> = text.split(':').collect();
        let &[eye, target, fov] = parts.as_slice() else {
            return Err(error(format!("{} parts between colons, not 3", parts.len())));
        };
        let eye = point(eye).map_err(|reason| error(format!("eye: {reason}")))?;
        let target = point(target).map_err(|reason| error(format!("target: {reason}")))?;
        let fov_y_deg = number(fov).map_err(|reason| error(format!("field of view: {reason}")))?;
        if !(fov_y_deg > 0.0 && fov_y_deg < 180.0) {
            return Err(error("the field of view must lie between 0 and 180 degrees".into()));
        }
        if eye == target {
            return Err(error("eye and target coincide".into()));
        }
        Ok(Self::LookAt { eye, target, fov_y_deg })
    }
}

impl CameraChoice {
    /// The camera itself, for a picture of `width_over_height`.
    ///
    /// # Errors
    ///
    /// When the scene has no camera of the name; the message lists those it has.
    pub fn resolve(&self, scene: &Scene, width_over_height: f64) -> Result<Camera, SceneError> {
        match self {
            Self::Orbit => Ok(orbit(&scene.bounds(), width_over_height)),
            Self::Named(name) => scene
                .cameras
                .iter()
                .find(|camera| camera.name == *name)
                .cloned()
                .ok_or_else(|| SceneError::UnknownCamera { name: one_line(name), known: known_names(scene) }),
            Self::LookAt { eye, target, fov_y_deg } => {
                // Close enough for a desk, far enough for depth: a hundredth of the distance.
                let near_m = (eye.distance(*target) * 0.01).clamp(1e-4, 0.1);
                let projection = Projection::perspective(fov_y_deg.to_radians(), near_m);
                Camera::look_at(*eye, *target, DVec3::Y, projection).map_err(|reason| SceneError::Camera {
                    text: format!("{eye}:{target}:{fov_y_deg}"),
                    reason: reason.into(),
                })
            }
        }
    }
}

fn known_names(scene: &Scene) -> String {
    if scene.cameras.is_empty() {
        return "none".into();
    }
    let names: Vec<&str> = scene.cameras.iter().map(|c| c.name.as_str()).collect();
    one_line(&names.join(", "))
}

fn point(text: &str) -> Result<DVec3, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let &[x, y, z] = parts.as_slice() else {
        return Err(format!("{} coordinates, not 3", parts.len()));
    };
    Ok(DVec3::new(number(x)?, number(y)?, number(z)?))
}

fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| format!("{text:?} is not a number"))?;
    if !value.is_finite() {
        return Err(format!("{text:?} is not finite"));
    }
    Ok(value)
}
