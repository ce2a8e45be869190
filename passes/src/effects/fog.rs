//! Fog: what is far away fades into the light that the air scatters. A feature of the shaders of surfaces and sky, so a frame
//! without fog has nothing of it. Filament's model; `docs/design/lens.md` has how far off it is.

mod keys;

use crate::gpu_scene::view::CameraView;
use framegraph_shaders::layout::FogUniforms;
use glam::Vec3;

/// Exponent of density between the fog's height and the eye that is followed, either way.
const MAX_EXPONENT: f64 = 80.0;

/// Fog that lies about a height. Defaults are Filament's, but for the color.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct FogSettings {
    /// Extinction at the height, in 1/m, 0 or more; 0 leaves fog out.
    pub density: f32,
    /// The height that the density is that of, in m, world space.
    pub height_m: f32,
    /// How fast density falls with height, in 1/m, 0 or more: one over the height over which it falls to 1/e. 0: it is the
    /// same everywhere.
    pub falloff: f32,
    /// The first meters from the eye that are clear, 0 or more.
    pub start_m: f32,
    /// What is farther from the eye than this, in m, is not in fog; the sky is 1e10 m away.
    pub cut_off_m: f32,
    /// The most that fog hides, 0 to 1.
    pub most_opacity: f32,
    /// What it scatters from all around.
    pub color: FogColor,
    /// What it scatters of the sun; none for nothing.
    pub glow: Option<FogGlow>,
    /// Where there is a clear start, the mean density is that of what is not clear; else it is that of the whole way, as in
    /// Filament.
    pub exact: bool,
}

/// What fog scatters from all around, at full opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub enum FogColor {
    /// Radiance in nits, linear Rec.709.
    Radiance([f32; 3]),
    /// The environment's, blurred as for the roughest surface.
    Environment {
        /// Factor on it, linear Rec.709.
        tint: [f32; 3],
        /// Distance in m from which on it is sharper by `sharp_levels`, above 0. Before, it gets sharper in proportion.
        sharp_m: f32,
        /// Levels of blur that the distance removes, 0 or more. One is Filament's `fogColorFromIbl`. With as many as the
        /// environment has, fog at `sharp_m` is the sky itself, as of a `skyColor` in Filament.
        #[cfg_attr(feature = "files", serde(default = "one_level"))]
        sharp_levels: f32,
    },
}

/// What fog scatters of the sun toward the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct FogGlow {
    /// Where scattering begins, in m from the eye, 0 or more.
    pub start_m: f32,
    /// Exponent of the cosine between the ray and the sun, above 0: more is a smaller glow.
    pub size: f32,
}

/// The levels that files leave out.
#[cfg(feature = "files")]
fn one_level() -> f32 {
    1.0
}

impl Default for FogSettings {
    /// [`FogSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FogSettings {
    /// Filament's fog, in the color of the environment.
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

    /// Whether there is any fog.
    pub fn is_seen(&self) -> bool {
        self.density > 0.0
    }

    /// As the shaders of a view read it.
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
            // So dense that nothing is seen through a millimeter.
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
