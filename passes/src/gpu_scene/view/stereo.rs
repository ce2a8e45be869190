//! Stereo views: two eyes that share culling, levels of detail, lights and shadow maps.

use super::{Background, CameraView, ViewSettings, aspect, eye_or_direction};
use crate::gpu_scene::prepared::PreparedScene;
use crate::gpu_scene::punctual::LightSearch;
use crate::light::ibl::ImageLight;
use framegraph_scene::{Projection, Scene};
use framegraph_shaders::layout::EyeUniforms;
use glam::{DMat4, DVec3};

impl CameraView {
    /// Returns a view for two eyes `separation_m` apart, on both sides of the camera. Both look in its direction, with its
    /// projection. [`Settings::for_stereo`](crate::Settings::for_stereo) and
    /// [`Handles::stereo`](crate::Handles::stereo) draw both with one pass each.
    ///
    /// Instances are culled, and shadow maps fitted, once for both: for a camera behind the eyes whose frustum contains
    /// those of the eyes. Every light is evaluated everywhere, because light lists belong to the pixels of one camera.
    pub fn stereo(
        scene: &Scene,
        prepared: &PreparedScene,
        light: &ImageLight,
        background: &Background,
        settings: &ViewSettings,
        separation_m: f64,
    ) -> Self {
        let half_m = 0.5 * separation_m.abs();
        let mut both = ViewSettings { lights: LightSearch::All, ..settings.clone() };
        let mut behind_m = 0.0;
        match &mut both.camera.projection {
            Projection::Perspective { fov_y_rad, far_m, .. } => {
                behind_m = half_m / ((0.5 * *fov_y_rad).tan() * aspect(settings));
                *far_m = far_m.map(|far_m| far_m + behind_m);
            }
            Projection::Orthographic { half_width_m, half_height_m, .. } => {
                *half_width_m = Some(half_width_m.unwrap_or(*half_height_m * aspect(settings)) + half_m);
            }
        }
        both.camera.eye += settings.camera.world_from_view * DVec3::Z * behind_m;
        let eye = |side: f64| {
            let place = settings.camera.world_from_view * DVec3::new(side * half_m, 0.0, -behind_m);
            let from_origin = DMat4::from_translation(-place);
            let turned = DMat4::from_quat(settings.camera.world_from_view.inverse()) * from_origin;
            let viewer = eye_or_direction(&settings.camera);
            EyeUniforms {
                clip_from_world: (settings.camera.clip_from_view(aspect(settings)) * turned).as_mat4(),
                camera: viewer + (viewer.w * place.as_vec3()).extend(0.0),
            }
        };
        Self { eyes: Some([eye(-1.0), eye(1.0)]), ..Self::prepared(scene, prepared, light, background, &both) }
    }
}
