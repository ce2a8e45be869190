//! Camera definition.

use glam::dcamera::rh::view::look_to_quat;
use glam::{DMat4, DQuat, DVec3};

use super::projection::Projection;
use crate::error::LookAtError;

/// Camera of a scene. View space is right-handed: x right, y up, looking along −z.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name for selection by users; may be empty.
    pub name: String,
    /// Position, in meters.
    pub eye: DVec3,
    /// Unit quaternion that rotates view axes to world axes.
    pub world_from_view: DQuat,
    /// Projection, with near and far plane.
    pub projection: Projection,
}

/// A camera 5 m from the origin on +Z that looks along −Z, with a vertical field of view of 45°.
impl Default for Camera {
    fn default() -> Self {
        let fov_y_rad = std::f64::consts::FRAC_PI_4;
        Self {
            name: String::new(),
            eye: DVec3::new(0.0, 0.0, 5.0),
            world_from_view: DQuat::IDENTITY,
            projection: Projection::Perspective { fov_y_rad, near_m: 0.1, far_m: None },
        }
    }
}

impl Camera {
    /// Returns a camera at `eye` with `target` in the image center and `up` pointing up.
    ///
    /// `up` may have any length. If it is nearly parallel to the view direction, which leaves the roll undefined, −z
    /// replaces it, or +x if −z is parallel too.
    ///
    /// # Errors
    ///
    /// Fails if a coordinate is not finite, or if eye and target coincide.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, projection: Projection) -> Result<Self, LookAtError> {
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(LookAtError::NotFinite);
        }
        let forward = (target - eye).try_normalize().ok_or(LookAtError::Coincide)?;
        Ok(Self { name: String::new(), eye, world_from_view: rotation_towards(forward, up), projection })
    }

    /// Returns the camera of a glTF node: at the node's origin, looking along its −z with +y up. The node's scale is
    /// ignored (glTF 2.0, section 3.10). Returns `None` if the node's z axis has zero length.
    #[must_use]
    pub fn of_node(name: &str, world_from_node: &DMat4, projection: Projection) -> Option<Self> {
        let axis = |v: DVec3| {
            let largest = v.abs().max_element();
            (largest > 0.0 && largest.is_finite()).then(|| v / largest)
        };
        let backward = axis(world_from_node.z_axis.truncate())?.try_normalize()?;
        let up = axis(world_from_node.y_axis.truncate()).unwrap_or(DVec3::Y);
        Some(Self {
            name: name.into(),
            eye: world_from_node.w_axis.truncate(),
            world_from_view: rotation_towards(-backward, up),
            projection,
        })
    }

    /// Returns the unit view direction.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        self.world_from_view * DVec3::NEG_Z
    }

    /// Returns the transform from world to view space.
    #[must_use]
    pub fn view_from_world(&self) -> DMat4 {
        DMat4::from_quat(self.world_from_view.inverse()) * DMat4::from_translation(-self.eye)
    }

    /// Returns the clip-from-view matrix for an image of aspect ratio `width_over_height`. Reversed Z: depth is 1 at
    /// the near plane and 0 at the far plane; y up.
    #[must_use]
    pub fn clip_from_view(&self, width_over_height: f64) -> DMat4 {
        self.projection.clip_from_view(width_over_height)
    }
}

/// Returns the rotation whose −z is the unit vector `forward`, as upright as `up` allows.
pub(super) fn rotation_towards(forward: DVec3, up: DVec3) -> DQuat {
    let upright = [up, DVec3::NEG_Z, DVec3::X]
        .into_iter()
        .filter_map(DVec3::try_normalize)
        // The length of the cross product is the sine of the angle; below 0.001 it is mostly rounding error.
        .find(|u| forward.cross(*u).length() > 1e-3)
        .unwrap_or(DVec3::Y);
    look_to_quat(forward, upright).inverse()
}
