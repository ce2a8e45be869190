//! What ambient occlusion is made of. Defaults and presets are Filament's, but for what is said.

use crate::structure::Resolution;

/// How ambient occlusion is estimated and smoothed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct OcclusionSettings {
    /// How.
    pub method: Method,
    /// Of the structure and of what is made of it; at half, the color pass picks among four texels by depth.
    pub resolution: Resolution,
    /// How far occluders count, in m, above 0.
    pub radius_m: f32,
    /// Rise over the tangent plane that occludes nothing, as a share of the distance from the eye.
    pub bias: f32,
    /// Factor on what is obscured.
    pub intensity: f32,
    /// Exponent of visibility.
    pub power: f32,
    /// Least angle over the tangent plane that occludes, in radians: coarse meshes occlude themselves below it.
    pub min_horizon_rad: f32,
    /// How it is smoothed.
    pub blur: Option<Blur>,
    /// Normals from the nearer of two texels each side; else from the next texel of each axis, which is wrong along edges.
    pub fine_normals: bool,
    /// A tap counts where its depth was found; else where the method points, as Filament has it, which tilts surfaces and
    /// takes some 15 % from open ones.
    pub exact_taps: bool,
    /// The mean open direction is kept beside visibility, and reflections are occluded by the cone about it; costs three
    /// channels. Not with [`Occluders::Thick`], whose openings have no one direction.
    pub bent_normals: bool,
    /// The dominant light is traced for contact, too.
    pub cone: Option<ConeTrace>,
}

/// How ambient occlusion is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Method {
    /// Scalable ambient obscurance: taps on a spiral, each of which obscures by how far it rises over the tangent plane.
    Sao {
        /// How many taps, 1 to 64.
        taps: u32,
        /// Turns of the spiral.
        turns: u32,
    },
    /// Horizons in slices of the hemisphere (ground-truth ambient occlusion).
    Gtao(Gtao),
}

/// Settings of [`Method::Gtao`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Gtao {
    /// Slices, 1 to 16.
    pub slices: u32,
    /// Steps on either side of each, 1 to 32.
    pub steps: u32,
    /// Exponent of the share of the way from step to step: 1 is even, more is denser near the middle.
    pub step_power: f32,
    /// How what occludes ends.
    pub occluders: Occluders,
}

/// How what occludes ends, behind and away from the point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Occluders {
    /// It counts fully within the radius and has no back: what rays of the radius's length would find, were the picture all
    /// that there is.
    Solid,
    /// It counts less the farther it is, and what lies below a horizon lowers it a little: Filament's way.
    Fading,
    /// It ends so far behind its front, in m: what is open is kept in 32 bits a slice, not as one horizon on either side.
    Thick(f32),
}

impl Gtao {
    /// Two slices of six steps: as many taps as Filament's, and nearer the truth, since texels share slices by the blur, and
    /// no blur finds what steps have missed.
    pub const DEFAULT: Self = Self { slices: 2, steps: 6, step_power: 1.0, occluders: Occluders::Solid };

    /// Filament's: four slices of three steps, occluders that fade.
    pub const FILAMENT: Self = Self { slices: 4, steps: 3, step_power: 1.0, occluders: Occluders::Fading };
}

/// Cones toward the dominant light, the sun: contact shadows that are part of ambient occlusion, Filament's
/// `AmbientOcclusionOptions::ssct`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ConeTrace {
    /// Length, in m.
    pub reach_m: f32,
    /// Angle at the tip, in radians, below π.
    pub angle_rad: f32,
    /// How far in front of a cone something may be and still touch it, in m.
    pub contact_m: f32,
    /// What fills less of a slice than this, in m, fills nothing.
    pub bias_m: f32,
    /// What a surface edge-on to the light has in addition, in m.
    pub slope_bias_m: f32,
    /// Factor on what is shadowed, 0 to 1.
    pub intensity: f32,
    /// Slices of a cone.
    pub steps: u32,
    /// Cones.
    pub rays: u32,
}

impl ConeTrace {
    /// Filament's.
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
    /// Eleven.
    Medium,
    /// Sixteen.
    High,
    /// Thirty-two.
    Ultra,
}

impl SaoQuality {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Low, Self::Medium, Self::High, Self::Ultra];

    /// As it is asked for.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
            Self::Ultra => "ultra",
        }
    }

    /// The taps.
    pub const fn method(self) -> Method {
        let (taps, turns) = match self {
            Self::Low => (7, 3),
            Self::Medium => (11, 6),
            Self::High => (16, 7),
            Self::Ultra => (32, 14),
        };
        Method::Sao { taps, turns }
    }

    /// Standard deviation of the blur that goes with it, in texels.
    pub const fn sigma(self) -> f32 {
        match self {
            Self::Low | Self::Medium => 8.0,
            Self::High => 6.0,
            Self::Ultra => 4.0,
        }
    }
}

/// A bilateral blur, across and then down.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Blur {
    /// Samples on either side, 1 to 12.
    pub reach: u32,
    /// Texels from sample to sample.
    pub stride: u32,
    /// Standard deviation in samples.
    pub sigma: f32,
    /// Distance between surfaces, in m, from which on one does not count for the other.
    pub threshold_m: f32,
}

impl Blur {
    /// Filament's medium filter, of every second of 21 texels.
    pub const fn medium(sigma: f32) -> Self {
        Self { reach: 5, stride: 2, sigma: 0.5 * sigma, threshold_m: 0.05 }
    }

    /// Filament's high filter, of 23 texels.
    pub const fn high(sigma: f32) -> Self {
        Self { reach: 11, stride: 1, sigma, threshold_m: 0.05 }
    }
}

impl Default for OcclusionSettings {
    /// [`OcclusionSettings::SAO`].
    fn default() -> Self {
        Self::SAO
    }
}

impl OcclusionSettings {
    /// Filament's default quality in its terms: seven taps within 0.3 m and the medium blur. The resolution is the picture's,
    /// where Filament's default is half.
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

    /// Horizons in slices. The bias is smaller: it only has to exceed rounding.
    pub const GTAO: Self = Self {
        method: Method::Gtao(Gtao::DEFAULT),
        bias: 0.0001,
        blur: Some(Blur::high(SaoQuality::Ultra.sigma())),
        ..Self::SAO
    };

    /// A preset of SAO with the blur that goes with it.
    pub const fn sao(quality: SaoQuality) -> Self {
        let blur = match quality {
            SaoQuality::Low | SaoQuality::Medium => Blur::medium(quality.sigma()),
            SaoQuality::High | SaoQuality::Ultra => Blur::high(quality.sigma()),
        };
        Self { method: quality.method(), blur: Some(blur), ..Self::SAO }
    }

    /// Whether it can occlude anything: without a radius or an intensity it cannot, and is left out of a frame (hard case
    /// 32).
    pub fn occludes(&self) -> bool {
        self.radius_m > 0.0 && self.intensity > 0.0 && self.power > 0.0
    }

    /// Whether the mean open direction is kept.
    pub const fn has_bent_normals(&self) -> bool {
        self.bent_normals && !matches!(self.method, Method::Gtao(Gtao { occluders: Occluders::Thick(_), .. }))
    }
}
