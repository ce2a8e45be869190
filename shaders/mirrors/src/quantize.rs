//! Mirror of `wgsl/lib/quantize.wgsl`.

use glam::{DVec3, DVec4};

/// Largest finite 10-bit float.
pub const UFLOAT10_MAX: f64 = 64512.0;
/// Largest finite 11-bit float.
pub const UFLOAT11_MAX: f64 = 65024.0;
/// Largest finite half float.
pub const FLOAT16_MAX: f64 = 65504.0;

/// Rounds x to `bits` mantissa bits and five exponent bits.
pub fn quantize_mantissa(x: f64, bits: u32, toward_zero: bool) -> f64 {
    let exponent = x.abs().max(f64::MIN_POSITIVE).log2().floor().max(-14.0) as i32;
    // log2 rounds: a value just below a power of two may return that power.
    let exponent = if x.abs() < 2.0_f64.powi(exponent) && exponent > -14 { exponent - 1 } else { exponent };
    let spacing = 2.0_f64.powi(exponent - bits as i32);
    let steps = x / spacing;
    (if toward_zero { steps.trunc() } else { steps.round_ties_even() }) * spacing
}

/// Quantizes a color as an Rgba16Float texture does.
pub fn quantize_rgba16float(color: DVec4, toward_zero: bool) -> DVec4 {
    let kept = color.to_array().map(|x| quantize_mantissa(x.clamp(-FLOAT16_MAX, FLOAT16_MAX), 10, toward_zero));
    DVec4::from_array(kept)
}

/// Quantizes a color as an Rg11b10Ufloat texture does.
pub fn quantize_rg11b10ufloat(color: DVec3, toward_zero: bool) -> DVec4 {
    let keep = |x: f64, most, bits| quantize_mantissa(x.clamp(0.0, most), bits, toward_zero);
    DVec4::new(keep(color.x, UFLOAT11_MAX, 6), keep(color.y, UFLOAT11_MAX, 6), keep(color.z, UFLOAT10_MAX, 5), 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns every finite number of an unsigned format, in order, from its definition: exponent in the five upper
    /// bits.
    fn numbers(bits: u32) -> Vec<f64> {
        let code = |code: u32| {
            let (exponent, mantissa) = (code >> bits, f64::from(code & ((1 << bits) - 1)) * 0.5_f64.powi(bits as i32));
            if exponent == 0 {
                mantissa * 0.5_f64.powi(14)
            } else {
                (1.0 + mantissa) * 2.0_f64.powi(exponent as i32 - 15)
            }
        };
        (0..31 << bits).map(code).collect()
    }

    #[test]
    fn the_neighbours_in_the_format_are_found() {
        for (bits, most) in [(10, FLOAT16_MAX), (6, UFLOAT11_MAX), (5, UFLOAT10_MAX)] {
            let numbers = numbers(bits);
            assert_eq!(numbers.last(), Some(&most), "{bits} bits");
            for (index, pair) in numbers.windows(2).enumerate() {
                let (low, high) = (pair[0], pair[1]);
                let round = |share: f64, zero| quantize_mantissa(low + (high - low) * share, bits, zero);
                assert_eq!((round(0.0, false), round(0.0, true)), (low, low));
                assert_eq!((round(0.25, false), round(0.75, false)), (low, high));
                assert_eq!((round(0.75, true), round(-0.0, true)), (low, low));
                let even = if index % 2 == 0 { low } else { high };
                assert_eq!((round(0.5, false), round(0.5, true)), (even, low), "ties go to even");
            }
        }
        assert_eq!(quantize_mantissa(-1.0009, 10, true), -1.0);
    }

    #[test]
    fn colors_are_kept_in_range() {
        let wild = DVec4::new(-1.0, 1e9, 1.0, 0.3);
        assert_eq!(quantize_rgba16float(wild, false).truncate(), DVec3::new(-1.0, FLOAT16_MAX, 1.0));
        assert_eq!(quantize_rg11b10ufloat(wild.truncate(), false), DVec4::new(0.0, UFLOAT11_MAX, 1.0, 1.0));
    }
}
