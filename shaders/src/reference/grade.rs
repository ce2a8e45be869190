//! Mirror of `wgsl/effect/grade.wgsl`: the complete color grading, with the numbers that the shader gets.

use super::grading::{
    CONTRAST_PIVOT, contrast_about, linear_from_log_c, log_c_from_linear, saturation, slope_offset_power,
    toe_and_shoulder, tonal_shares, vibrance, white_balance,
};
use super::night::night_adaptation;
use super::primaries::{LUMINANCE_REC709, LUMINANCE_REC2020, REC2020_FROM_REC709};
use crate::layout::Grading;
use glam::{DMat3, DVec3};

/// Precomputed color grading: the matrices of [`Grading`], with all parameters clamped to their ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grade {
    /// Linear Rec.709 to the working primaries, including white balance.
    pub into: DMat3,
    /// Channel mixer in the working primaries.
    pub mixer: DMat3,
    /// Working primaries to linear Rec.709.
    pub out_of: DMat3,
    /// Luminance weights of the working primaries.
    pub weights: DVec3,
    /// Factor on scene light.
    pub exposure: f64,
    /// Amount of night adaptation, 0…1.
    pub night: f64,
    /// Factors on shadows, midtones and highlights.
    pub tones: [DVec3; 3],
    /// Luminance limits at which shadows end and highlights begin.
    pub ranges: [f64; 4],
    /// Slope in LogC.
    pub slope: DVec3,
    /// Offset in LogC.
    pub offset: DVec3,
    /// Exponent in LogC.
    pub power: DVec3,
    /// Contrast around the pivot in LogC.
    pub contrast: f64,
    /// Vibrance; 1 changes nothing.
    pub vibrance: f64,
    /// Saturation; 1 changes nothing.
    pub saturation: f64,
    /// Exponent below `middle`.
    pub shadow_gamma: DVec3,
    /// Value at which the power ends and the line begins.
    pub middle: DVec3,
    /// Slope above `middle`.
    pub highlight_scale: DVec3,
}

impl Grade {
    /// Computes a grade from `grading`. The working primaries are Rec.2020; false selects Rec.709 for Filament's FILMIC
    /// curve. The white balance always uses the numbers for Rec.2020.
    pub fn new(grading: &Grading, rec2020: bool) -> Self {
        let g = grading;
        let wide = if rec2020 { REC2020_FROM_REC709 } else { DMat3::IDENTITY };
        // Neutral settings are exactly neutral, without rounding errors of the daylight locus.
        let balance = match (g.temperature, g.tint) {
            (0.0, 0.0) => DMat3::IDENTITY,
            (temperature, tint) => white_balance(temperature.into(), tint.into()),
        };
        let tone = |tone: glam::Vec4| (tone.truncate() + tone.w).as_dvec3().max(DVec3::ZERO);
        let ranges = g.ranges.as_dvec4().to_array();
        let (low, high) = (ranges[0].clamp(0.0, 1.0), ranges[3].clamp(0.0, 1.0));
        let between = |x: f64| x.clamp(low + 1e-5, (high - 1e-5).max(low + 1e-5));
        let least = DVec3::splat(1e-5);
        let row = |row: glam::Vec3| row.as_dvec3().clamp(DVec3::splat(-2.0), DVec3::splat(2.0));
        Self {
            into: balance * wide,
            mixer: DMat3::from_cols(row(g.mixer[0]), row(g.mixer[1]), row(g.mixer[2])).transpose(),
            out_of: wide.inverse(),
            weights: if rec2020 { LUMINANCE_REC2020 } else { LUMINANCE_REC709 },
            exposure: f64::from(g.exposure_ev).clamp(-32.0, 32.0).exp2(),
            night: f64::from(g.night).clamp(0.0, 1.0),
            tones: [tone(g.shadows), tone(g.midtones), tone(g.highlights)],
            ranges: [low, between(ranges[1]), between(ranges[2]), high.max(low + 2e-5)],
            slope: g.slope.as_dvec3().max(least),
            offset: g.offset.as_dvec3(),
            power: g.power.as_dvec3().max(least),
            contrast: f64::from(g.contrast).clamp(0.0, 2.0),
            vibrance: f64::from(g.vibrance).clamp(0.0, 2.0),
            saturation: f64::from(g.saturation).clamp(0.0, 2.0),
            shadow_gamma: g.shadow_gamma.as_dvec3().max(least),
            middle: g.middle.as_dvec3().max(least),
            highlight_scale: g.highlight_scale.as_dvec3(),
        }
    }

    /// Grades linear Rec.709 light. Results outside Rec.709 have negative channels.
    pub fn apply(&self, color: DVec3) -> DVec3 {
        let positive = |c: DVec3| c.clamp(DVec3::ZERO, DVec3::splat(65504.0));
        let mut c = positive(color * self.exposure);
        if self.night > 0.0 {
            c = night_adaptation(c, self.night);
        }
        c = self.mixer * (self.into * c).max(DVec3::ZERO);
        let shares = tonal_shares(c.dot(self.weights), self.ranges);
        let [shadows, midtones, highlights] = self.tones;
        c *= shares.x * shadows + shares.y * midtones + shares.z * highlights;
        let decided = slope_offset_power(log_c_from_linear(c), self.slope, self.offset, self.power);
        c = linear_from_log_c(contrast_about(decided, CONTRAST_PIVOT, self.contrast));
        c = saturation(vibrance(c, self.weights, self.vibrance), self.weights, self.saturation);
        let c = positive(c);
        let curve = |i: usize| toe_and_shoulder(c[i], self.shadow_gamma[i], self.middle[i], self.highlight_scale[i]);
        self.out_of * DVec3::new(curve(0), curve(1), curve(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_grading_changes_nothing_but_negatives() {
        for rec2020 in [true, false] {
            let neutral = Grade::new(&Grading::NEUTRAL, rec2020);
            for color in [DVec3::new(0.2, 4.0, 0.0), DVec3::splat(0.18), DVec3::new(50.0, 0.0, 0.001)] {
                // The LogC round trip loses the precision of a difference of logarithms.
                assert!((neutral.apply(color) - color).length() < 1e-8 * (1.0 + color.length()), "{color}");
            }
            assert!(neutral.apply(DVec3::new(-1.0, 0.5, -0.2)).abs_diff_eq(DVec3::new(0.0, 0.5, 0.0), 1e-9));
        }
    }

    #[test]
    fn hostile_settings_stay_finite() {
        let most = glam::Vec3::splat(1e9);
        let hostile = Grading {
            exposure_ev: 1e9,
            ranges: glam::Vec4::new(2.0, -1.0, 5.0, -3.0),
            slope: most,
            power: glam::Vec3::ZERO,
            middle: glam::Vec3::ZERO,
            shadow_gamma: glam::Vec3::ZERO,
            contrast: 1e9,
            ..Grading::NEUTRAL
        };
        for color in [DVec3::ZERO, DVec3::splat(1e30), DVec3::new(-1.0, 0.0, 65504.0)] {
            let graded = Grade::new(&hostile, true).apply(color);
            assert!(graded.is_finite(), "{color}: {graded}");
        }
    }
}
