//! From where the frame before was seen, for passes that read its picture.

use super::CameraView;
use framegraph_shaders::layout::Projection;
use glam::{DMat4, DVec3, Mat4};

/// From where a picture was seen, and how it was exposed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Where the eye was, in m, world space.
    pub eye: DVec3,
    /// World, relative to the eye, to clip space.
    pub clip_from_world: DMat4,
    /// 1 / (1.2 · 2^EV100), in 1/nits.
    pub exposure: f32,
}

impl CameraView {
    /// The same view in a frame that follows one with the view `before`: passes that read the earlier picture find places in
    /// it. Without this, the frame before was seen from where this one is, which is so as long as nothing moves.
    #[must_use]
    pub fn after(self, before: &Self) -> Self {
        Self { earlier: Some(before.stand()), ..self }
    }

    fn stand(&self) -> Stand {
        let clip_from_world = self.frame.clip_from_world.as_dmat4();
        Stand { eye: self.eye, clip_from_world, exposure: self.frame.exposure }
    }

    /// From view space to clip space of the frame before, and this frame's exposure over that one's.
    pub(crate) fn earlier_clip_from_view(&self) -> (Mat4, f32) {
        let now = self.stand();
        let Stand { eye, clip_from_world, exposure } = self.earlier.unwrap_or(now);
        // Eyes are subtracted in f64: both may be far from the origin.
        let moved = DMat4::from_translation(now.eye - eye);
        let clip_from_view = clip_from_world * moved * self.frame.world_from_view.as_dmat4();
        (clip_from_view.as_mat4(), now.exposure / exposure)
    }

    /// The projection.
    pub(crate) fn projection(&self) -> Projection {
        let [clip_from_world, world_from_view] =
            [self.frame.clip_from_world, self.frame.world_from_view].map(|m| m.as_dmat4());
        Projection::new(&(clip_from_world * world_from_view))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LightSearch;
    use crate::view::ViewSettings;
    use framegraph_scene::Camera;
    use glam::DVec4;

    /// A place that both see has the clip position that the earlier camera gave it, a thousand kilometers from the origin
    /// too; with no earlier view it is this camera's own.
    #[test]
    fn places_are_found_where_the_earlier_camera_saw_them() -> Result<(), Box<dyn std::error::Error>> {
        let projection = framegraph_scene::Projection::perspective(1.0, 0.1);
        for home in [DVec3::ZERO, DVec3::splat(1e6)] {
            let place = home + DVec3::new(1.5, -0.7, -7.0);
            let seen = |eye: DVec3, ev100| {
                let camera = Camera::look_at(home + eye, home + DVec3::NEG_Z * 4.0, DVec3::Y, projection)?;
                let (size_px, lights) = ([16, 9], LightSearch::default());
                let settings =
                    ViewSettings { camera, size_px, ev100, environment_intensity: 1.0, shadows: None, lights };
                Ok::<_, Box<dyn std::error::Error>>(CameraView::empty(&settings))
            };
            let (before, now) = (seen(DVec3::ZERO, 3.0)?, seen(DVec3::new(1.0, 0.5, 0.2), 4.0)?);
            let ndc = |view: &CameraView, clip_from_view: Mat4| {
                let rotation = view.frame.world_from_view.as_dmat4().transpose();
                let clip = clip_from_view.as_dmat4() * (rotation * (place - view.eye).extend(1.0));
                (clip / clip.w).truncate()
            };
            let truth: DVec4 = before.frame.clip_from_world.as_dmat4() * (place - before.eye).extend(1.0);
            let (alone, same) = now.earlier_clip_from_view();
            assert!((ndc(&now, alone) - truth.truncate() / truth.w).length() > 0.01 && same == 1.0);
            let now = now.after(&before);
            let (matrix, ratio) = now.earlier_clip_from_view();
            let off = (ndc(&now, matrix) - truth.truncate() / truth.w).length();
            // Matrices in f32.
            assert!(off < 1e-5, "{home}: {off}");
            assert!((ratio - 0.5).abs() < 1e-6, "{ratio}");
        }
        Ok(())
    }
}
