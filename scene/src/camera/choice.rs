//! Camera choice as a user writes it: `NAME`, `orbit`, or `EX,EY,EZ:TX,TY,TZ:FOVY`.

use std::str::FromStr;

use glam::DVec3;

use super::definition::Camera;
use super::orbit::orbit;
use super::projection::Projection;
use crate::error::{CameraTextError, LookAtError, SceneError, one_line};
use crate::scene::Scene;

/// Selection of a camera by a user.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraChoice {
    /// Camera of the scene with this name.
    Named(String),
    /// [`orbit`]: shows the whole scene from the front right, slightly above.
    Orbit,
    /// Eye, target and vertical field of view.
    LookAt {
        /// Position of the camera, in meters.
        eye: DVec3,
        /// Point in the center of the image, in meters.
        target: DVec3,
        /// Full vertical field of view in degrees, between 0 and 180, both excluded.
        fov_y_deg: f64,
    },
}

impl FromStr for CameraChoice {
    type Err = SceneError;

    /// Parses a choice. Text with both `:` and `,` is read as coordinates, other text as a name.
    fn from_str(text: &str) -> Result<Self, SceneError> {
        let error = |reason| SceneError::Camera { text: text.into(), reason };
        if text == "orbit" {
            return Ok(Self::Orbit);
        }
        if !(text.contains(':') && text.contains(',')) {
            if text.is_empty() {
                return Err(error(CameraTextError::EmptyName));
            }
            return Ok(Self::Named(text.into()));
        }
        let parts: Vec<&str> = text.split(':').collect();
        let &[eye, target, fov] = parts.as_slice() else {
            return Err(error(CameraTextError::Parts { found: parts.len() }));
        };
        let eye = point("eye", eye).map_err(error)?;
        let target = point("target", target).map_err(error)?;
        let fov_y_deg = number("field of view", fov).map_err(error)?;
        if !(fov_y_deg > 0.0 && fov_y_deg < 180.0) {
            return Err(error(CameraTextError::FieldOfView));
        }
        if eye == target {
            return Err(error(LookAtError::Coincide.into()));
        }
        Ok(Self::LookAt { eye, target, fov_y_deg })
    }
}

impl CameraChoice {
    /// Returns the camera for an image of aspect ratio `width_over_height`.
    ///
    /// # Errors
    ///
    /// Fails if the scene has no camera of this name; the message lists its cameras.
    pub fn resolve(&self, scene: &Scene, width_over_height: f64) -> Result<Camera, SceneError> {
        match self {
            Self::Orbit => Ok(orbit(&scene.bounds_above_ground(), width_over_height)),
            Self::Named(name) => scene.cameras.iter().find(|camera| camera.name == *name).cloned().ok_or_else(|| {
                SceneError::UnknownCamera {
                    name: name.clone(),
                    known: scene.cameras.iter().map(|camera| camera.name.clone()).collect(),
                }
            }),
            Self::LookAt { eye, target, fov_y_deg } => {
                // A hundredth of the distance: suits desktop-sized scenes and keeps depth precision in large ones.
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

fn point(part: &'static str, text: &str) -> Result<DVec3, CameraTextError> {
    let parts: Vec<&str> = text.split(',').collect();
    let &[x, y, z] = parts.as_slice() else {
        return Err(CameraTextError::Coordinates { part, found: parts.len() });
    };
    Ok(DVec3::new(number(part, x)?, number(part, y)?, number(part, z)?))
}

fn number(part: &'static str, text: &str) -> Result<f64, CameraTextError> {
    let value = text.trim().parse().map_err(|_| CameraTextError::Number { part, text: one_line(text) })?;
    if f64::is_finite(value) { Ok(value) } else { Err(CameraTextError::NotFinite { part, text: one_line(text) }) }
}
