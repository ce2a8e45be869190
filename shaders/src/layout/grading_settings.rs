//! Color grading settings.

use glam::{Vec3, Vec4};

/// Color grading settings, in Filament's terms and order; the default changes nothing.
///
/// Colors are linear Rec.2020, except `slope`, `offset`, `power` and `contrast`, which apply to LogC values.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Grading {
    /// Exposure compensation in EV.
    pub exposure_ev: f32,
    /// Night adaptation, 0…1: dark colors shift toward blue.
    pub night: f32,
    /// White balance from blue (-1) to amber (1); 0 changes nothing.
    pub temperature: f32,
    /// White balance from green (-1) to magenta (1); 0 changes nothing.
    pub tint: f32,
    /// Channel mixer: the shares of red, green and blue in the output red, green and blue, each -2…2.
    pub mixer: [Vec3; 3],
    /// Shadows: color factor in xyz; w is added to all channels.
    pub shadows: Vec4,
    /// Midtones: color factor in xyz; w is added to all channels.
    pub midtones: Vec4,
    /// Highlights: color factor in xyz; w is added to all channels.
    pub highlights: Vec4,
    /// Luminance limits, 0…1. Shadows fade out between the first two, highlights fade in between the last two.
    pub ranges: Vec4,
    /// Factor on the LogC value of each channel (ASC CDL slope), above 0.
    pub slope: Vec3,
    /// Added to the LogC value of each channel (ASC CDL offset).
    pub offset: Vec3,
    /// Exponent of the LogC value of each channel, above 0 (ASC CDL power).
    pub power: Vec3,
    /// Contrast: factor on the distance from middle gray (0.4135884) in LogC, 0…2.
    pub contrast: f32,
    /// Saturation that affects reds more than other colors, 0…2; 1 changes nothing.
    pub vibrance: f32,
    /// Saturation, from 0 for gray to 2; 1 changes nothing.
    pub saturation: f32,
    /// Exponent of each channel below `middle`, above 0.
    pub shadow_gamma: Vec3,
    /// Value that separates the dark from the bright part of each channel's curve, above 0.
    pub middle: Vec3,
    /// Slope of each channel above `middle`.
    pub highlight_scale: Vec3,
}

impl Grading {
    /// Settings that change nothing.
    pub const NEUTRAL: Self = Self {
        exposure_ev: 0.0,
        night: 0.0,
        temperature: 0.0,
        tint: 0.0,
        mixer: [Vec3::X, Vec3::Y, Vec3::Z],
        shadows: Vec4::new(1.0, 1.0, 1.0, 0.0),
        midtones: Vec4::new(1.0, 1.0, 1.0, 0.0),
        highlights: Vec4::new(1.0, 1.0, 1.0, 0.0),
        ranges: Vec4::new(0.0, 0.333, 0.55, 1.0),
        slope: Vec3::ONE,
        offset: Vec3::ZERO,
        power: Vec3::ONE,
        contrast: 1.0,
        vibrance: 1.0,
        saturation: 1.0,
        shadow_gamma: Vec3::ONE,
        middle: Vec3::ONE,
        highlight_scale: Vec3::ONE,
    };

    /// Returns true if every output channel depends only on the same input channel, in the primaries of the light.
    pub fn keeps_channels_apart(&self) -> bool {
        let own = Self {
            exposure_ev: self.exposure_ev,
            slope: self.slope,
            offset: self.offset,
            power: self.power,
            contrast: self.contrast,
            shadow_gamma: self.shadow_gamma,
            middle: self.middle,
            highlight_scale: self.highlight_scale,
            ranges: self.ranges,
            ..Self::NEUTRAL
        };
        *self == own
    }
}

impl Default for Grading {
    fn default() -> Self {
        Self::NEUTRAL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies neutral values and default ranges against Filament's `ColorGrading::Builder`.
    #[test]
    fn neutral_settings_are_filaments() {
        let n = Grading::NEUTRAL;
        assert_eq!([n.exposure_ev, n.night, n.temperature, n.tint], [0.0; 4]);
        assert_eq!(n.mixer, [Vec3::X, Vec3::Y, Vec3::Z]);
        assert_eq!([n.shadows, n.midtones, n.highlights], [Vec4::new(1.0, 1.0, 1.0, 0.0); 3]);
        assert_eq!(n.ranges, Vec4::new(0.0, 0.333, 0.55, 1.0));
        assert_eq!([n.slope, n.offset, n.power], [Vec3::ONE, Vec3::ZERO, Vec3::ONE]);
        assert_eq!([n.contrast, n.vibrance, n.saturation], [1.0; 3]);
        assert_eq!([n.shadow_gamma, n.middle, n.highlight_scale], [Vec3::ONE; 3]);
    }
}
