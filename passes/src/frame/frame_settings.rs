//! Complete frame as data: [`Settings`] with quality, light search and layers.

use crate::frame::Settings;
use crate::gpu_scene::punctual::{FroxelSettings, LightSearch};
use crate::light::shading::Quality;

/// Settings of a frame, without scene and camera.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct FrameSettings {
    /// Quality of image-based light; `settings.shading` controls how it is used.
    pub quality: Quality,
    /// Method of finding the lights that reach a point.
    pub lights: LightSearch,
    /// Maximum geometric error of [levels of detail](framegraph_scene::MeshLevel), in pixels and in shadow-map texels.
    /// 0 draws full meshes.
    pub lod_error_px: f32,
    /// Visible layers of the scene as a bit mask
    /// ([`ViewSettings::visible_layers`](crate::gpu_scene::view::ViewSettings::visible_layers)).
    pub visible_layers: u8,
    /// Inlines post-processing into the shader of the color pass where the result is correct.
    pub inline: bool,
    /// Settings of the standard frame.
    pub settings: Settings,
}

impl Default for FrameSettings {
    /// Returns [`FrameSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FrameSettings {
    /// Default settings at high quality.
    pub const DEFAULT: Self = Self {
        quality: Quality::High,
        lights: LightSearch::Auto(FroxelSettings::DEFAULT),
        lod_error_px: 0.0,
        visible_layers: framegraph_scene::draw_options::DEFAULT_MASK,
        inline: true,
        settings: Settings::DEFAULT,
    };
}
