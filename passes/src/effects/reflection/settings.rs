//! What reflections are made of, and the same by name. Defaults are Filament's.

use crate::settings::key_value::{KeyValue, OptionError, switched};

/// How rays are followed through what the picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ReflectionSettings {
    /// How far behind its front a surface is still met, in m: what passes farther behind passes.
    pub thickness_m: f32,
    /// Where rays begin, in m along them.
    pub bias_m: f32,
    /// Where they end, in m along them, above 0.
    pub reach_m: f32,
    /// Texels of the structure from step to step, 1 or more: more is faster, and misses what is thinner.
    pub stride_texels: f32,
    /// Perceptual roughness from which on nothing is traced, 0 to 1; it fades from three quarters of it on.
    pub most_roughness: f32,
}

impl Default for ReflectionSettings {
    /// [`ReflectionSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl ReflectionSettings {
    /// Filament's; there the roughness is a constant, √½, at which reflections end at once.
    pub const DEFAULT: Self = Self {
        thickness_m: 0.1,
        bias_m: 0.01,
        reach_m: 3.0,
        stride_texels: 2.0,
        most_roughness: std::f32::consts::FRAC_1_SQRT_2,
    };

    /// The names that [`ReflectionSettings::set`] takes.
    pub const KEYS: [&str; 5] = ["thickness", "bias", "distance", "stride", "roughness"];

    /// What is asked for as `off`, or as `on` with changes: `on:thickness=0.2,distance=5`. None is `off`.
    ///
    /// # Errors
    /// When it is neither, or a choice is unknown or does not take the value: one line that names it and what it takes.
    pub fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        switched(text, Self::DEFAULT, Self::set)
    }

    /// Changes one choice by name.
    ///
    /// # Errors
    /// As [`ReflectionSettings::from_text`].
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
