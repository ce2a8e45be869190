//! Settings of upscaling.

use crate::settings::field::{Field, choice, number};
use crate::settings::place::{Words, num, word};
use crate::settings::table::SettingsTable;
use framegraph::Extent;

/// Rendering at a lower resolution than displayed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Upscale {
    /// Rendered width and height, in percent of the displayed size, 25 to 100.
    pub percent: u16,
    /// Upscaling filter.
    pub filter: UpscaleFilter,
    /// Strength of sharpening after upscaling, 0 to 1; 0 disables it.
    pub sharpness: f32,
}

/// Upscaling filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum UpscaleFilter {
    /// Bilinear interpolation.
    Bilinear,
    /// Edge-adaptive upsampling (EASU of FSR 1.0).
    #[default]
    Fsr,
}

impl UpscaleFilter {
    /// All filters.
    pub const ALL: [Self; 2] = [Self::Bilinear, Self::Fsr];
}

impl Words for UpscaleFilter {
    const WORDS: &'static [(&'static str, Self)] = &[("bilinear", Self::Bilinear), ("fsr", Self::Fsr)];
}

impl Default for Upscale {
    /// Returns [`Upscale::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Upscale {
    /// Half the width and height, edge-adaptive, with Filament's sharpening.
    pub const DEFAULT: Self = Self { percent: 50, filter: UpscaleFilter::Fsr, sharpness: 0.9 };

    /// Returns the size of the view's pictures, relative to the frame's size.
    pub const fn extent(&self) -> Extent {
        Extent::Relative { num: self.percent, den: 100, align: 1 }
    }
}

impl SettingsTable for Upscale {
    const OPTION: &'static str = "";
    const PATH: &'static str = "settings.upscale";
    const ABOUT: &'static str = "rendering at a lower resolution (`--scale`)";
    const DEFAULT: Self = Self::DEFAULT;
    const METHODS: &'static [(&'static str, Self)] = &[("on", Self::DEFAULT)];
    const FIELDS: &'static [Field<Self>] = &[
        number("percent", "percent", [25.0, 100.0], |s: &mut Self| num(&mut s.percent))
            .about("rendered width and height, in percent of the displayed size"),
        choice("upscale", "filter", |s: &mut Self| word(&mut s.filter)).about("upscaling filter"),
        number("sharpness", "sharpness", [0.0, 1.0], |s: &mut Self| num(&mut s.sharpness))
            .about("sharpening after upscaling"),
    ];
}
