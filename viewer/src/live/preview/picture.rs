//! Picture of a texture.

use super::look::{Look, Shown};
use super::read::Found;
use framegraph_wgpu::inspect::{Channel, DisplayMode};

/// Color of texels with NaN or infinity.
const LOUD: [u8; 4] = [255, 0, 255, 255];

/// Returns RGBA, 8 bits per channel.
pub(super) fn picture(found: &Found, look: &Look) -> Vec<u8> {
    let range = look.range;
    if look.shown == Shown::FalseColor {
        let channel = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha][look.channel()];
        let range = Some(range).filter(|[low, high]| low < high);
        return found.texels.display(DisplayMode::False { channel, range }, found.near_m).rgba8;
    }
    let mut rgba8 = Vec::with_capacity(found.numbers.len() * 4);
    let count = found.channels();
    for texel in &found.numbers {
        rgba8.extend(match look.shown {
            // The far plane is infinitely far and white.
            Shown::Distance if !texel[0].is_nan() => gray(found.near_m / texel[0].max(0.0), look),
            _ if texel[..count].iter().any(|value| !value.is_finite()) => LOUD,
            _ => color(*texel, look),
        });
    }
    rgba8
}

fn gray(value: f32, look: &Look) -> [u8; 4] {
    let code = code(value, look);
    [code, code, code, 255]
}

fn color(texel: [f32; 4], look: &Look) -> [u8; 4] {
    if look.channels.iter().filter(|on| **on).count() == 1 {
        return gray(texel[look.channel()], look);
    }
    let [r, g, b] = [0, 1, 2].map(|channel| if look.channels[channel] { code(texel[channel], look) } else { 0 });
    [r, g, b, 255]
}

/// Returns the 8-bit code of a value within the range.
fn code(value: f32, look: &Look) -> u8 {
    let [low, high] = look.range;
    let share = if high > low { (value - low) / (high - low) } else { f32::from(value > low) };
    let share = share.clamp(0.0, 1.0);
    // IEC 61966-2-1.
    let encoded = match look.srgb {
        true if share <= 0.003_130_8 => 12.92 * share,
        true => 1.055 * share.powf(1.0 / 2.4) - 0.055,
        false => share,
    };
    (255.0 * encoded + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::super::read::histogram;
    use super::*;
    use framegraph::{Aspect, Format};
    use framegraph_wgpu::inspect::Texels;

    fn found(format: Format, texels: &[[f32; 4]]) -> Found {
        let bits = texels.iter().map(|texel| texel.map(f32::to_bits)).collect();
        let texels = Texels { format, aspect: Aspect::All, size: [texels.len() as u32, 1], bits };
        let (numbers, channels) = (texels.numbers(), texels.channels());
        let histogram = histogram(&numbers, channels, [0.0, 1.0]);
        Found { title: String::new(), texels, numbers, span: [0.0, 4.0], non_finite: 0, histogram, near_m: 0.1 }
    }

    #[test]
    fn channels_range_and_curve_are_applied() {
        let texture = found(Format::Rgba16Float, &[[0.0, 1.0, 4.0, 0.5], [f32::NAN, 0.0, 0.0, 1.0]]);
        let natural = Look::natural(&texture);
        assert_eq!((natural.channels, natural.range, natural.srgb), ([true, true, true, false], [0.0, 1.0], true));
        assert_eq!(picture(&texture, &natural), [0, 255, 255, 255, 255, 0, 255, 255]);
        let plain = Look { range: [0.0, 4.0], srgb: false, ..natural.clone() };
        assert_eq!(picture(&texture, &plain)[..4], [0, 64, 255, 255]);
        let alpha = Look { channels: [false, false, false, true], range: [0.0, 1.0], ..plain.clone() };
        assert_eq!(picture(&texture, &alpha)[..4], [128, 128, 128, 255]);
        let no_red = Look { channels: [false, true, true, false], ..plain };
        assert_eq!(picture(&texture, &no_red)[..4], [0, 64, 255, 255]);
        assert_eq!(code(0.5, &Look { srgb: true, ..Look::default() }), 188);
    }

    #[test]
    fn depth_is_shown_as_distance() {
        let texture = found(Format::Depth32Float, &[[0.1, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]]);
        let mut look = Look { shown: Shown::Distance, ..Look::natural(&texture) };
        assert_eq!(look.whole(&texture), [0.0, 1.0]);
        look.range = [0.0, 2.0];
        assert_eq!(picture(&texture, &look), [128, 128, 128, 255, 255, 255, 255, 255]);
    }
}
