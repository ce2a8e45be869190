//! Settings of screen-space reflections, and their table. Defaults are Filament's, except for the step.

use crate::settings::field::{Field, number};
use crate::settings::place::num;
use crate::settings::table::SettingsTable;

/// Settings of ray tracing in screen space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ReflectionSettings {
    /// Assumed thickness of surfaces in meters; a ray farther behind a surface than this misses it.
    pub thickness_m: f32,
    /// Start of rays along their direction, in meters.
    pub bias_m: f32,
    /// Maximum length of rays in meters, above 0.
    pub reach_m: f32,
    /// Step size in texels of the structure, 1 or more. With 1, rays visit every texel and skip empty blocks. Larger
    /// steps visit no block, and miss thin objects.
    pub stride_texels: f32,
    /// Perceptual roughness at which reflections end, 0 to 1; they fade out from three quarters of it.
    pub most_roughness: f32,
}

impl Default for ReflectionSettings {
    /// Returns [`ReflectionSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl ReflectionSettings {
    /// Filament's defaults, except for its step of 2 texels. Its maximum roughness is a constant, √½, without a fade.
    pub const DEFAULT: Self = Self {
        thickness_m: 0.1,
        bias_m: 0.01,
        reach_m: 3.0,
        stride_texels: 1.0,
        most_roughness: std::f32::consts::FRAC_1_SQRT_2,
    };
}

impl SettingsTable for ReflectionSettings {
    const OPTION: &'static str = "ssr";
    const PATH: &'static str = "settings.reflections";
    const ABOUT: &'static str = "screen-space reflections of the previous frame";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[("on", Self::DEFAULT)];
    const FIELDS: &'static [Field<Self>] = &[
        number("thickness", "thickness_m", [0.0, 1e4], |s: &mut Self| num(&mut s.thickness_m))
            .about("thickness of surfaces"),
        number("bias", "bias_m", [0.0, 100.0], |s: &mut Self| num(&mut s.bias_m))
            .about("start of rays along their direction"),
        number("distance", "reach_m", [1e-3, 1e5], |s: &mut Self| num(&mut s.reach_m)).about("maximum length of rays"),
        number("stride", "stride_texels", [1.0, 64.0], |s: &mut Self| num(&mut s.stride_texels))
            .about("step size; with 1, rays visit every texel and skip empty blocks; larger steps miss thin objects"),
        number("roughness", "most_roughness", [0.0, 1.0], |s: &mut Self| num(&mut s.most_roughness))
            .about("perceptual roughness at which reflections end"),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_describes_the_settings() {
        crate::settings::table::test::<ReflectionSettings>();
        let expected = ReflectionSettings { thickness_m: 0.2, reach_m: 5.0, ..ReflectionSettings::DEFAULT };
        assert_eq!(ReflectionSettings::from_text("on:thickness=0.2,distance=5"), Ok(Some(expected)));
        let error = ReflectionSettings::from_text("on:stride=NaN").expect_err("not a number").to_string();
        assert_eq!(error, "stride=NaN: expected a number from 1 to 64");
    }
}
