//! Camera of the previous frame, for passes that read its picture.

use framegraph_shaders::layout::Projection;
use glam::{DMat4, DVec3, Mat4};

/// Camera and exposure of a rendered picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviousView {
    /// Position of the eye in m, world space.
    pub eye: DVec3,
    /// Clip space from world space relative to the eye, with jitter.
    pub clip_from_world: DMat4,
    /// Clip space from world space relative to the eye, without jitter
    /// ([`CameraView::jitter`](crate::CameraView::jitter)).
    pub steady_clip_from_world: DMat4,
    /// World space from view space: a rotation.
    pub world_from_view: DMat4,
    /// Exposure: 1 / (1.2 · 2^EV100), in 1/nits.
    pub exposure: f32,
}

impl PreviousView {
    /// Returns the projection.
    pub fn projection(&self) -> Projection {
        Projection::new(&(self.clip_from_world * self.world_from_view))
    }

    /// Returns the previous clip space from this view space, and the ratio of this exposure to the previous one.
    /// `None` stands for an unchanged view.
    pub fn to_earlier(&self, earlier: Option<Self>) -> (Mat4, f32) {
        let Self { eye, clip_from_world, exposure, .. } = earlier.unwrap_or(*self);
        // Eyes are subtracted in f64, since both may be far from the origin.
        let moved = DMat4::from_translation(self.eye - eye);
        ((clip_from_world * moved * self.world_from_view).as_mat4(), self.exposure / exposure)
    }

    /// Returns the previous clip space from this clip space, both without jitter.
    pub fn steady_clip_to_earlier(&self, earlier: Option<Self>) -> Mat4 {
        let Self { eye, steady_clip_from_world, .. } = earlier.unwrap_or(*self);
        let moved = DMat4::from_translation(self.eye - eye);
        (steady_clip_from_world * moved * self.steady_clip_from_world.inverse()).as_mat4()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CameraView, LightSearch, ViewSettings};
    use framegraph_scene::Camera;
    use glam::DVec4;

    /// A point visible to both cameras gets the clip position of the previous one, even 1000 km from the origin.
    /// Without a previous view, it gets the current one.
    #[test]
    fn places_are_found_where_the_earlier_camera_saw_them() -> Result<(), Box<dyn std::error::Error>> {
        let projection = framegraph_scene::Projection::perspective(1.0, 0.1);
        for home in [DVec3::ZERO, DVec3::splat(1e6)] {
            let place = home + DVec3::new(1.5, -0.7, -7.0);
            let seen = |eye: DVec3, ev100| {
                let camera = Camera::look_at(home + eye, home + DVec3::NEG_Z * 4.0, DVec3::Y, projection)?;
                let (size_px, lights) = ([16, 9], LightSearch::default());
                let settings =
                    ViewSettings { camera, size_px, ev100, shadows: None, lights, ..ViewSettings::default() };
                Ok::<_, Box<dyn std::error::Error>>(CameraView::empty(&settings))
            };
            let (before, now) = (seen(DVec3::ZERO, 3.0)?, seen(DVec3::new(1.0, 0.5, 0.2), 4.0)?);
            let ndc = |view: &CameraView, clip_from_view: Mat4| {
                let rotation = view.frame.world_from_view.as_dmat4().transpose();
                let clip = clip_from_view.as_dmat4() * (rotation * (place - view.eye).extend(1.0));
                (clip / clip.w).truncate()
            };
            let truth: DVec4 = before.frame.clip_from_world.as_dmat4() * (place - before.eye).extend(1.0);
            let (alone, same) = now.stand().to_earlier(now.earlier);
            assert!((ndc(&now, alone) - truth.truncate() / truth.w).length() > 0.01 && same == 1.0);
            let now = now.after(&before);
            let (matrix, ratio) = now.stand().to_earlier(now.earlier);
            let off = (ndc(&now, matrix) - truth.truncate() / truth.w).length();
            // Matrices are in f32.
            assert!(off < 1e-5, "{home}: {off}");
            assert!((ratio - 0.5).abs() < 1e-6, "{ratio}");
        }
        Ok(())
    }
}
