//! Shadow settings in Filament's terms and with its defaults: fit, cascades, filter and bias.

use framegraph::Format;

/// Settings of shadow maps. Lengths are in meters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ShadowSettings {
    /// Width and height of a layer in texels: of a cascade, and of the largest map of a punctual light.
    pub map_texels: u32,
    /// Filter of the maps.
    pub filter: ShadowFilter,
    /// Number of cascades of the sun, 0 to 4; with 0 the sun casts no shadows.
    pub cascades: u8,
    /// Split distances between cascades.
    pub splits: Splits,
    /// Fit of the sun's maps.
    pub fit: Fit,
    /// Greatest distance of the sun's shadows from the eye, toward which they fade; `None` for all receivers.
    pub far_m: Option<f64>,
    /// Bias against self-shadowing.
    pub bias: ShadowBias,
    /// Radius of the light's bulb, as in Filament: the width of DPCF and PCSS penumbrae for a blocker half-way
    /// between the receiver and the near end of the map. `None` derives it from the light's angular radius.
    pub bulb_m: Option<f32>,
    /// Settings of moments.
    pub moments: MomentSettings,
    /// Contact shadows of the sun: short rays through the depth of the picture, for detail that maps miss. `None` as
    /// in Filament.
    pub contact: Option<ContactShadows>,
    /// Maximum number of maps of spot lights (one each) and point lights (six each). With the cascades at most
    /// [`MAX_MAPS`].
    pub local_maps: u8,
    /// Maximum number of layers that maps of punctual lights share, of the size of a cascade. A map is smaller the
    /// less of the view its light reaches. All maps are halved if they need more layers.
    /// [`local_layers`](super::local_layers) returns the number needed.
    pub local_layers: u8,
    /// Tints lit surfaces by their cascade: red, green, blue, yellow.
    pub show_cascades: bool,
}

/// Filter of a shadow map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum ShadowFilter {
    /// PCF: a tent of 3×3 texels in four hardware comparisons.
    Pcf,
    /// DPCF: twelve taps; the shadowed fraction is sharpened near the blocker.
    Dpcf,
    /// PCSS: sixteen taps for blockers, then sixteen over a disc as wide as the penumbra.
    Pcss,
    /// VSM: moments of exponentially warped depth in half floats (exponent 5.54).
    Vsm,
    /// EVSM: moments of exponentially warped depth in 32-bit floats (exponent 42); the device must filter them.
    Evsm,
}

impl ShadowFilter {
    /// All filters.
    pub const ALL: [Self; 5] = [Self::Pcf, Self::Dpcf, Self::Pcss, Self::Vsm, Self::Evsm];

    /// Returns the format of the moments; `None` for filters that read depth.
    pub const fn moments(self) -> Option<Format> {
        match self {
            Self::Pcf | Self::Dpcf | Self::Pcss => None,
            Self::Vsm => Some(Format::Rg16Float),
            Self::Evsm => Some(Format::Rg32Float),
        }
    }

    /// Returns the exponent of the warp: the largest whose square the format holds (hard case 44).
    pub const fn exponent(self) -> f32 {
        match self {
            Self::Evsm => 42.0,
            _ => 5.54,
        }
    }

    /// Returns the value of the shader's `filter_kind`.
    pub(crate) const fn code(self) -> u32 {
        match self {
            Self::Pcf | Self::Vsm | Self::Evsm => 0,
            Self::Dpcf => 1,
            Self::Pcss => 2,
        }
    }
}

/// Split distances between cascades.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Splits {
    /// Fractions of the range, ascending, below 1.
    At([f64; 3]),
    /// Equal parts.
    Uniform,
    /// Equal ratios.
    Logarithmic,
    /// A blend: 0 is uniform, 1 is logarithmic.
    Practical(f64),
}

/// Fit of the sun's maps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Fit {
    /// Fits visible receivers: the most texels, but edges crawl as the camera moves.
    Tight {
        /// Warps the map along the camera's perspective (Wimmer et al., "Light Space Perspective Shadow Maps", 2004).
        lispsm: bool,
    },
    /// Fits a sphere around the cascade and moves it in whole texels: edges stand still.
    Stable,
}

/// Bias against self-shadowing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ShadowBias {
    /// Offset of casters away from the light, in meters.
    pub constant_m: f32,
    /// Offset of receivers along their normals at grazing light, in half texels.
    pub normal: f32,
    /// Slope-scaled polygon offset of casters.
    pub slope: f32,
    /// Constant polygon offset of casters, in steps of depth.
    pub steps: i32,
}

/// Contact shadows: a short ray toward the sun through the depth of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ContactShadows {
    /// Number of steps along the ray, at least 1.
    pub steps: u32,
    /// Length of the ray in meters.
    pub distance_m: f32,
}

impl ContactShadows {
    /// Filament's defaults: eight steps over 30 cm.
    pub const FILAMENT: Self = Self { steps: 8, distance_m: 0.3 };
}

/// Settings of moments.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MomentSettings {
    /// Width of the Gaussian blur in texels, 0 to 125; 0 for none.
    pub blur_texels: f32,
    /// Number of mip levels of the map, at least 1.
    pub levels: u8,
    /// Samples per texel, 1 or 4, whose moments are averaged. Some devices do not support four samples of the 32-bit
    /// format of [`ShadowFilter::Evsm`] and report an error.
    pub samples: u8,
    /// Minimum variance, scaled as in Filament.
    pub min_variance_scale: f32,
    /// Light bleeding reduction, 0 to 1: lighter shadows than this fraction become black.
    pub bleed: f32,
}

impl ShadowSettings {
    /// One cascade of 2048² texels with PCF, warped toward the camera; the sun alone. Values are Filament's, except
    /// for the normal bias, which covers the whole width of the tent.
    pub const DEFAULT: Self = Self {
        map_texels: 2048,
        filter: ShadowFilter::Pcf,
        cascades: 1,
        splits: Splits::At([0.125, 0.25, 0.5]),
        fit: Fit::Tight { lispsm: true },
        far_m: None,
        bias: ShadowBias { constant_m: 0.001, normal: 2.0, slope: 2.0, steps: 1 },
        bulb_m: None,
        moments: MomentSettings { blur_texels: 0.0, levels: 1, samples: 1, min_variance_scale: 0.5, bleed: 0.15 },
        contact: None,
        local_maps: 0,
        local_layers: MAX_MAPS as u8,
        show_cascades: false,
    };

    /// Returns the default with maps of this size.
    pub const fn texels(map_texels: u32) -> Self {
        Self { map_texels, ..Self::DEFAULT }
    }

    /// Returns true if the filter reads moments instead of depth.
    pub const fn has_moments(&self) -> bool {
        self.filter.moments().is_some()
    }

    /// Returns the maximum number of maps of punctual lights.
    pub fn local_maps(&self) -> u16 {
        u16::from(self.local_maps).min(MAX_MAPS.saturating_sub(self.cascades.into()))
    }

    /// Returns the maximum number of layers for maps of punctual lights.
    pub fn local_layers(&self) -> u16 {
        u16::from(self.local_layers).min(self.local_maps())
    }

    /// Returns the number of layers of the texture of all maps: cascades, then shared layers.
    pub fn layers(&self) -> u16 {
        u16::from(self.cascades) + self.local_layers()
    }
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Maximum number of cascades of the sun.
pub const MAX_CASCADES: usize = 4;
/// Maximum number of maps in total.
pub const MAX_MAPS: u16 = 64;
