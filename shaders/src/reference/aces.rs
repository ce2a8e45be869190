//! Mirror of `wgsl/lib/aces.wgsl`, following the published transforms: through xyY, one matrix at a time.

use super::primaries::{AP0_FROM_AP1, XYZ_FROM_AP1, XYZ_FROM_REC2020};
use glam::DVec3;

/// Largest finite half float.
const MOST: f64 = 65504.0;

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns the saturation of a color in AP0.
pub fn aces_saturation(ap0: DVec3) -> f64 {
    (ap0.max_element().max(1e-5) - ap0.min_element().max(1e-5)) / ap0.max_element().max(1e-2)
}

/// Returns the relative brightness that the glow module adds.
pub fn aces_glow(ap0: DVec3, saturation: f64) -> f64 {
    let DVec3 { x: r, y: g, z: b } = ap0;
    let chroma = (b * (b - g) + g * (g - r) + r * (r - b)).max(0.0).sqrt();
    let brightness = (r + g + b + 1.75 * chroma) / 3.0;
    let x = (saturation - 0.4) / 0.2;
    let t = (1.0 - (x / 2.0).abs()).max(0.0);
    let side = if x == 0.0 { 0.0 } else { x.signum() };
    let gain = 0.05 * (1.0 + side * (1.0 - t * t)) / 2.0;
    if brightness <= 2.0 / 3.0 * 0.08 {
        gain
    } else if brightness >= 2.0 * 0.08 {
        0.0
    } else {
        gain * (0.08 / brightness - 0.5)
    }
}

/// Returns how close a hue is to red.
pub fn aces_redness(ap0: DVec3) -> f64 {
    let (aside, along) = (3.0_f64.sqrt() * (ap0.y - ap0.z), 2.0 * ap0.x - ap0.y - ap0.z);
    if aside.abs() + along.abs() < 1e-20 {
        return 0.0;
    }
    smoothstep(0.0, 1.0, 1.0 - (2.0 * aside.atan2(along).to_degrees() / 135.0).abs()).powi(2)
}

/// Tone maps scene light to display light, both in Rec.2020.
pub fn tone_aces(color: DVec3, brightness: f64) -> DVec3 {
    let luminance = XYZ_FROM_AP1.row(1);
    let gray = |c: DVec3| DVec3::splat(c.dot(luminance));
    let ap1_from_xyz = XYZ_FROM_AP1.inverse();
    let color = color.clamp(DVec3::ZERO, DVec3::splat(MOST));
    let mut ap0 = AP0_FROM_AP1 * (ap1_from_xyz * (XYZ_FROM_REC2020 * color));
    let saturated = aces_saturation(ap0);
    ap0 *= 1.0 + aces_glow(ap0, saturated);
    ap0.x += aces_redness(ap0) * saturated * (0.03 - ap0.x) * (1.0 - 0.82);
    let ap1 = (AP0_FROM_AP1.inverse() * ap0).clamp(DVec3::ZERO, DVec3::splat(MOST));
    let x = gray(ap1).lerp(ap1, 0.96) * brightness;
    let fit = (x * (2.785_085 * x + 0.107_772)) / (x * (2.936_045 * x + 0.887_122) + 0.806_889);
    let xyz = XYZ_FROM_AP1 * fit;
    let sum = xyz.element_sum().max(1e-30);
    let (cx, cy, y) = (xyz.x / sum, xyz.y / sum, xyz.y.max(0.0).powf(0.9811));
    let per_y = y / cy.max(1e-30);
    let dim = ap1_from_xyz * DVec3::new(cx * per_y, y, (1.0 - cx - cy) * per_y);
    XYZ_FROM_REC2020.inverse() * (XYZ_FROM_AP1 * gray(dim).lerp(dim, 0.93))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::primaries::rec709_from_rec2020;
    use crate::reference::srgb::srgb_from_linear;

    /// Verifies that the white of ACES is not adapted to that of the display.
    #[test]
    fn white_ends_where_filaments_does() {
        let codes = |x: f64| srgb_from_linear(rec709_from_rec2020(tone_aces(DVec3::splat(x), 1.0))) * 255.0;
        let white = codes(11.52);
        assert!((white - DVec3::new(252.0, 246.0, 237.0)).abs().max_element() < 0.6, "{white}");
    }

    #[test]
    fn reds_are_told_from_other_hues() {
        assert!((aces_redness(DVec3::new(1.0, 0.2, 0.2)) - 1.0).abs() < 1e-12);
        assert_eq!(aces_redness(DVec3::new(0.2, 1.0, 0.2)), 0.0);
        assert_eq!(aces_redness(DVec3::ONE), 0.0);
        assert_eq!(aces_saturation(DVec3::ONE), 0.0);
        assert_eq!(aces_glow(DVec3::ONE, 1.0), 0.0, "what is bright does not glow");
        assert!((aces_glow(DVec3::splat(0.01), 1.0) - 0.05).abs() < 1e-12);
    }
}
