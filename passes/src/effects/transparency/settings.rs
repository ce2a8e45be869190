//! Techniques of transparency, their settings and the table of them.

use crate::settings::field::{Field, choice, number};
use crate::settings::place::{Place, Words, num, word};
use crate::settings::table::SettingsTable;

/// Maximum number of peeled layers.
pub const MAX_PEEL_LAYERS: u8 = 32;

/// Ordering of blended surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Transparency {
    /// Sorts objects from back to front, with triangles in mesh order, as in Filament. Materials can request two passes
    /// ([`TransparencyMode`](framegraph_scene::TransparencyMode)).
    #[default]
    Sorted,
    /// Sorts like `Sorted`, and draws the back faces of each double-sided object before its front faces: Filament's
    /// `TWO_PASSES_TWO_SIDES` for all objects.
    TwoPasses,
    /// Weighted average of all surfaces of a pixel (McGuire and Bavoil, JCGT 2(2), 2013).
    Weighted,
    /// Weights from four moments of the absorbance (Münstermann et al., I3D 2018).
    Moments(MomentTransparency),
    /// Depth peeling: the nearest layers of each pixel are exact; farther ones are dropped.
    Peeled {
        /// Number of layers, 1 to [`MAX_PEEL_LAYERS`].
        layers: u8,
    },
}

impl Transparency {
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

    /// Returns true if the technique draws blended surfaces in separate passes, in any order.
    #[must_use]
    pub const fn is_unordered(self) -> bool {
        matches!(self, Self::Weighted | Self::Moments(_) | Self::Peeled { .. })
    }
}

/// Settings of moment-based transparency.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct MomentTransparency {
    /// Format of the sums.
    pub precision: MomentPrecision,
    /// Share of a surface's own absorbance that counts as in front of it, 0 to 1; 0.25 in the paper.
    pub overestimation: f32,
}

/// Format of the moment sums.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum MomentPrecision {
    /// 16 bits per channel, 10 bytes per texel. Every device can blend it.
    #[default]
    Half,
    /// 32 bits per channel, 20 bytes per texel. Requires `FLOAT32_BLENDABLE`. Falls back to 16 bits with several
    /// samples per texel.
    Full,
}

impl MomentPrecision {
    /// Returns the weight of a uniform distribution mixed into the moments against rounding: the paper's value for 32
    /// bits. For 16 bits it is larger; otherwise surfaces behind an opaque one shine through at the ends of the range.
    #[must_use]
    pub const fn bias(self) -> f32 {
        match self {
            Self::Half => 2e-3,
            Self::Full => 5e-7,
        }
    }
}

impl MomentTransparency {
    /// Half floats, and the paper's overestimation.
    pub const DEFAULT: Self = Self { precision: MomentPrecision::Half, overestimation: 0.25 };
}

impl Default for MomentTransparency {
    /// Returns [`MomentTransparency::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Words for MomentPrecision {
    const WORDS: &'static [(&'static str, Self)] = &[("half", Self::Half), ("full", Self::Full)];
}

fn moments(s: &mut Transparency, place: fn(&mut MomentTransparency) -> Place<'_>) -> Place<'_> {
    match s {
        Transparency::Moments(own) => place(own),
        _ => Place::Only("moments"),
    }
}

impl SettingsTable for Transparency {
    const OPTION: &'static str = "transparency";
    const PATH: &'static str = "settings.transparency";
    const ABOUT: &'static str = "order of blended surfaces";
    const DEFAULT: Self = Self::Sorted;
    const METHODS: &'static [(&'static str, Self)] = &[
        ("sorted", Self::Sorted),
        ("two-passes", Self::TwoPasses),
        ("weighted", Self::Weighted),
        ("moments", Self::Moments(MomentTransparency::DEFAULT)),
        ("peeled", Self::Peeled { layers: Self::PEEL_LAYERS }),
    ];
    const FIELDS: &'static [Field<Self>] = &[
        choice("precision", "precision", |s: &mut Self| moments(s, |m| word(&mut m.precision)))
            .about("format of the moment sums"),
        number("overestimation", "overestimation", [0.0, 1.0], |s: &mut Self| {
            moments(s, |m| num(&mut m.overestimation))
        })
        .about("share of a surface's own absorbance that counts as in front of it"),
        number("layers", "layers", [1.0, MAX_PEEL_LAYERS as f64], |s: &mut Self| match s {
            Self::Peeled { layers } => num(layers),
            _ => Place::Only("peeled"),
        })
        .about("number of peeled layers"),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn techniques_are_chosen_by_name() {
        crate::settings::table::test::<Transparency>();
        for (name, technique) in Transparency::METHODS {
            assert_eq!((Transparency::parse(name), technique.name()), (Ok(*technique), *name));
        }
        let full = MomentTransparency { precision: MomentPrecision::Full, overestimation: 0.1 };
        let text = "moments:precision=full,overestimation=0.1";
        assert_eq!(Transparency::parse(text), Ok(Transparency::Moments(full)));
        for (text, named) in [
            ("off", "off: unknown choice; there are sorted"),
            ("peeled:layers=0", "layers=0: expected a whole number from 1 to 32"),
            ("weighted:layers=2", "only `peeled` has it"),
            ("sorted:precision=half", "only `moments` has it"),
            ("moments:precision=double", "`half` or `full`"),
        ] {
            let error = Transparency::parse(text).expect_err(text).to_string();
            assert!(error.contains(named) && !error.contains('\n'), "{text}: {error}");
        }
    }
}
