//! Option parsing of bloom.

use super::settings::{Blend, BloomQuality, BloomSettings, FlareSettings, Threshold};
use crate::settings::key_value::{KeyValue, OptionError, switched};

impl BloomSettings {
    /// Names accepted by [`BloomSettings::set`].
    pub const KEYS: [&str; 21] = [
        "strength",
        "height",
        "levels",
        "quality",
        "blend",
        "threshold",
        "at",
        "highlight",
        "fireflies",
        "kernel",
        "dirt",
        "flare",
        "starburst",
        "aberration",
        "ghosts",
        "ghost-spacing",
        "ghost-at",
        "halo",
        "halo-radius",
        "halo-at",
        "flare-multiple",
    ];

    /// Parses `off`, or `on` with changes such as `on:strength=0.3,flare=on`. Returns `None` for `off`.
    ///
    /// # Errors
    /// Fails for another word, an unknown name or an invalid value; the message names it and the accepted values.
    pub fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        switched(text, Self::DEFAULT, Self::set)
    }

    /// Changes one setting by name.
    ///
    /// # Errors
    /// Fails as [`BloomSettings::from_text`] does.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        match key {
            "strength" => self.strength = choice.number(0.0, 1.0)?,
            "height" => self.height_texels = choice.whole(16, 2048)?,
            "levels" => self.levels = choice.whole(0, Self::MAX_LEVELS.into())? as u8,
            "quality" => {
                self.quality = match value {
                    "low" => BloomQuality::Low,
                    "medium" => BloomQuality::Medium,
                    "high" => BloomQuality::High,
                    _ => return Err(choice.wrong("`low`, `medium` or `high`")),
                }
            }
            "blend" => {
                self.blend = match value {
                    "add" => Blend::Add,
                    "interpolate" => Blend::Interpolate,
                    _ => return Err(choice.wrong("`add` or `interpolate`")),
                }
            }
            "threshold" => {
                self.threshold = match value {
                    "off" => Threshold::None,
                    "soft" => Threshold::Soft,
                    "hard" => Threshold::Hard,
                    _ => return Err(choice.wrong("`off`, `soft` or `hard`")),
                }
            }
            "at" => self.threshold_at = choice.number(0.0, 1e4)?,
            "highlight" => self.highlight = choice.number(1e-2, f32::INFINITY)?,
            "fireflies" => self.fireflies = choice.switch()?,
            "kernel" => {
                self.narrow = match value {
                    "wide" => false,
                    "narrow" => true,
                    _ => return Err(choice.wrong("`wide` or `narrow`")),
                }
            }
            "dirt" => self.dirt = choice.number(0.0, 1e3)?,
            "flare" => self.flare = choice.switch()?.then_some(FlareSettings::DEFAULT),
            _ if !Self::KEYS.contains(&key) => return Err(choice.unknown(&Self::KEYS)),
            _ => self.flare.as_mut().ok_or_else(|| choice.only("flare=on"))?.set(choice)?,
        }
        Ok(())
    }
}

impl FlareSettings {
    fn set(&mut self, choice: KeyValue<'_>) -> Result<(), OptionError> {
        match choice.key {
            "starburst" => self.starburst = choice.switch()?,
            "aberration" => self.aberration = choice.number(0.0, 1.0)?,
            "ghosts" => self.ghosts = choice.whole(0, 16)? as u8,
            "ghost-spacing" => self.ghost_spacing = choice.number(0.0, 1.0)?,
            "ghost-at" => self.ghost_threshold = choice.number(0.0, 1e4)?,
            "halo" => self.halo_thickness = choice.number(0.0, 1.0)?,
            "halo-radius" => self.halo_radius = choice.number(0.0, 0.5)?,
            "halo-at" => self.halo_threshold = choice.number(0.0, 1e4)?,
            _ => self.multiple_px = choice.whole(1, 1 << 16)?,
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_made_by_name() -> Result<(), OptionError> {
        assert_eq!(BloomSettings::from_text("off")?, None);
        assert_eq!(BloomSettings::from_text("on")?, Some(BloomSettings::DEFAULT));
        let own = "on:strength=0.5,height=256,levels=4,quality=high,blend=interpolate,threshold=hard,at=2,highlight=inf,\
                   fireflies=off,kernel=narrow,dirt=3,flare=on,starburst=off,aberration=0.1,ghosts=2,ghost-spacing=0.25,ghost-at=1,\
                   halo=0.2,halo-radius=0.3,halo-at=4,flare-multiple=8";
        let expected = BloomSettings {
            strength: 0.5,
            height_texels: 256,
            levels: 4,
            quality: BloomQuality::High,
            blend: Blend::Interpolate,
            threshold: Threshold::Hard,
            threshold_at: 2.0,
            highlight: f32::INFINITY,
            fireflies: false,
            narrow: true,
            dirt: 3.0,
            flare: Some(FlareSettings {
                starburst: false,
                aberration: 0.1,
                ghosts: 2,
                ghost_spacing: 0.25,
                ghost_threshold: 1.0,
                halo_radius: 0.3,
                halo_thickness: 0.2,
                halo_threshold: 4.0,
                multiple_px: 8,
            }),
            multiple_px: 1,
        };
        assert_eq!(BloomSettings::from_text(own)?, Some(expected));
        assert!(BloomSettings::KEYS.iter().all(|key| own.contains(&format!("{key}="))));
        assert_eq!(BloomSettings::from_text("on:flare=on,flare=off")?, Some(BloomSettings::DEFAULT));
        Ok(())
    }

    #[test]
    fn wrong_words_are_named_in_one_line() {
        for (text, named) in [
            ("glow", "glow: "),
            ("on:gloss=1", "gloss"),
            ("on:strength=2", "strength=2"),
            ("on:height=1.5", "height=1.5"),
            ("on:levels=13", "levels=13"),
            ("on:quality=best", "quality=best"),
            ("on:blend=mix", "blend=mix"),
            ("on:threshold=on", "threshold=on"),
            ("on:highlight=0", "highlight=0"),
            ("on:kernel=box", "kernel=box"),
            ("on:ghosts=1", "ghosts: only `flare=on`"),
            ("on:flare=on,halo-radius=1", "halo-radius=1"),
        ] {
            let told = BloomSettings::from_text(text).expect_err("that is no choice").to_string();
            assert!(told.contains(named) && !told.contains('\n'), "{text}: {told}");
        }
    }
}
