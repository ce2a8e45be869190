//! Methods of finding punctual lights, by name: `auto`, `all`, `froxels`, `froxels:slices=24,far=200`.

use crate::settings::key_value::{KeyValue, OptionError, choices};

/// Method of finding the punctual lights that reach a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum LightSearch {
    /// Uses froxels if at least [`LightSearch::FEW`] lights have a finite range, and `All` otherwise.
    Auto(FroxelSettings),
    /// Evaluates the lights in the list of the point's froxel.
    Froxels(FroxelSettings),
    /// Evaluates every light everywhere.
    All,
}

/// Froxel grid of a view. Defaults are Filament's, except for the tiles: Filament allows up to 512, of which a picture
/// of 1280×720 has 27×15.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct FroxelSettings {
    /// Maximum number of tiles, 1…4096. Tiles are square, and their side is a multiple of 8 pixels.
    pub tiles: u32,
    /// Number of depth slices, 1…64.
    pub slices: u32,
    /// Far end of the first slice in meters ahead of the eye, above 0.
    pub near_m: f32,
    /// Nominal far end of the last slice in meters, above `near_m`. Slice ends grow exponentially up to it; the last
    /// slice is unbounded.
    pub far_m: f32,
}

impl FroxelSettings {
    /// Default: 16×9 tiles in a 16:9 picture; 16 slices between 5 m and 100 m.
    pub const DEFAULT: Self = Self { tiles: 144, slices: 16, near_m: 5.0, far_m: 100.0 };

    /// Keys of the settings.
    pub const KEYS: [&str; 4] = ["tiles", "slices", "near", "far"];

    fn set(&mut self, choice: KeyValue<'_>) -> Result<(), OptionError> {
        match choice.key {
            "tiles" => self.tiles = choice.whole(1, 4096)?,
            "slices" => self.slices = choice.whole(1, 64)?,
            "near" => self.near_m = choice.number(1e-3, 1e6)?,
            "far" => self.far_m = choice.number(1e-3, 1e6)?,
            _ => return Err(choice.unknown(&Self::KEYS)),
        }
        Ok(())
    }
}

impl LightSearch {
    /// Minimum number of lights with a finite range for which froxels are faster (`docs/design/lights.md`).
    pub const FEW: usize = 4;

    /// Parses `auto`, `all` or `froxels`, the first and the last with settings: `froxels:slices=24,far=200`.
    ///
    /// # Errors
    /// Fails on an unknown method or key, or an invalid value, with a message that lists the valid ones.
    pub fn from_text(text: &str) -> Result<Self, OptionError> {
        let (way, changes) = text.split_once(':').unwrap_or((text, ""));
        let mut settings = FroxelSettings::DEFAULT;
        for choice in choices(changes) {
            if way == "all" {
                return Err(choice.only("froxels"));
            }
            settings.set(choice)?;
        }
        let FroxelSettings { near_m, far_m, .. } = settings;
        if near_m >= far_m {
            return Err(KeyValue { key: "near", value: &near_m.to_string() }.wrong("less than `far`"));
        }
        match way {
            "auto" => Ok(Self::Auto(settings)),
            "froxels" => Ok(Self::Froxels(settings)),
            "all" => Ok(Self::All),
            _ => Err(KeyValue { key: way, value: "" }.unknown(&["auto", "froxels", "all"])),
        }
    }
}

impl Default for LightSearch {
    /// Returns [`LightSearch::Auto`].
    fn default() -> Self {
        Self::Auto(FroxelSettings::DEFAULT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_made_by_name() -> Result<(), OptionError> {
        assert_eq!(LightSearch::from_text("auto")?, LightSearch::default());
        assert_eq!(LightSearch::from_text("all")?, LightSearch::All);
        let own = FroxelSettings { tiles: 512, slices: 24, near_m: 0.5, far_m: 200.0 };
        let asked = LightSearch::from_text("froxels:tiles=512,slices=24,near=0.5,far=200")?;
        assert_eq!(asked, LightSearch::Froxels(own));
        for key in FroxelSettings::KEYS {
            assert!(LightSearch::from_text(&format!("auto:{key}=6")).is_ok(), "{key}");
        }
        for (wrong, named) in [
            ("tiled", "tiled: "),
            ("froxels:depth=2", "depth: "),
            ("froxels:slices=0", "slices=0: "),
            ("froxels:far=NaN", "far=NaN: "),
            ("froxels:near", "near=: "),
            ("froxels:near=9,far=9", "near=9"),
            ("all:slices=2", "slices: "),
        ] {
            let told = LightSearch::from_text(wrong).err().map(|error| error.to_string()).unwrap_or_default();
            assert!(told.starts_with(named) && !told.contains('\n'), "{wrong}: {told}");
        }
        Ok(())
    }
}
