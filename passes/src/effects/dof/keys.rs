//! Option parsing of depth of field.

use super::settings::DofSettings;
use crate::effects::depth::structure::Resolution;
use crate::settings::key_value::{KeyValue, OptionError, switched};

impl DofSettings {
    /// Names accepted by [`DofSettings::set`].
    pub const KEYS: [&str; 12] = [
        "focus",
        "aperture",
        "focal",
        "scale",
        "resolution",
        "before",
        "behind",
        "rings-before",
        "rings-behind",
        "rings-even",
        "median",
        "blended",
    ];

    /// Parses `off`, or `on` with changes such as `on:focus=3,aperture=1.4`. Returns `None` for `off`.
    ///
    /// # Errors
    /// Fails for another word, an unknown name or an invalid value; the message names it and the accepted values.
    pub fn from_text(text: &str) -> Result<Option<Self>, OptionError> {
        switched(text, Self::DEFAULT, Self::set)
    }

    /// Changes one setting by name.
    ///
    /// # Errors
    /// Fails as [`DofSettings::from_text`] does.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), OptionError> {
        let choice = KeyValue { key, value };
        let rings = || choice.whole(3, 17).map(|rings| rings as u8);
        match key {
            "focus" => self.focus_m = choice.number(1e-3, 1e9)?,
            "aperture" => self.f_number = choice.number(0.1, 1e3)?,
            "focal" if value == "view" => self.focal_length_m = None,
            "focal" => self.focal_length_m = Some(choice.number(1e-3, 10.0)?),
            "scale" => self.scale = choice.number(0.0, 1e3)?,
            "resolution" => {
                self.resolution = match value {
                    "full" => Resolution::Full,
                    "half" => Resolution::Half,
                    _ => return Err(choice.wrong("`full` or `half`")),
                }
            }
            "before" => self.most_before_px = choice.number(0.0, 32.0)?,
            "behind" => self.most_behind_px = choice.number(0.0, 32.0)?,
            "rings-before" => self.rings_before = rings()?,
            "rings-behind" => self.rings_behind = rings()?,
            "rings-even" => self.rings_even = rings()?,
            "median" => self.median = choice.switch()?,
            "blended" => {
                self.blended_after = match value {
                    "before" => false,
                    "after" => true,
                    _ => return Err(choice.wrong("`before` or `after`")),
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
        assert_eq!(DofSettings::from_text("off")?, None);
        assert_eq!(DofSettings::from_text("on:focal=view")?, Some(DofSettings::DEFAULT));
        let own = "on:focus=2,aperture=1.4,focal=0.05,scale=3,resolution=full,before=8,behind=16,rings-before=3,\
                   rings-behind=4,rings-even=17,median=off,blended=after";
        let expected = DofSettings {
            focus_m: 2.0,
            f_number: 1.4,
            focal_length_m: Some(0.05),
            scale: 3.0,
            resolution: Resolution::Full,
            most_before_px: 8.0,
            most_behind_px: 16.0,
            rings_before: 3,
            rings_behind: 4,
            rings_even: 17,
            median: false,
            blended_after: true,
        };
        assert_eq!(DofSettings::from_text(own)?, Some(expected));
        assert!(DofSettings::KEYS.iter().all(|key| own.contains(&format!("{key}="))));
        for (text, named) in [
            ("blur", "blur: "),
            ("on:gloss=1", "gloss"),
            ("on:focus=0", "focus=0"),
            ("on:aperture=-1", "aperture=-1"),
            ("on:before=33", "before=33"),
            ("on:rings-even=2", "rings-even=2"),
            ("on:resolution=quarter", "resolution=quarter"),
            ("on:blended=on", "blended=on"),
        ] {
            let told = DofSettings::from_text(text).expect_err("that is no choice").to_string();
            assert!(told.contains(named) && !told.contains('\n'), "{text}: {told}");
        }
        Ok(())
    }
}
