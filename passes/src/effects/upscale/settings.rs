//! How much smaller a frame is drawn than it is shown, and how it is made larger.

use framegraph::Extent;

/// A frame that is drawn smaller than it is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Upscale {
    /// Width and height as drawn, in percent of those shown, 25 to 100.
    pub percent: u16,
    /// How it is made larger.
    pub filter: UpscaleFilter,
    /// How much is sharpened afterwards, 0 to 1; 0 is not at all.
    pub sharpness: f32,
}

/// How a picture is made larger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum UpscaleFilter {
    /// In proportion between four texels.
    Bilinear,
    /// Along edges (EASU of FSR 1.0).
    #[default]
    Fsr,
}

impl UpscaleFilter {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Bilinear, Self::Fsr];

    /// As it is asked for.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bilinear => "bilinear",
            Self::Fsr => "fsr",
        }
    }
}

impl Default for Upscale {
    /// [`Upscale::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Upscale {
    /// Half as wide and high, along edges, sharpened as Filament does.
    pub const DEFAULT: Self = Self { percent: 50, filter: UpscaleFilter::Fsr, sharpness: 0.9 };

    /// The size of the view's pictures, for an output of the frame's size.
    pub const fn extent(&self) -> Extent {
        Extent::Relative { num: self.percent, den: 100, align: 1 }
    }
}
