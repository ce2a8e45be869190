//! Tone curves and their numbers in `wgsl/lib/tone_map.wgsl`.

use glam::DVec3;

/// Tone curve with four parameters, applied to each channel of Rec.2020 (Lottes, "Advanced Techniques and Optimization
/// of HDR Color Pipelines", 2016).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct GenericCurve {
    /// Slope around middle gray, above 0.
    pub contrast: f32,
    /// Scene light of middle gray, 0…1.
    pub middle_in: f32,
    /// Display light of middle gray, 0…1.
    pub middle_out: f32,
    /// Scene light that maps to white, at least 1.
    pub white: f32,
}

impl GenericCurve {
    /// Filament's values, similar to ACES.
    pub const DEFAULT: Self = Self { contrast: 1.55, middle_in: 0.18, middle_out: 0.215, white: 10.0 };

    /// Returns contrast, input scale and output scale for the shader. Parameters out of range are clamped.
    pub fn numbers(&self) -> DVec3 {
        let contrast = f64::from(self.contrast).clamp(1e-5, 4.0);
        let middle_in = f64::from(self.middle_in).clamp(1e-5, 1.0);
        let middle_out = f64::from(self.middle_out).clamp(1e-5, 0.9999);
        // The curve rises only if white is sufficiently above middle gray.
        let least = (1.0001 / middle_out).powf(1.0 / contrast) * middle_in;
        let white = f64::from(self.white).clamp(least.max(1.0), 65504.0_f64.max(least));
        let (a, b) = (middle_in.powf(contrast), white.powf(contrast));
        let c = a - middle_out * b;
        DVec3::new(contrast, a * b * (middle_out - 1.0) / c, middle_out * (a - b) / c)
    }
}

/// Tone curve of `wgsl/lib/tone_map.wgsl`, the value of the override `TONE_MAP`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ToneMap {
    /// Clamped to 0…1.
    Linear,
    /// ACES 1.0 as fitted by Hill: closest to the reference transform, and white stays white.
    #[default]
    Hill,
    /// Narkowicz' per-channel curve in Rec.709, Filament's FILMIC.
    Filmic,
    /// Khronos PBR Neutral, in Rec.709.
    Neutral,
    /// ACES with its input scaled by 1/0.6: Filament's default.
    AcesLegacy,
    /// Clamped to 0…1 in Rec.2020: Filament's LINEAR.
    Linear2020,
    /// ACES as Filament computes it.
    Aces,
    /// AgX.
    Agx,
    /// AgX with its warm look.
    AgxGolden,
    /// AgX with its look of higher contrast and saturation.
    AgxPunchy,
    /// The curve of Gran Turismo 7 for a display of 250 nits.
    Gt7,
    /// False colors: one color per stop.
    DisplayRange,
    /// Curve with four parameters.
    Generic(GenericCurve),
    /// x / (x + 0.155) · 1.019 for each channel of Rec.709: close to FILMIC with the sRGB transfer function included.
    /// Fast enough for phones, because it needs no power function and no encoding step.
    Mobile,
    /// Custom function of the application; available only through a grading table.
    Own,
}

impl ToneMap {
    /// All named curves.
    pub const ALL: [Self; 14] = [
        Self::Linear,
        Self::Hill,
        Self::Filmic,
        Self::Neutral,
        Self::AcesLegacy,
        Self::Linear2020,
        Self::Aces,
        Self::Agx,
        Self::AgxGolden,
        Self::AgxPunchy,
        Self::Gt7,
        Self::Generic(GenericCurve::DEFAULT),
        Self::DisplayRange,
        Self::Mobile,
    ];

    /// Returns the curve's number in the shader; `None` for a custom curve.
    pub const fn number(self) -> Option<u32> {
        Some(match self {
            Self::Linear => 0,
            Self::Hill => 1,
            Self::Filmic => 2,
            Self::Neutral => 3,
            Self::AcesLegacy => 4,
            Self::Linear2020 => 5,
            Self::Aces => 6,
            Self::Agx => 7,
            Self::AgxGolden => 8,
            Self::AgxPunchy => 9,
            Self::Gt7 => 10,
            Self::Generic(_) => 11,
            Self::DisplayRange => 12,
            Self::Mobile => 13,
            Self::Own => return None,
        })
    }

    /// Returns the parameters of the generic curve, or the defaults for other curves.
    pub fn generic(self) -> DVec3 {
        if let Self::Generic(curve) = self { curve.numbers() } else { GenericCurve::DEFAULT.numbers() }
    }

    /// Returns true if grading precedes this curve in Rec.2020; false only for FILMIC, as in Filament.
    pub const fn graded_in_rec2020(self) -> bool {
        !matches!(self, Self::Filmic)
    }

    /// Returns true if the curve maps each channel of Rec.709 independently.
    pub const fn keeps_channels_apart(self) -> bool {
        matches!(self, Self::Linear | Self::Filmic | Self::Mobile)
    }

    /// Returns true if the output is sRGB encoded because the curve includes the transfer function.
    pub const fn is_encoded(self) -> bool {
        matches!(self, Self::Mobile)
    }

    /// Returns the name for command lines.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Hill => "hill",
            Self::Filmic => "filmic",
            Self::Neutral => "neutral",
            Self::AcesLegacy => "aces-legacy",
            Self::Linear2020 => "linear-2020",
            Self::Aces => "aces",
            Self::Agx => "agx",
            Self::AgxGolden => "agx-golden",
            Self::AgxPunchy => "agx-punchy",
            Self::Gt7 => "gt7",
            Self::Generic(_) => "generic",
            Self::DisplayRange => "display-range",
            Self::Mobile => "mobile",
            Self::Own => "own",
        }
    }

    /// Returns the curve with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|curve| curve.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_curve_stay_in_their_ranges() {
        let contrast = |contrast| GenericCurve { contrast, ..GenericCurve::DEFAULT }.numbers().x;
        assert_eq!([-1.0, 0.0, 4.0, 4.2, 100.0].map(contrast), [1e-5, 1e-5, 4.0, 4.0, 4.0]);
        assert_eq!(contrast(2.0), 2.0);
        // The curve passes through its middle and its white: y = x^c s / (x^c + t) in the form of the shader.
        let of = |curve: GenericCurve, x: f64| {
            let [contrast, input, output] = curve.numbers().to_array();
            let power = x.powf(contrast);
            output * power / (power + input)
        };
        for (middle_in, middle_out, white) in [(0.18_f32, 0.215_f32, 10.0_f32), (0.3, 0.4, 4.0), (0.1, 0.1, 100.0)] {
            let curve = GenericCurve { middle_in, middle_out, white, ..GenericCurve::DEFAULT };
            assert!((of(curve, middle_in.into()) - f64::from(middle_out)).abs() < 1e-6, "{curve:?}");
            assert!((of(curve, white.into()) - 1.0).abs() < 1e-6, "{curve:?}");
        }
    }
}
