//! What a camera is.

use glam::dcamera::rh::view::look_to_quat;
use glam::{DMat4, DQuat, DVec3};

use super::projection::Projection;
use crate::error::LookAtError;

/// A camera of the scene. View space is right-handed: x right, y up, looking along −z.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name, by which users choose it; may be empty.
    pub name: String,
    /// Position, in meters.
    pub eye: DVec3,
    /// Unit quaternion that turns view axes into world axes.
    pub world_from_view: DQuat,
    /// Projection, with near and far plane.
    pub projection: Projection,
}

impl Camera {
    /// A camera at `eye` that sees `target` in the middle with `up` pointing up.
    ///
    /// `up` may have any length. When it is (nearly) parallel to the view, which leaves the roll
    /// undefined, −z takes its place, or +x if that is parallel too.
    ///
    /// # Errors
    ///
    /// A sentence when a coordinate is not finite, or eye and target coincide.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, projection: Projection) -> Result<Self, LookAtError> {
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(LookAtError::NotFinite);
        }
        let forward = (target - eye).try_normalize().ok_or(LookAtError::Coincide)?;
        Ok(Self { name: String::new(), eye, world_from_view: rotation_towards(forward, up), projection })
    }

    /// A camera in a node's frame: at its origin, looking along its −z with +y up, whatever its
    /// scale (glTF 2.0, section 3.10). `None` when the node's z axis has no length.
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

    /// The unit direction in which the camera looks.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        self.world_from_view * DVec3::NEG_Z
    }

    /// World to view, in f64.
    #[must_use]
    pub fn view_from_world(&self) -> DMat4 {
        DMat4::from_quat(self.world_from_view.inverse()) * DMat4::from_translation(-self.eye)
    }

    /// Clip from view for a picture of `width_over_height`: reversed Z, depth 1 at the near plane
    /// and 0 far away, y up.
    #[must_use]
    pub fn clip_from_view(&self, width_over_height: f64) -> DMat4 {
        self.projection.clip_from_view(width_over_height)
    }
}

/// The rotation whose −z is the unit vector `forward`, as upright as `up` allows.
pub(super) fn rotation_towards(forward: DVec3, up: DVec3) -> DQuat {
    let upright = [up, DVec3::NEG_Z, DVec3::X]
        .into_iter()
        .filter_map(DVec3::try_normalize)
        // The sine of the angle between: below a thousandth the cross product is mostly rounding.
        .find(|u| forward.cross(*u).length() > 1e-3)
        .unwrap_or(DVec3::Y);
    look_to_quat(forward, upright).inverse()
}
