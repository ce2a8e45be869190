//! Settings of upscaling.

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

    /// Returns the name used in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bilinear => "bilinear",
            Self::Fsr => "fsr",
        }
    }
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
