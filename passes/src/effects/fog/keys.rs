//! Option parsing of fog.

use super::{FogColor, FogGlow, FogSettings};
use crate::settings::key_value::{KeyValue, OptionError, switched};

impl FogSettings {
    /// Names accepted by [`FogSettings::set`].
    pub const KEYS: [&str; 13] = [
        "density",
        "height",
        "falloff",
        "start",
        "cut-off",
        "opacity",
        "color",
        "tint",
        "sharp",
        "sharp-levels",
        "glow",
        "glow-start",
        "mean",
    ];

    /// Parses `off`, or `on` with changes such as `on:density=0.05,color=400:450:500`. Returns `None` for `off`.
    ///
    /// # Errors
    /// Fails for another word, an unknown name or an invalid value; the message names it and the accepted values.
    pub fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        switched(text, Self::DEFAULT, Self::set)
    }

    /// Changes one setting by name.
    ///
    /// # Errors
    /// Fails as [`FogSettings::from_text`] does.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        match key {
            "density" => self.density = choice.number(0.0, 1e3)?,
            "height" => self.height_m = choice.number(-1e6, 1e6)?,
            "falloff" => self.falloff = choice.number(0.0, 1e3)?,
            "start" => self.start_m = choice.number(0.0, 1e9)?,
            "cut-off" => self.cut_off_m = choice.number(0.0, f32::INFINITY)?,
            "opacity" => self.most_opacity = choice.number(0.0, 1.0)?,
            "color" if value == "environment" => self.color = Self::DEFAULT.color,
            "color" => self.color = FogColor::Radiance(choice.numbers(0.0, 1e6)?),
            "tint" | "sharp" | "sharp-levels" => match &mut self.color {
                FogColor::Environment { tint, .. } if key == "tint" => *tint = choice.numbers(0.0, 1e3)?,
                FogColor::Environment { sharp_levels, .. } if key == "sharp-levels" => {
                    *sharp_levels = choice.number(0.0, 16.0)?;
                }
                FogColor::Environment { sharp_m, .. } => *sharp_m = choice.number(1e-3, 1e9)?,
                FogColor::Radiance(_) => return Err(choice.only("color=environment")),
            },
            "glow" if value == "off" => self.glow = None,
            "glow" => {
                let size = choice.number(1e-2, 1e4)?;
                self.glow = Some(FogGlow { size, start_m: self.glow.map_or(0.0, |glow| glow.start_m) });
            }
            "glow-start" => match &mut self.glow {
                Some(glow) => glow.start_m = choice.number(0.0, 1e9)?,
                None => return Err(choice.only("glow=SIZE")),
            },
            "mean" => {
                self.exact = match value {
                    "exact" => true,
                    "filament" => false,
                    _ => return Err(choice.wrong("`exact` or `filament`")),
                }
            }
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
        assert_eq!(FogSettings::from_text("off")?, None);
        assert_eq!(FogSettings::from_text("on")?, Some(FogSettings::DEFAULT));
        let air = "on:density=0.2,height=3,falloff=0.5,start=1,cut-off=inf,opacity=0.9,mean=filament,tint=1:0.5:1,sharp=7,sharp-levels=3";
        let sun = "on:glow=8,glow-start=2,color=1:2:3";
        let found = FogSettings::from_text(air)?.expect("it is on");
        assert_eq!(found.color, FogColor::Environment { tint: [1.0, 0.5, 1.0], sharp_m: 7.0, sharp_levels: 3.0 });
        assert_eq!((found.density, found.height_m, found.falloff, found.start_m), (0.2, 3.0, 0.5, 1.0));
        assert_eq!((found.cut_off_m, found.most_opacity, found.exact), (f32::INFINITY, 0.9, false));
        let found = FogSettings::from_text(sun)?.expect("it is on");
        assert_eq!(found.glow, Some(FogGlow { start_m: 2.0, size: 8.0 }));
        assert_eq!(found.color, FogColor::Radiance([1.0, 2.0, 3.0]));
        assert!(FogSettings::KEYS.iter().all(|key| [air, sun].iter().any(|text| text.contains(&format!("{key}=")))));
        Ok(())
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        for (text, named) in [
            ("haze", "haze: "),
            ("on:gloss=1", "gloss"),
            ("on:density=-1", "density=-1"),
            ("on:cut-off=NaN", "cut-off=NaN"),
            ("on:color=1:2", "color=1:2"),
            ("on:color=1:1:1,tint=1:1:1", "tint: only `color=environment`"),
            ("on:glow-start=1", "glow-start: only `glow=SIZE`"),
            ("on:glow=0", "glow=0"),
            ("on:mean=middle", "mean=middle"),
        ] {
            let told = FogSettings::from_text(text).expect_err("that is no choice").to_string();
            assert!(told.contains(named) && !told.contains('\n'), "{text}: {told}");
        }
    }
}
