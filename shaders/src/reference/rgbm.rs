//! Mirror of `wgsl/lib/rgbm.wgsl`.

use glam::{DVec3, DVec4};

/// Largest value that RGBM can represent.
pub const RGBM_MAX: f64 = 256.0;

/// Decodes RGBM in [0, 1] to light in [0, 256].
pub fn linear_from_rgbm(codes: DVec4) -> DVec3 {
    let root = codes.truncate() * (16.0 * codes.w);
    root * root
}

/// Encodes a color as RGBM in [0, 1]. The multiplier is rounded up to an 8-bit step, so that no channel exceeds one.
/// Values outside [0, 256] are clamped. CPU only.
pub fn rgbm_from_linear(color: DVec3) -> DVec4 {
    let root = color.clamp(DVec3::ZERO, DVec3::splat(RGBM_MAX)).map(f64::sqrt) / 16.0;
    let factor = (root.max_element() * 255.0).ceil().clamp(1.0, 255.0) / 255.0;
    (root / factor).clamp(DVec3::ZERO, DVec3::ONE).extend(factor)
}

/// Encodes a color as RGBM with 8 bits per channel. CPU only.
pub fn rgbm_bytes(color: DVec3) -> [u8; 4] {
    rgbm_from_linear(color).to_array().map(|code| (code * 255.0).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(color: DVec3) -> DVec3 {
        linear_from_rgbm(DVec4::from_array(rgbm_bytes(color).map(|code| f64::from(code) / 255.0)))
    }

    /// Verifies the error relative to the brightest channel: half an 8-bit step of the root, so twice that of its
    /// square.
    #[test]
    fn eight_bits_keep_the_brightest_channel_within_half_a_percent() {
        for step in 0..4000 {
            let brightest = 1e-2 * 1.002_6_f64.powi(step);
            let color = DVec3::new(brightest, 0.3 * brightest, 0.01 * brightest);
            if brightest > RGBM_MAX {
                break;
            }
            let off = (kept(color) - color).abs() / brightest;
            // Small multipliers have coarse 8-bit steps of their own.
            let least = (brightest.sqrt() / 16.0 * 255.0).max(1.0);
            assert!(
                off.x < 0.0045 + 0.5 / (least * least) && off.max_element() < 0.0045 + 1.0 / least,
                "{color}: {off}"
            );
        }
        assert_eq!(kept(DVec3::splat(1e4)), DVec3::splat(256.0), "clamped");
        assert_eq!(kept(DVec3::new(-1.0, 0.0, 0.0)), DVec3::ZERO);
    }
}
