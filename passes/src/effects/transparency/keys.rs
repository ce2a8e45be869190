//! Option parsing of transparency.

use super::settings::{MAX_PEEL_LAYERS, MomentPrecision, MomentTransparency, Transparency};
use crate::settings::key_value::{KeyValue, OptionError, choices};

impl Transparency {
    /// Names accepted by [`Transparency::from_text`].
    pub const NAMES: [&str; 5] = ["sorted", "two-passes", "weighted", "moments", "peeled"];

    /// Default number of layers for `peeled`.
    pub const PEEL_LAYERS: u8 = 4;

    /// Returns the technique's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sorted => "sorted",
            Self::TwoPasses => "two-passes",
            Self::Weighted => "weighted",
            Self::Moments(_) => "moments",
            Self::Peeled { .. } => "peeled",
        }
    }

    /// Parses a name, with optional changes after a colon: `moments:precision=full,overestimation=0.1`,
    /// `peeled:layers=8`.
    ///
    /// # Errors
    /// Fails for an unknown name or an invalid value; the message names it and the accepted values.
    pub fn from_text(text: &str) -> Result<Self, OptionError> {
        let (name, changes) = text.split_once(':').unwrap_or((text, ""));
        let mut own = match name {
            "sorted" => Self::Sorted,
            "two-passes" => Self::TwoPasses,
            "weighted" => Self::Weighted,
            "moments" => Self::Moments(MomentTransparency::DEFAULT),
            "peeled" => Self::Peeled { layers: Self::PEEL_LAYERS },
            _ => return Err(KeyValue { key: name, value: "" }.unknown(&Self::NAMES)),
        };
        for choice in choices(changes) {
            match (&mut own, choice.key) {
                (Self::Peeled { layers }, "layers") => *layers = choice.whole(1, MAX_PEEL_LAYERS.into())? as u8,
                (Self::Moments(moments), "overestimation") => moments.overestimation = choice.number(0.0, 1.0)?,
                (Self::Moments(moments), "precision") => {
                    moments.precision = match choice.value {
                        "half" => MomentPrecision::Half,
                        "full" => MomentPrecision::Full,
                        _ => return Err(choice.wrong("`half` or `full`")),
                    }
                }
                (_, "layers") => return Err(choice.only("peeled")),
                (_, "overestimation" | "precision") => return Err(choice.only("moments")),
                _ => return Err(choice.unknown(&["layers", "overestimation", "precision"])),
            }
        }
        Ok(own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn techniques_are_chosen_by_name() -> Result<(), OptionError> {
        for name in Transparency::NAMES {
            assert_eq!(Transparency::from_text(name)?.name(), name);
        }
        assert_eq!(Transparency::from_text("peeled:layers=8")?, Transparency::Peeled { layers: 8 });
        let full = MomentTransparency { precision: MomentPrecision::Full, overestimation: 0.1 };
        let text = "moments:precision=full,overestimation=0.1";
        assert_eq!(Transparency::from_text(text)?, Transparency::Moments(full));
        for (text, named) in [
            ("exact", "exact: unknown choice; there are sorted"),
            ("peeled:layers=0", "layers=0: a number from 1 to 32"),
            ("peeled:layers=1.5", "layers=1.5"),
            ("weighted:layers=2", "only `peeled` has it"),
            ("sorted:precision=half", "only `moments` has it"),
            ("moments:precision=double", "`half` or `full`"),
            ("moments:bits=3", "bits"),
        ] {
            let told = Transparency::from_text(text).expect_err("that is no choice").to_string();
            assert!(told.contains(named) && !told.contains('\n'), "{text}: {told}");
        }
        Ok(())
    }
}
