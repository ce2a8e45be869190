//! Fog: distant surfaces fade into light scattered by the air. A shader feature of surfaces and background, so a frame
//! without fog pays nothing. Filament's model; `docs/design/lens.md` has its error.

mod keys;

use crate::gpu_scene::view::CameraView;
use framegraph_shaders::layout::FogUniforms;
use glam::Vec3;

/// Limit of the density exponent between the fog's height and the eye, in either direction.
const MAX_EXPONENT: f64 = 80.0;

/// Height fog. Defaults are Filament's, except for the color.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct FogSettings {
    /// Extinction at `height_m`, in 1/m, 0 or more; 0 disables fog.
    pub density: f32,
    /// Height at which `density` applies, in meters, world space.
    pub height_m: f32,
    /// Height falloff of density, in 1/m, 0 or more: the inverse of the height over which density falls to 1/e. 0 is
    /// uniform fog.
    pub falloff: f32,
    /// Distance from the eye at which fog begins, in meters, 0 or more.
    pub start_m: f32,
    /// Distance beyond which there is no fog, in meters; the sky is at 1e10 m.
    pub cut_off_m: f32,
    /// Maximum opacity, 0 to 1.
    pub most_opacity: f32,
    /// Ambient in-scattered light.
    pub color: FogColor,
    /// In-scattered sunlight; `None` for none.
    pub glow: Option<FogGlow>,
    /// If fog begins at a distance, averages density over the foggy part of the ray only. Otherwise over the whole ray,
    /// as in Filament.
    pub exact: bool,
}

/// Ambient light that fog scatters, at full opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub enum FogColor {
    /// Constant radiance in nits, linear Rec.709.
    Radiance([f32; 3]),
    /// The environment, blurred as for the roughest surface.
    Environment {
        /// Factor on the radiance, linear Rec.709.
        tint: [f32; 3],
        /// Distance in meters at which the environment is sharper by `sharp_levels`, above 0. It sharpens linearly up
        /// to there.
        sharp_m: f32,
        /// Mip levels of blur removed at that distance, 0 or more. 1 is Filament's `fogColorFromIbl`. With all levels
        /// of the environment, fog at `sharp_m` is the sky itself, as with Filament's `skyColor`.
        #[cfg_attr(feature = "files", serde(default = "one_level"))]
        sharp_levels: f32,
    },
}

/// Sunlight that fog scatters toward the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct FogGlow {
    /// Distance from the eye at which scattering begins, in meters, 0 or more.
    pub start_m: f32,
    /// Exponent of the cosine between ray and sun, above 0; larger values give a smaller glow.
    pub size: f32,
}

/// Default of `sharp_levels` in files.
#[cfg(feature = "files")]
fn one_level() -> f32 {
    1.0
}

impl Default for FogSettings {
    /// Returns [`FogSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FogSettings {
    /// Filament's defaults, with the color of the environment.
    pub const DEFAULT: Self = Self {
        density: 0.1,
        height_m: 0.0,
        falloff: 1.0,
        start_m: 0.0,
        cut_off_m: f32::INFINITY,
        most_opacity: 1.0,
        color: FogColor::Environment { tint: [1.0; 3], sharp_m: 100.0, sharp_levels: 1.0 },
        glow: None,
        exact: true,
    };

    /// Returns true if there is any fog.
    pub fn is_seen(&self) -> bool {
        self.density > 0.0
    }

    /// Returns the uniforms for a view.
    pub(crate) fn uniforms(&self, view: &CameraView) -> FogUniforms {
        let exponent = -f64::from(self.falloff) * (view.eye.y - f64::from(self.height_m));
        let here = f64::from(self.density) * exponent.clamp(-MAX_EXPONENT, MAX_EXPONENT).exp();
        let (color, sharp) = match self.color {
            FogColor::Radiance(nits) => (Vec3::from_array(nits) * view.frame.exposure, None),
            FogColor::Environment { tint, sharp_m, sharp_levels } => {
                (Vec3::from_array(tint), Some((sharp_m, sharp_levels)))
            }
        };
        let flag = |on: bool| f32::from(u8::from(on));
        FogUniforms {
            color,
            // Opaque within a millimeter.
            density: here.min(1e6) as f32,
            falloff: self.falloff,
            start_m: self.start_m,
            cut_off_m: self.cut_off_m.min(f32::MAX),
            most_opacity: self.most_opacity,
            glow_start_m: self.glow.map_or(0.0, |glow| glow.start_m),
            glow_size: self.glow.map_or(1.0, |glow| glow.size),
            glows: flag(self.glow.is_some()),
            exact: flag(self.exact),
            of_environment: flag(sharp.is_some()),
            per_sharp_m: sharp.map_or(0.0, |(sharp_m, _)| sharp_m.max(1e-3).recip()),
            sharp_levels: sharp.map_or(0.0, |(_, levels)| levels.max(0.0)),
            ..FogUniforms::default()
        }
    }
}
