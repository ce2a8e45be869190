//! Techniques of transparency, and their settings.

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
