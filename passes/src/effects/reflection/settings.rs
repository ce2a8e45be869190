//! Settings of screen-space reflections, and option parsing. Defaults are Filament's, except for the step.

use crate::settings::key_value::{KeyValue, OptionError, switched};

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

    /// Names accepted by [`ReflectionSettings::set`].
    pub const KEYS: [&str; 5] = ["thickness", "bias", "distance", "stride", "roughness"];

    /// Parses `off`, or `on` with changes such as `on:thickness=0.2,distance=5`. Returns `None` for `off`.
    ///
    /// # Errors
    /// Fails for another word, an unknown name or an invalid value; the message names it and the accepted values.
    pub fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        switched(text, Self::DEFAULT, Self::set)
    }

    /// Changes one setting by name.
    ///
    /// # Errors
    /// Fails as [`ReflectionSettings::from_text`] does.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        match key {
            "thickness" => self.thickness_m = choice.number(0.0, 1e4)?,
            "bias" => self.bias_m = choice.number(0.0, 100.0)?,
            "distance" => self.reach_m = choice.number(1e-3, 1e5)?,
            "stride" => self.stride_texels = choice.number(1.0, 64.0)?,
            "roughness" => self.most_roughness = choice.number(0.0, 1.0)?,
            _ => return Err(choice.unknown(&Self::KEYS)),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_made_by_name() -> Result<(), OptionError> {
        assert_eq!(ReflectionSettings::from_text("off")?, None);
        assert_eq!(ReflectionSettings::from_text("on")?, Some(ReflectionSettings::DEFAULT));
        let own = "on:thickness=0.2,bias=0,distance=5,stride=4,roughness=0.5";
        let expected =
            ReflectionSettings { thickness_m: 0.2, bias_m: 0.0, reach_m: 5.0, stride_texels: 4.0, most_roughness: 0.5 };
        assert_eq!(ReflectionSettings::from_text(own)?, Some(expected));
        assert!(ReflectionSettings::KEYS.iter().all(|key| own.contains(&format!("{key}="))));
        Ok(())
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        for (text, named) in [
            ("yes", "yes: "),
            ("on:gloss=1", "gloss"),
            ("on:thickness=-1", "thickness=-1"),
            ("on:distance=0", "distance=0"),
            ("on:stride=NaN", "stride=NaN"),
            ("on:stride", "stride="),
            ("on:roughness=2", "roughness=2"),
        ] {
            let told = ReflectionSettings::from_text(text).expect_err("that is no choice").to_string();
            assert!(told.contains(named) && !told.contains('\n'), "{text}: {told}");
        }
    }
}
