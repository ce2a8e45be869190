//! Fog: distant surfaces fade into light scattered by the air. A shader feature of surfaces and background, so a frame
//! without fog pays nothing. Filament's model; `docs/design/lens.md` has its error.

use crate::gpu_scene::view::CameraView;
use crate::settings::field::{Field, choice, number, text};
use crate::settings::place::{Place, num, parsed};
use crate::settings::table::SettingsTable;
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

/// Range of radiance in nits.
const NITS: [f64; 2] = [0.0, 1e6];
/// Range of exponents of the glow.
const GLOW_SIZE: [f64; 2] = [1e-2, 1e4];

impl SettingsTable for FogSettings {
    const OPTION: &'static str = "fog";
    const PATH: &'static str = "settings.fog";
    const ABOUT: &'static str = "height fog";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[("on", Self::DEFAULT)];
    const FIELDS: &'static [Field<Self>] = &[
        number("density", "density", [0.0, 1e3], |s: &mut Self| num(&mut s.density))
            .about("extinction at the height, in 1/m"),
        number("height", "height_m", [-1e6, 1e6], |s: &mut Self| num(&mut s.height_m))
            .about("height of the density, world space"),
        number("falloff", "falloff", [0.0, 1e3], |s: &mut Self| num(&mut s.falloff))
            .about("height falloff of density, in 1/m; 0 is uniform fog"),
        number("start", "start_m", [0.0, 1e9], |s: &mut Self| num(&mut s.start_m))
            .about("distance from the eye where fog begins"),
        number("cut-off", "cut_off_m", [0.0, f64::INFINITY], |s: &mut Self| num(&mut s.cut_off_m))
            .about("distance beyond which there is no fog; the sky is at 1e10 m"),
        number("opacity", "most_opacity", [0.0, 1.0], |s: &mut Self| num(&mut s.most_opacity)).about("maximum opacity"),
        text(
            "color",
            "color",
            "`environment`, or R:G:B from 0 to 1000000",
            &["environment", "2000:2500:3000"],
            set_color,
        )
        .about("scattered light: radiance in nits, or the blurred environment")
        .with(NITS, |s: &mut Self| match &mut s.color {
            FogColor::Radiance(nits) => Place::Numbers(nits),
            FogColor::Environment { .. } => Place::Free,
        }),
        number("tint", "color.tint", [0.0, 1e3], |s: &mut Self| environment(s, |(tint, ..)| Place::Numbers(tint)))
            .about("factor on the radiance of the environment"),
        number("sharp", "color.sharp_m", [1e-3, 1e9], |s: &mut Self| environment(s, |(_, sharp_m, _)| num(sharp_m)))
            .about("distance at which the environment is sharper by the sharp levels"),
        number("sharp-levels", "color.sharp_levels", [0.0, 16.0], |s: &mut Self| {
            environment(s, |(.., levels)| num(levels))
        })
        .about("mip levels of blur removed at that distance"),
        text("glow", "glow", "`off` or a number from 0.01 to 10000", &["off", "20"], set_glow)
            .about("scattered sunlight: exponent of the cosine between ray and sun; more is smaller"),
        number("glow-size", "glow.size", GLOW_SIZE, |s: &mut Self| glow(s, |g| num(&mut g.size)))
            .about("exponent of the glow alone"),
        number("glow-start", "glow.start_m", [0.0, 1e9], |s: &mut Self| glow(s, |g| num(&mut g.start_m)))
            .about("distance from the eye where scattering of sunlight begins"),
        choice("mean", "exact", |s: &mut Self| Place::Switch(&mut s.exact, ["filament", "exact"]))
            .about("averages density over the foggy part of the ray (`exact`), or over the whole ray"),
    ];
}

fn environment(
    s: &mut FogSettings,
    place: for<'a> fn((&'a mut [f32; 3], &'a mut f32, &'a mut f32)) -> Place<'a>,
) -> Place<'_> {
    match &mut s.color {
        FogColor::Environment { tint, sharp_m, sharp_levels } => place((tint, sharp_m, sharp_levels)),
        FogColor::Radiance(_) => Place::Only("color=environment"),
    }
}

fn glow(s: &mut FogSettings, place: fn(&mut FogGlow) -> Place<'_>) -> Place<'_> {
    s.glow.as_mut().map_or(Place::Only("glow=SIZE"), place)
}

fn set_color(s: &mut FogSettings, text: &str) -> Option<()> {
    s.color = match text {
        "environment" => FogSettings::DEFAULT.color,
        _ => {
            let mut nits = [0.0; 3];
            Place::Numbers(&mut nits).put(text, NITS)?;
            FogColor::Radiance(nits)
        }
    };
    Some(())
}

fn set_glow(s: &mut FogSettings, text: &str) -> Option<()> {
    let start_m = s.glow.map_or(0.0, |glow| glow.start_m);
    s.glow = match text {
        "off" => None,
        _ => Some(FogGlow { size: parsed(text, GLOW_SIZE, false)? as f32, start_m }),
    };
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_describes_the_settings() {
        crate::settings::table::test::<FogSettings>();
    }

    #[test]
    fn fields_are_set_by_name() {
        let air = FogSettings::from_text("on:cut-off=inf,mean=filament,tint=1:0.5:1,sharp=7,sharp-levels=3");
        let color = FogColor::Environment { tint: [1.0, 0.5, 1.0], sharp_m: 7.0, sharp_levels: 3.0 };
        assert_eq!(air, Ok(Some(FogSettings { color, exact: false, ..FogSettings::DEFAULT })));
        let sun = FogSettings::from_text("on:glow=8,glow-start=2,color=1:2:3");
        let (color, glow) = (FogColor::Radiance([1.0, 2.0, 3.0]), Some(FogGlow { start_m: 2.0, size: 8.0 }));
        assert_eq!(sun, Ok(Some(FogSettings { color, glow, ..FogSettings::DEFAULT })));
        for (text, named) in [
            ("haze", "haze: unknown"),
            ("on:cut-off=NaN", "cut-off=NaN"),
            ("on:color=1:2", "color=1:2: expected `environment`, or R:G:B"),
            ("on:color=1:1:1,tint=1:1:1", "tint: only `color=environment`"),
            ("on:glow-start=1", "glow-start: only `glow=SIZE`"),
            ("on:glow=0", "glow=0"),
            ("on:mean=middle", "mean=middle: expected `exact` or `filament`"),
        ] {
            let error = FogSettings::from_text(text).expect_err(text).to_string();
            assert!(error.contains(named) && !error.contains('\n'), "{text}: {error}");
        }
    }
}
