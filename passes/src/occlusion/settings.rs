//! What ambient occlusion is made of. Defaults and presets are Filament's, but for what is said.

use crate::structure::Resolution;

/// How ambient occlusion is estimated and smoothed.
#[derive(Clone, Copy, Debug, PartialEq)]
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
}

/// How ambient occlusion is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Scalable ambient obscurance: taps on a spiral, each of which obscures by how far it rises over the tangent plane.
    Sao {
        /// How many taps, 1 to 64.
        taps: u32,
        /// Turns of the spiral.
        turns: u32,
    },
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
}
