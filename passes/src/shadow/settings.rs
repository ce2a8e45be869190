//! How lights cast shadows: fit, cascades, filter and bias, in Filament's terms and with its numbers.

use framegraph::Format;

/// How shadows are made. Lengths in meters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct ShadowSettings {
    /// Width and height of a layer in texels: of a cascade's map, and of the largest of a local light.
    pub map_texels: u32,
    /// How a map is read.
    pub filter: ShadowFilter,
    /// Maps of the sun, each for a range of distances from the eye, 0…4; 0: the sun casts none.
    pub cascades: u8,
    /// Where one cascade ends and the next begins.
    pub splits: Splits,
    /// What the sun's maps are fitted to.
    pub fit: Fit,
    /// The sun casts shadows no farther than this from the eye, and fades toward it; none: as far as something receives them.
    pub far_m: Option<f64>,
    /// What keeps surfaces from shadowing themselves.
    pub bias: ShadowBias,
    /// Radius of the light's bulb, as Filament has it: penumbrae of DPCF and PCSS are this wide where a blocker is half-way
    /// between the receiver and the near end of the map. None: as wide as the light's angular radius makes them.
    pub bulb_m: Option<f32>,
    /// How moments are made and read.
    pub moments: MomentSettings,
    /// Shadows of the sun that a map is too coarse for, by a short ray through the picture's depth; none as in Filament.
    pub contact: Option<ContactShadows>,
    /// Most maps of spot lights (one each) and point lights (six each); with the cascades at most [`MOST_MAPS`].
    pub local_maps: u8,
    /// Most layers that those maps share, which are of one size with a cascade's. A map is smaller the less of the view its
    /// light reaches, and all are where they would take more layers; [`local_layers`](super::local_layers) says how many they
    /// take.
    pub local_layers: u8,
    /// Tints what is lit by the number of its cascade: red, green, blue, yellow.
    pub show_cascades: bool,
}

/// How a shadow map is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum ShadowFilter {
    /// A tent of 3×3 texels in four hardware comparisons.
    Pcf,
    /// Twelve taps, of which the share in shadow is hardened where the blocker is near.
    Dpcf,
    /// Sixteen taps for blockers, then sixteen over a disc as wide as the penumbra.
    Pcss,
    /// Moments of exponentially warped depth in half floats (exponent 5.54).
    Vsm,
    /// The same in 32-bit floats (exponent 42); the device must filter them.
    Evsm,
}

impl ShadowFilter {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Pcf, Self::Dpcf, Self::Pcss, Self::Vsm, Self::Evsm];

    /// As it is asked for.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pcf => "pcf",
            Self::Dpcf => "dpcf",
            Self::Pcss => "pcss",
            Self::Vsm => "vsm",
            Self::Evsm => "evsm",
        }
    }

    /// The filter of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|filter| filter.name() == name)
    }

    /// Format of the moments; none where depth itself is read.
    pub const fn moments(self) -> Option<Format> {
        match self {
            Self::Pcf | Self::Dpcf | Self::Pcss => None,
            Self::Vsm => Some(Format::Rg16Float),
            Self::Evsm => Some(Format::Rg32Float),
        }
    }

    /// Exponent of the warp: the largest whose square the format holds (hard case 44).
    pub const fn exponent(self) -> f32 {
        match self {
            Self::Evsm => 42.0,
            _ => 5.54,
        }
    }

    /// The value of the shader's `filter_kind`.
    pub(super) const fn code(self) -> u32 {
        match self {
            Self::Pcf | Self::Vsm | Self::Evsm => 0,
            Self::Dpcf => 1,
            Self::Pcss => 2,
        }
    }
}

/// Where one cascade ends and the next begins.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Splits {
    /// Shares of the range, each above the one before, below 1.
    At([f64; 3]),
    /// Equal parts.
    Uniform,
    /// Equal ratios.
    Logarithmic,
    /// A blend: 0 is uniform, 1 logarithmic.
    Practical(f64),
}

/// What the sun's maps are fitted to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Fit {
    /// What the camera sees and something casts upon: as many texels as possible, and edges that crawl as the camera moves.
    Tight {
        /// The map's perspective follows the camera's (Wimmer et al., "Light Space Perspective Shadow Maps", 2004).
        lispsm: bool,
    },
    /// A sphere about the cascade, moved in whole texels: edges stand still.
    Stable,
}

/// What keeps surfaces from shadowing themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ShadowBias {
    /// Casters are moved away from the light by this, in meters.
    pub constant_m: f32,
    /// Receivers are moved along their normals by half of so many texels where light grazes them.
    pub normal: f32,
    /// Polygon offset of casters: depth a texel times this.
    pub slope: f32,
    /// Polygon offset of casters in steps of depth.
    pub steps: i32,
}

/// A short ray toward the sun through the depth that the picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ContactShadows {
    /// Places on the ray that are looked at, at least 1.
    pub steps: u32,
    /// Length of the ray in meters.
    pub distance_m: f32,
}

impl ContactShadows {
    /// Filament's: eight steps over 30 cm.
    pub const FILAMENT: Self = Self { steps: 8, distance_m: 0.3 };
}

/// How moments are made and read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MomentSettings {
    /// Width of the Gaussian blur in texels, 0…125; 0: none.
    pub blur_texels: f32,
    /// Levels of the map, each half the one before; 1: none beside the map itself.
    pub levels: u8,
    /// Samples a texel, of which each has moments of its own, which are averaged: 1 or 4. Not every device has several samples
    /// of the 32 bits of [`ShadowFilter::Evsm`]; one that has not says so.
    pub samples: u8,
    /// Least variance, as Filament scales it.
    pub min_variance_scale: f32,
    /// Shadows lighter than this share are black, which hides light that bleeds, 0…1.
    pub bleed: f32,
}

impl ShadowSettings {
    /// One cascade of 2048² texels read by PCF, warped toward the camera; the sun alone. Numbers are Filament's, but for the
    /// normal bias, which covers the whole width of the tent.
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
        local_layers: MOST_MAPS as u8,
        show_cascades: false,
    };

    /// The default with maps of this size.
    pub const fn texels(map_texels: u32) -> Self {
        Self { map_texels, ..Self::DEFAULT }
    }

    /// Whether moments are read, instead of depth.
    pub const fn has_moments(&self) -> bool {
        self.filter.moments().is_some()
    }

    /// Local maps that there may be.
    pub fn local_maps(&self) -> u16 {
        u16::from(self.local_maps).min(MOST_MAPS.saturating_sub(self.cascades.into()))
    }

    /// Layers that local maps share: no more than maps.
    pub fn local_layers(&self) -> u16 {
        u16::from(self.local_layers).min(self.local_maps())
    }

    /// Layers of the texture that holds all maps: one a cascade, and those that local maps share.
    pub fn layers(&self) -> u16 {
        u16::from(self.cascades) + self.local_layers()
    }
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Most cascades of the sun.
pub const MOST_CASCADES: usize = 4;
/// Most maps in all.
pub const MOST_MAPS: u16 = 64;
