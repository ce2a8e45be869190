//! Reversed-Z projections: depth is 1 at the near plane and decreases to 0, which distributes f32 precision evenly over
//! distance.

use glam::dcamera::rh::proj::directx::{orthographic, perspective, perspective_infinite_reverse};
use glam::{DMat4, DVec4};

/// Projection from view space to the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective projection.
    Perspective {
        /// Full vertical field of view in radians, between 0 and π, both excluded.
        fov_y_rad: f64,
        /// Distance of the near plane in meters, above 0.
        near_m: f64,
        /// Distance of the far plane in meters, above `near_m`; `None` for infinity.
        far_m: Option<f64>,
    },
    /// Orthographic (parallel) projection.
    Orthographic {
        /// Half the width of the view volume in meters, above 0; `None` derives it from the height and the aspect
        /// ratio.
        half_width_m: Option<f64>,
        /// Half the height of the view volume in meters, above 0.
        half_height_m: f64,
        /// Distance of the near plane in meters; may be negative.
        near_m: f64,
        /// Distance of the far plane in meters, above `near_m`.
        far_m: f64,
    },
}

impl Projection {
    /// Returns a perspective projection with the far plane at infinity.
    #[must_use]
    pub fn perspective(fov_y_rad: f64, near_m: f64) -> Self {
        Self::Perspective { fov_y_rad, near_m, far_m: None }
    }

    /// Returns the near-plane distance in meters.
    #[must_use]
    pub fn near_m(&self) -> f64 {
        match *self {
            Self::Perspective { near_m, .. } | Self::Orthographic { near_m, .. } => near_m,
        }
    }

    /// Returns the far-plane distance in meters, or `None` for infinity.
    #[must_use]
    pub fn far_m(&self) -> Option<f64> {
        match *self {
            Self::Perspective { far_m, .. } => far_m,
            Self::Orthographic { far_m, .. } => Some(far_m),
        }
    }

    /// Returns this projection adapted to an image of aspect ratio `width_over_height` without stretching. A parallel
    /// projection of another aspect ratio is enlarged in one direction (glTF 2.0, section 3.10.1, forbids stretching).
    #[must_use]
    pub fn unstretched(self, width_over_height: f64) -> Self {
        match self {
            Self::Orthographic { half_width_m: Some(width), half_height_m: height, near_m, far_m } => {
                let (width, height) = (width.max(height * width_over_height), height.max(width / width_over_height));
                Self::Orthographic { half_width_m: Some(width), half_height_m: height, near_m, far_m }
            }
            other => other,
        }
    }

    /// Returns the clip-from-view matrix for an image of aspect ratio `width_over_height`, in wgpu's clip space (y up,
    /// depth 0…1), reversed.
    ///
    /// Finite projections use glam's with near and far exchanged, which reverses depth.
    #[must_use]
    pub fn clip_from_view(&self, width_over_height: f64) -> DMat4 {
        match *self {
            Self::Perspective { fov_y_rad, near_m, far_m: None } => {
                perspective_infinite_reverse(fov_y_rad, width_over_height, near_m)
            }
            Self::Perspective { fov_y_rad, near_m, far_m: Some(far_m) } => {
                perspective(fov_y_rad, width_over_height, far_m, near_m)
            }
            Self::Orthographic { half_width_m, half_height_m, near_m, far_m } => {
                let half_width_m = half_width_m.unwrap_or(half_height_m * width_over_height);
                orthographic(-half_width_m, half_width_m, -half_height_m, half_height_m, far_m, near_m)
            }
        }
    }

    /// Returns the planes of the view volume in view space: left, right, bottom, top, near, and far if it is finite.
    /// Each is (unit normal, offset) with `normal · p + offset ≥ 0` inside.
    ///
    /// Gribb and Hartmann, "Fast Extraction of Viewing Frustum Planes", 2001, for reversed depth 0…1.
    #[must_use]
    pub fn planes(&self, width_over_height: f64) -> Vec<DVec4> {
        let rows = self.clip_from_view(width_over_height).transpose();
        let (x, y, z, w) = (rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis);
        let mut planes = vec![w + x, w - x, w + y, w - y, w - z];
        if self.far_m().is_some() {
            planes.push(z);
        }
        for plane in &mut planes {
            *plane /= plane.truncate().length();
        }
        planes
    }
}
