//! Techniques of transparency, and what they are made with.

/// The most layers that are peeled.
pub const MAX_PEEL_LAYERS: u8 = 32;

/// How blended surfaces are put in order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Transparency {
    /// Objects from back to front, and triangles of an object in the order of the mesh, as in Filament. A material may ask
    /// for two passes ([`TransparencyMode`](framegraph_scene::TransparencyMode)).
    #[default]
    Sorted,
    /// As `Sorted`, with the back faces of every double-sided object before its front faces: Filament's
    /// `TWO_PASSES_TWO_SIDES` for all of them.
    TwoPasses,
    /// Weighted averages of all surfaces of a pixel (McGuire and Bavoil, JCGT 2(2), 2013).
    Weighted,
    /// Weights from four moments of where surfaces absorb (Münstermann et al., I3D 2018).
    Moments(MomentTransparency),
    /// Depth peeling: the nearest layers of every pixel, exactly; farther ones are left out.
    Peeled {
        /// Layers a pixel, 1 to [`MAX_PEEL_LAYERS`].
        layers: u8,
    },
}

impl Transparency {
    /// Whether the technique draws blended surfaces in passes of their own, in any order.
    #[must_use]
    pub const fn is_unordered(self) -> bool {
        matches!(self, Self::Weighted | Self::Moments(_) | Self::Peeled { .. })
    }
}

/// Numbers of moment-based transparency.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct MomentTransparency {
    /// How sums are stored.
    pub precision: MomentPrecision,
    /// Share of absorbance at a surface itself that counts as in front of it, 0 to 1; the paper has 0.25.
    pub overestimation: f32,
}

/// Formats of sums of moments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum MomentPrecision {
    /// 16 bits a channel, ten bytes a texel. Every device blends them.
    #[default]
    Half,
    /// 32 bits a channel, twenty bytes a texel, for devices with `FLOAT32_BLENDABLE`. With several samples a texel, sums are
    /// stored in 16 bits all the same.
    Full,
}

impl MomentPrecision {
    /// Share of an even distribution that is mixed into the moments, against rounding: the paper's number for 32 bits. In 16
    /// bits, less lets a surface behind one of alpha 1 shine through at the ends of the range.
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
    /// [`MomentTransparency::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}
