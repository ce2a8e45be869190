//! Filters of decoded attributes (appendix B). Results may differ by one step from other decoders, as the extension
//! allows.

use std::f32::consts::FRAC_1_SQRT_2;

use super::layout::{Filter, Layout};

/// Applies the filter of a layout to decoded elements, in place.
pub(super) fn apply(layout: &Layout, elements: &mut [u8]) {
    let wide = layout.stride == 8;
    match layout.filter {
        Filter::None => {}
        Filter::Octahedral if wide => each_16(elements, |v| octahedral(v.map(i32::from), 32767.0).map(|c| c as i16)),
        Filter::Octahedral => {
            each_8(elements, |v| octahedral(v.map(|c| i32::from(c as i8)), 127.0).map(|c| c as i8 as u8));
        }
        Filter::Quaternion => each_16(elements, quaternion),
        Filter::Exponential => elements.as_chunks_mut::<4>().0.iter_mut().for_each(|v| *v = exponential(*v)),
        Filter::Color if wide => each_16(elements, |v| {
            let [y, co, cg, a] = v;
            color(y as u16, co.into(), cg.into(), a as u16, 65535.0).map(|c| c as u16 as i16)
        }),
        Filter::Color => each_8(elements, |[y, co, cg, a]| {
            color(y.into(), (co as i8).into(), (cg as i8).into(), a.into(), 255.0).map(|c| c as u8)
        }),
    }
}

/// Maps each element of four bytes.
fn each_8(elements: &mut [u8], filter: impl Fn([u8; 4]) -> [u8; 4]) {
    elements.as_chunks_mut::<4>().0.iter_mut().for_each(|element| *element = filter(*element));
}

/// Maps each element of four 16-bit numbers.
fn each_16(elements: &mut [u8], filter: impl Fn([i16; 4]) -> [i16; 4]) {
    for element in elements.as_chunks_mut::<8>().0 {
        let numbers = std::array::from_fn(|i| i16::from_le_bytes([element[2 * i], element[2 * i + 1]]));
        for (bytes, number) in element.as_chunks_mut::<2>().0.iter_mut().zip(filter(numbers)) {
            *bytes = number.to_le_bytes();
        }
    }
}

/// Decodes a unit vector; the third component encodes 1.0, the fourth is kept. Conversions to integers saturate, so
/// that invalid elements decode to some vector.
fn octahedral([x, y, one, kept]: [i32; 4], max: f32) -> [f32; 4] {
    let (x, y) = (x as f32 / one as f32, y as f32 / one as f32);
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded over the upper.
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let scale = max / (x * x + y * y + z * z).sqrt();
    [(x * scale).round(), (y * scale).round(), (z * scale).round(), kept as f32]
}

/// Decodes a unit quaternion. The last number encodes 1.0 and, in its two lowest bits, the index of the omitted
/// component.
fn quaternion([x, y, z, one]: [i16; 4]) -> [i16; 4] {
    let scale = FRAC_1_SQRT_2 / f32::from(one | 3);
    let [x, y, z] = [x, y, z].map(|c| f32::from(c) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut decoded = [0; 4];
    for (place, value) in [w, x, y, z].into_iter().enumerate() {
        decoded[((one & 3) as usize + place) % 4] = (value * 32767.0).round() as i16;
    }
    decoded
}

/// Decodes a float from a signed mantissa of 24 bits and a signed exponent of 8 bits.
fn exponential(bytes: [u8; 4]) -> [u8; 4] {
    let number = i32::from_le_bytes(bytes);
    let (exponent, mantissa) = (number >> 24, number << 8 >> 8);
    // Bits of a power of two. Valid exponents are −100 to 100; others wrap.
    let power = f32::from_bits((exponent.wrapping_add(127) as u32) << 23);
    (power * mantissa as f32).to_le_bytes()
}

/// Decodes a color from luma, two chroma components, and alpha, whose highest bit encodes the bit depth.
fn color(y: u16, co: i32, cg: i32, alpha: u16, max: f32) -> [f32; 4] {
    let bits = u16::BITS - alpha.leading_zeros();
    let largest = (1i32 << bits) - 1;
    let y = i32::from(y);
    let [r, g, b] = [y + co - cg, y + cg, y - co - cg];
    let alpha = i32::from(alpha) & largest >> 1;
    let alpha = alpha << 1 | alpha & 1;
    [r, g, b, alpha].map(|c| (c as f32 * (max / largest as f32)).round())
}
