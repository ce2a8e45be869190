//! Methods of finding punctual lights, by name: `auto`, `all`, `froxels`, `froxels:slices=24,far=200`.

use crate::settings::field::{Field, number};
use crate::settings::key_value::OptionError;
use crate::settings::place::{Place, num};
use crate::settings::table::SettingsTable;

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
}

impl LightSearch {
    /// Minimum number of lights with a finite range for which froxels are faster (`docs/design/lights.md`).
    pub const FEW: usize = 4;
}

fn froxels(s: &mut LightSearch, place: fn(&mut FroxelSettings) -> Place<'_>) -> Place<'_> {
    match s {
        LightSearch::Auto(own) | LightSearch::Froxels(own) => place(own),
        LightSearch::All => Place::Only("froxels"),
    }
}

impl SettingsTable for LightSearch {
    const OPTION: &'static str = "lights";
    const PATH: &'static str = "lights";
    const ABOUT: &'static str =
        "method of finding punctual lights; `auto` is `froxels` for 4 or more lights of limited range";
    const DEFAULT: Self = Self::Auto(FroxelSettings::DEFAULT);
    const METHODS: &'static [(&'static str, Self)] = &[
        ("auto", Self::Auto(FroxelSettings::DEFAULT)),
        ("froxels", Self::Froxels(FroxelSettings::DEFAULT)),
        ("all", Self::All),
    ];
    const FIELDS: &'static [Field<Self>] = &[
        number("tiles", "tiles", [1.0, 4096.0], |s: &mut Self| froxels(s, |f| num(&mut f.tiles)))
            .about("maximum number of tiles"),
        number("slices", "slices", [1.0, 64.0], |s: &mut Self| froxels(s, |f| num(&mut f.slices)))
            .about("number of depth slices"),
        number("near", "near_m", [1e-3, 1e6], |s: &mut Self| froxels(s, |f| num(&mut f.near_m)))
            .about("far end of the first slice"),
        number("far", "far_m", [1e-3, 1e6], |s: &mut Self| froxels(s, |f| num(&mut f.far_m)))
            .about("far end of the last slice"),
    ];

    fn check(&self) -> Result<(), OptionError> {
        match self {
            Self::Auto(own) | Self::Froxels(own) if own.near_m >= own.far_m => {
                let (key, value, takes) = ("near".into(), own.near_m.to_string(), "less than `far`".into());
                Err(OptionError::Value { key, value, takes })
            }
            _ => Ok(()),
        }
    }
}

impl Default for LightSearch {
    /// Returns [`LightSearch::Auto`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_set_by_name() {
        crate::settings::table::test::<LightSearch>();
        assert_eq!(LightSearch::parse("auto"), Ok(LightSearch::default()));
        assert_eq!(LightSearch::parse("all"), Ok(LightSearch::All));
        let own = FroxelSettings { tiles: 512, slices: 24, near_m: 0.5, far_m: 200.0 };
        let asked = LightSearch::parse("froxels:tiles=512,slices=24,near=0.5,far=200");
        assert_eq!(asked, Ok(LightSearch::Froxels(own)));
        for (wrong, named) in [
            ("tiled", "tiled: "),
            ("froxels:depth=2", "depth: "),
            ("froxels:slices=0", "slices=0: "),
            ("froxels:far=NaN", "far=NaN: "),
            ("froxels:near", "near=: "),
            ("froxels:near=9,far=9", "near=9: expected less than `far`"),
            ("all:slices=2", "slices: only `froxels`"),
        ] {
            let error = LightSearch::parse(wrong).expect_err(wrong).to_string();
            assert!(error.starts_with(named) && !error.contains('\n'), "{wrong}: {error}");
        }
    }
}
