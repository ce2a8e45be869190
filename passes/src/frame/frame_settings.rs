//! The whole frame as data: settings with what goes beside them.

use crate::frame::Settings;
use crate::gpu_scene::punctual::{FroxelSettings, LightSearch};
use crate::light::shading::Quality;

/// A frame without its scene and camera.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct FrameSettings {
    /// How fine light from all around is made; `settings.shading` says how it is used.
    pub quality: Quality,
    /// How shading finds the lights that reach a place.
    pub lights: LightSearch,
    /// How far a mesh that has [levels of detail](framegraph_scene::MeshLevel) may be drawn from where it is, in pixels and in texels of
    /// shadow maps; 0 draws all meshes whole.
    pub lod_error_px: f32,
    /// Layers of the scene that are shown, a bit each ([`ViewSettings::visible_layers`](crate::gpu_scene::view::ViewSettings::visible_layers)).
    pub visible_layers: u8,
    /// Post-processing goes into the color pass's shader where that is sound.
    pub inline: bool,
    /// The frame.
    pub settings: Settings,
}

impl Default for FrameSettings {
    /// [`FrameSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FrameSettings {
    /// The default settings, in high quality.
    pub const DEFAULT: Self = Self {
        quality: Quality::High,
        lights: LightSearch::Auto(FroxelSettings::DEFAULT),
        lod_error_px: 0.0,
        visible_layers: framegraph_scene::draw_options::DEFAULT_MASK,
        inline: true,
        settings: Settings::DEFAULT,
    };
}
