//! Mirror of `wgsl/lib/srgb.wgsl`.

use glam::DVec3;

use super::math::saturate;

/// Decodes one sRGB channel to linear light.
pub fn linear_from_srgb_channel(encoded: f64) -> f64 {
    let e = saturate(encoded);
    if e <= 0.04045 { e / 12.92 } else { ((e + 0.055) / 1.055).powf(2.4) }
}

/// Encodes one channel of linear light.
pub fn srgb_from_linear_channel(linear: f64) -> f64 {
    let l = saturate(linear);
    if l <= 0.003_130_8 { l * 12.92 } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 }
}

/// Decodes an sRGB color to linear Rec.709.
pub fn linear_from_srgb(encoded: DVec3) -> DVec3 {
    DVec3::from_array(encoded.to_array().map(linear_from_srgb_channel))
}

/// Encodes a linear Rec.709 color as sRGB.
pub fn srgb_from_linear(linear: DVec3) -> DVec3 {
    DVec3::from_array(linear.to_array().map(srgb_from_linear_channel))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_survives_the_round_trip() {
        for code in 0..=255 {
            let encoded = f64::from(code) / 255.0;
            let back = srgb_from_linear_channel(linear_from_srgb_channel(encoded));
            // The two branches of the standard meet with a gap of 3e-8.
            assert!((back - encoded).abs() < 1e-7, "{code}: {back}");
        }
    }

    #[test]
    fn known_values() {
        assert!((srgb_from_linear_channel(0.18) * 255.0 - 117.65).abs() < 0.01, "18 % grey");
        assert!((linear_from_srgb_channel(0.5) - 0.214_041).abs() < 1e-6);
        let clamped = srgb_from_linear(DVec3::new(-1e-3, 0.0, 1.0001));
        assert!((clamped - DVec3::Z).length() < 1e-15, "{clamped}");
    }

    #[test]
    fn encoding_is_monotone() {
        let codes: Vec<f64> = (0..=4096).map(|i| srgb_from_linear_channel(f64::from(i) / 4096.0)).collect();
        assert!(codes.is_sorted());
    }
}
