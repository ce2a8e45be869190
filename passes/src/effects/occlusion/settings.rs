//! Settings of ambient occlusion. Defaults and presets are Filament's unless stated.

use crate::effects::depth::structure::Resolution;
use crate::settings::place::Words;

/// Method and filter of ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct OcclusionSettings {
    /// Method.
    pub method: Method,
    /// Resolution of the structure and the occlusion; at half, the color pass weights four texels by depth.
    pub resolution: Resolution,
    /// Maximum distance of occluders in meters, above 0.
    pub radius_m: f32,
    /// Height above the tangent plane that does not occlude, relative to the distance from the eye.
    pub bias: f32,
    /// Strength of occlusion.
    pub intensity: f32,
    /// Exponent of visibility.
    pub power: f32,
    /// Minimum angle above the tangent plane that occludes, in radians; hides self-occlusion of coarse meshes.
    pub min_horizon_rad: f32,
    /// Blur; `None` for none.
    pub blur: Option<Blur>,
    /// Derives normals from the nearer of two texels on each side; otherwise from the next texel of each axis, which
    /// is wrong along edges.
    pub fine_normals: bool,
    /// Evaluates a tap at the position of its depth. Otherwise at the position of the method, as Filament does, which
    /// darkens open surfaces by about 15 %.
    pub exact_taps: bool,
    /// Computes bent normals for specular occlusion; costs three channels. Not with [`Occluders::Thick`], whose
    /// openings have no single direction.
    pub bent_normals: bool,
    /// Contact shadows of the dominant light by cone tracing; `None` for none.
    pub cone: Option<ConeTrace>,
}

/// Method of ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Method {
    /// Scalable ambient obscurance: taps on a spiral, each occluding by its height above the tangent plane.
    Sao {
        /// Number of taps, 1 to 64.
        taps: u32,
        /// Turns of the spiral.
        turns: u32,
    },
    /// Ground-truth ambient occlusion: horizons in slices of the hemisphere.
    Gtao(Gtao),
}

/// Settings of [`Method::Gtao`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Gtao {
    /// Number of slices, 1 to 16.
    pub slices: u32,
    /// Steps on each side of a slice, 1 to 32.
    pub steps: u32,
    /// Exponent of the step distribution: 1 is even, more is denser near the center.
    pub step_power: f32,
    /// Falloff of occluders.
    pub occluders: Occluders,
}

/// Falloff of occluders with distance, and their thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Occluders {
    /// Occluders within the radius count fully and are infinitely thick: the result of rays of that length through
    /// the visible surfaces.
    Solid,
    /// Occluders count less with distance, and a lower sample reduces the horizon slightly, as in Filament.
    Fading,
    /// Occluders have this thickness in meters. Openings are kept as 32 bits per slice instead of one horizon per
    /// side.
    Thick(f32),
}

impl Gtao {
    /// Two slices of six steps: as many taps as Filament's, and closer to the truth, since the blur shares slices
    /// between texels but cannot recover missed steps.
    pub const DEFAULT: Self = Self { slices: 2, steps: 6, step_power: 1.0, occluders: Occluders::Solid };

    /// Filament's defaults: four slices of three steps, with fading occluders.
    pub const FILAMENT: Self = Self { slices: 4, steps: 3, step_power: 1.0, occluders: Occluders::Fading };
}

/// Cone tracing toward the sun: contact shadows as part of ambient occlusion, Filament's
/// `AmbientOcclusionOptions::ssct`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ConeTrace {
    /// Length of a cone in meters.
    pub reach_m: f32,
    /// Apex angle in radians, below π.
    pub angle_rad: f32,
    /// Maximum distance of an occluder in front of a cone, in meters.
    pub contact_m: f32,
    /// Minimum size of an occluder within a slice, in meters.
    pub bias_m: f32,
    /// Additional bias of surfaces edge-on to the light, in meters.
    pub slope_bias_m: f32,
    /// Strength of the shadow, 0 to 1.
    pub intensity: f32,
    /// Slices per cone.
    pub steps: u32,
    /// Number of cones.
    pub rays: u32,
}

impl ConeTrace {
    /// Filament's defaults.
    pub const FILAMENT: Self = Self {
        reach_m: 0.3,
        angle_rad: 1.0,
        contact_m: 1.0,
        bias_m: 0.01,
        slope_bias_m: 0.01,
        intensity: 0.8,
        steps: 4,
        rays: 1,
    };
}

/// Filament's presets of [`Method::Sao`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SaoQuality {
    /// Seven taps.
    #[default]
    Low,
    /// Eleven taps.
    Medium,
    /// Sixteen taps.
    High,
    /// Thirty-two taps.
    Ultra,
}

impl SaoQuality {
    /// Returns the method with its taps.
    pub const fn method(self) -> Method {
        let (taps, turns) = match self {
            Self::Low => (7, 3),
            Self::Medium => (11, 6),
            Self::High => (16, 7),
            Self::Ultra => (32, 14),
        };
        Method::Sao { taps, turns }
    }

    /// Returns the standard deviation of the preset's blur in texels.
    pub const fn sigma(self) -> f32 {
        match self {
            Self::Low | Self::Medium => 8.0,
            Self::High => 6.0,
            Self::Ultra => 4.0,
        }
    }
}

/// Separable bilateral blur.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Blur {
    /// Samples on each side, 1 to 12.
    pub reach: u32,
    /// Distance between samples in texels.
    pub stride: u32,
    /// Standard deviation in samples.
    pub sigma: f32,
    /// Distance in meters from which on surfaces do not blur into each other.
    pub threshold_m: f32,
}

impl Blur {
    /// Seven texels, for [`Method::Gtao`]. Its noise repeats every four texels, so a wider blur only removes detail.
    pub const LOW: Self = Self { reach: 3, stride: 1, sigma: 2.0, threshold_m: 0.05 };

    /// Filament's medium filter: every second of 21 texels.
    pub const fn medium(sigma: f32) -> Self {
        Self { reach: 5, stride: 2, sigma: 0.5 * sigma, threshold_m: 0.05 }
    }

    /// Filament's high filter: 23 texels.
    pub const fn high(sigma: f32) -> Self {
        Self { reach: 11, stride: 1, sigma, threshold_m: 0.05 }
    }
}

impl Default for OcclusionSettings {
    /// Returns [`OcclusionSettings::SAO`].
    fn default() -> Self {
        Self::SAO
    }
}

impl OcclusionSettings {
    /// Filament's default quality: seven taps within 0.3 m and the medium blur. At full resolution, where Filament's
    /// default is half.
    pub const SAO: Self = Self {
        method: SaoQuality::Low.method(),
        resolution: Resolution::Full,
        radius_m: 0.3,
        bias: 0.0005,
        intensity: 1.0,
        power: 1.0,
        min_horizon_rad: 0.0,
        blur: Some(Blur::medium(SaoQuality::Low.sigma())),
        fine_normals: true,
        exact_taps: true,
        bent_normals: false,
        cone: None,
    };

    /// GTAO. The bias is smaller than SAO's, since it only has to exceed rounding.
    pub const GTAO: Self =
        Self { method: Method::Gtao(Gtao::DEFAULT), bias: 0.0001, blur: Some(Blur::LOW), ..Self::SAO };

    /// Returns a preset of SAO with its blur.
    pub const fn sao(quality: SaoQuality) -> Self {
        let blur = match quality {
            SaoQuality::Low | SaoQuality::Medium => Blur::medium(quality.sigma()),
            SaoQuality::High | SaoQuality::Ultra => Blur::high(quality.sigma()),
        };
        Self { method: quality.method(), blur: Some(blur), ..Self::SAO }
    }

    /// Returns true if the settings can occlude anything. Otherwise the effect is dropped.
    pub fn occludes(&self) -> bool {
        self.radius_m > 0.0 && self.intensity > 0.0 && self.power > 0.0
    }

    /// Returns true if bent normals are computed.
    pub const fn has_bent_normals(&self) -> bool {
        self.bent_normals && !matches!(self.method, Method::Gtao(Gtao { occluders: Occluders::Thick(_), .. }))
    }
}

impl Words for SaoQuality {
    const WORDS: &'static [(&'static str, Self)] =
        &[("low", Self::Low), ("medium", Self::Medium), ("high", Self::High), ("ultra", Self::Ultra)];
}
