//! Mirror of `wgsl/lib/agx.wgsl`.

use super::primaries::rows;
use glam::{DMat3, DVec3};

/// Rec.2020 to the primaries of AgX (Blender's configuration).
const INSET: DMat3 = rows(
    [0.856_627_153_315_983, 0.095_121_240_538_158_8, 0.048_251_606_145_858_3],
    [0.137_318_972_929_847, 0.761_241_990_602_591, 0.101_439_036_467_562],
    [0.111_898_212_999_95, 0.076_799_418_603_190_3, 0.811_302_368_396_859],
);
/// Inverse of the outset matrix, whose primaries are inset less.
const OUTSET_INVERSE: DMat3 = rows(
    [0.899_796_955_911_611, 0.087_199_619_202_835_1, 0.013_003_424_885_555],
    [0.111_420_988_957_48, 0.875_575_586_156_966, 0.013_003_424_885_554_8],
    [0.111_420_988_957_48, 0.087_199_619_202_834_9, 0.801_379_391_839_686],
);

fn each(color: DVec3, f: impl Fn(f64) -> f64) -> DVec3 {
    DVec3::from_array(color.to_array().map(f))
}

/// Evaluates the contrast sigmoid.
pub fn agx_sigmoid(x: DVec3) -> DVec3 {
    // Coefficients by rising power.
    let factors = [0.002_857, -0.1718, 4.361, -28.72, 92.06, -126.7, 78.01, -17.86];
    each(x, |x| factors.iter().rev().fold(0.0, |sum, factor| sum * x + factor))
}

/// Applies a look by number: 0 default, 1 golden, 2 punchy.
pub fn agx_look(color: DVec3, look: u32) -> DVec3 {
    let (slope, power, saturation) = match look {
        1 => (DVec3::new(1.0, 0.9, 0.5), 0.8, 1.3),
        2 => (DVec3::ONE, 1.35, 1.4),
        _ => (DVec3::ONE, 1.0, 1.0),
    };
    let luma = DVec3::splat(color.dot(DVec3::new(0.2126, 0.7152, 0.0722)));
    let graded = each(color * slope, |x| x.max(1e-10).powf(power));
    luma + saturation * (graded - luma)
}

/// Tone maps scene light to display light, both in Rec.2020.
pub fn tone_agx(color: DVec3, look: u32) -> DVec3 {
    let (low, high) = (-12.473_93, 4.026_069);
    let inset = INSET * color.clamp(DVec3::ZERO, DVec3::splat(65504.0));
    let x = each(inset, |x| ((x.max(1e-10).log2() - low) / (high - low)).clamp(0.0, 1.0));
    let shown = OUTSET_INVERSE.inverse() * agx_look(agx_sigmoid(x), look);
    each(shown, |x| x.max(1e-10).powf(2.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_stay_grey_and_the_middle_stays_the_middle() {
        let grey = tone_agx(DVec3::splat(0.18), 0);
        assert!((grey.max_element() - grey.min_element()) < 1e-3, "{grey}");
        assert!((grey.y - 0.2).abs() < 0.03, "{grey}");
        assert!((tone_agx(DVec3::splat(100.0), 0).y - 0.97).abs() < 0.03);
        // The golden look is warm; the punchy look has more contrast.
        let golden = tone_agx(DVec3::splat(0.18), 1);
        assert!(golden.x > golden.y && golden.y > golden.z, "{golden}");
        let slope = |look| tone_agx(DVec3::splat(0.36), look).y / tone_agx(DVec3::splat(0.09), look).y;
        assert!(slope(2) > 1.2 * slope(0), "{} {}", slope(2), slope(0));
    }
}
