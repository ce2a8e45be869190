//! Color conversions of the working space: linear Rec.709 with D65 white.

use glam::{DMat3, DVec3, Vec3};

/// Luminance weights of linear Rec.709 (ITU-R BT.709-6, item 3.2; four digits as standardized).
const LUMINANCE_REC709: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Returns the luminance of a linear Rec.709 color, in the unit of its channels.
#[must_use]
pub fn luminance_from_rec709(color: DVec3) -> f64 {
    color.dot(LUMINANCE_REC709)
}

/// Decodes one sRGB-encoded channel in 0…1 (IEC 61966-2-1).
#[must_use]
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Encodes one linear channel in 0…1 as sRGB (IEC 61966-2-1).
#[must_use]
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Converts an sRGB color in hexadecimal notation, `0xRRGGBB`, to linear Rec.709.
#[must_use]
pub fn linear_from_hex(rgb: u32) -> Vec3 {
    let channel = |shift: u32| linear_from_srgb(((rgb >> shift) & 0xff) as f32 / 255.0);
    Vec3::new(channel(16), channel(8), channel(0))
}

/// Converts CIE XYZ to linear Rec.709, both relative to D65 (IEC 61966-2-1). Colors outside of the gamut get negative
/// channels.
#[must_use]
pub fn rec709_from_xyz(xyz: DVec3) -> DVec3 {
    // Columns: contributions of one unit of X, Y and Z.
    let rec709_from_xyz = DMat3::from_cols(
        DVec3::new(3.240_454_2, -0.969_266_0, 0.055_643_4),
        DVec3::new(-1.537_138_5, 1.876_010_8, -0.204_025_9),
        DVec3::new(-0.498_531_4, 0.041_556_0, 1.057_225_2),
    );
    rec709_from_xyz * xyz
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_round_trip_covers_every_code() {
        for code in 0..=255_u16 {
            let encoded = f32::from(code) / 255.0;
            let back = srgb_from_linear(linear_from_srgb(encoded));
            // A tenth of an 8-bit step, too little to change a stored value.
            assert!((back - encoded).abs() < 0.1 / 255.0, "{code}: {back}");
        }
        assert_eq!(linear_from_srgb(1.0), 1.0);
        // The mid-gray of an sRGB image: 188/255 encodes 0.5028 linear.
        assert!((linear_from_srgb(188.0 / 255.0) - 0.502_886).abs() < 1e-5);
    }

    #[test]
    fn d65_white_is_equal_energy_and_luminance_agrees_with_y() {
        // D65 with Y = 1 (CIE 15:2004, two-degree observer).
        let white = rec709_from_xyz(DVec3::new(0.950_47, 1.0, 1.088_83));
        assert!((white - DVec3::ONE).abs().max_element() < 1e-3, "{white}");
        let color = rec709_from_xyz(DVec3::new(0.3, 0.4, 0.2));
        assert!((luminance_from_rec709(color) - 0.4).abs() < 1e-4);
    }
}
