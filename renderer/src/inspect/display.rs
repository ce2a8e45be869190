//! Conversion of texels to an image for viewing: exposure, linear depth, false color, single channels.
//!
//! In every mode, texels with NaN or infinity are magenta and counted.

use super::false_color::turbo;
use super::texels::Texels;
use crate::device::pixels::srgb_from_linear;
use framegraph::{Format, Numeric};
use std::str::FromStr;

/// Mapping from texel values to colors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DisplayMode {
    /// Chooses the mode by format.
    ///
    /// - Normalized 8-bit colors are shown unchanged.
    /// - Float colors with at least three channels are shown at exposure 0.
    /// - Depth, and floats with fewer channels, are stretched.
    /// - Integers and stencil are shown in false color.
    #[default]
    Auto,
    /// Linear color times 2^`stops`, clamped to 0…1 and encoded as sRGB.
    Color {
        /// Exposure in stops.
        stops: f32,
    },
    /// Distance from the camera as gray, linear from 0 to the maximum finite distance; white for the far plane. Expects
    /// reversed depth with the far plane at infinity.
    Depth {
        /// Distance of the near plane in meters; `None` uses the caller's value.
        near_m: Option<f32>,
    },
    /// One channel as gray, linear from its minimum to its maximum finite value.
    Stretch {
        /// Channel to show.
        channel: Channel,
    },
    /// One channel as gray, with values 0…1.
    Plain {
        /// Channel to show.
        channel: Channel,
    },
    /// One channel in the Turbo color map (Mikhailov, 2019).
    False {
        /// Channel to show.
        channel: Channel,
        /// Values of the first and the last color; `None` uses the minimum and maximum finite value.
        range: Option<[f32; 2]>,
    },
}

/// A channel of a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are self-explanatory")]
pub enum Channel {
    #[default]
    Red,
    Green,
    Blue,
    Alpha,
}

/// An image of texels.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayImage {
    /// sRGB-encoded RGBA, four bytes per texel, opaque.
    pub rgba8: Vec<u8>,
    /// Values that are shown as the first and the last color; in meters for depth.
    pub range: [f32; 2],
    /// Number of texels with NaN or infinity.
    pub non_finite: usize,
}

/// Color of texels with NaN or infinity.
const LOUD: [u8; 3] = [255, 0, 255];

/// Error: the text is not a display mode.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is not a display mode; use auto, color[:STOPS], depth[:NEAR_M], stretch[:r|g|b|a], plain[:r|g|b|a] or \
     false[:r|g|b|a][:LOW,HIGH]"
)]
pub struct DisplayModeError {
    /// The text that was given.
    pub text: String,
}

impl std::fmt::Debug for DisplayModeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl FromStr for DisplayMode {
    type Err = DisplayModeError;

    fn from_str(text: &str) -> Result<Self, DisplayModeError> {
        let refuse = || DisplayModeError { text: text.to_owned() };
        let number = |word: &str| word.parse::<f32>().ok().filter(|n| n.is_finite()).ok_or_else(refuse);
        let mut words = text.split(':');
        let mode = words.next().unwrap_or_default();
        let rest: Vec<&str> = words.collect();
        let channel = |word: Option<&&str>| word.map_or(Ok(Channel::Red), |w| Channel::named(w).ok_or_else(refuse));
        Ok(match (mode, &rest[..]) {
            ("auto", []) => Self::Auto,
            ("color", []) => Self::Color { stops: 0.0 },
            ("color", [stops]) => Self::Color { stops: number(stops)? },
            ("depth", []) => Self::Depth { near_m: None },
            ("depth", [near]) => {
                Self::Depth { near_m: Some(number(near).ok().filter(|n| *n > 0.0).ok_or_else(refuse)?) }
            }
            ("stretch", [] | [_]) => Self::Stretch { channel: channel(rest.first())? },
            ("plain", [] | [_]) => Self::Plain { channel: channel(rest.first())? },
            ("false", [] | [_] | [_, _]) => {
                let named = rest.first().and_then(|word| Channel::named(word));
                let range = &rest[usize::from(named.is_some())..];
                let range = match range {
                    [] => None,
                    [range] => {
                        let (low, high) = range.split_once(',').ok_or_else(refuse)?;
                        Some([number(low)?, number(high)?]).filter(|[low, high]| low < high)
                    }
                    _ => return Err(refuse()),
                };
                if range.is_none() && rest.len() > usize::from(named.is_some()) {
                    return Err(refuse());
                }
                Self::False { channel: named.unwrap_or_default(), range }
            }
            _ => return Err(refuse()),
        })
    }
}

impl Channel {
    fn named(word: &str) -> Option<Self> {
        Some(match word {
            "r" => Self::Red,
            "g" => Self::Green,
            "b" => Self::Blue,
            "a" => Self::Alpha,
            _ => return None,
        })
    }
}

impl Texels {
    /// Converts the texels to an image. `near_m` is the distance of the near plane in meters, for depth modes without
    /// one.
    pub fn display(&self, mode: DisplayMode, near_m: f32) -> DisplayImage {
        let numbers = self.numbers();
        match mode {
            DisplayMode::Auto => self.display(self.natural(), near_m),
            DisplayMode::Color { stops } => {
                // Normalized linear formats are shown unchanged.
                let codes = self.is_display() && !self.format.is_srgb();
                let scale = stops.exp2();
                let encode =
                    |c: f32| quantized(if codes { c * scale } else { srgb_from_linear((c * scale).clamp(0.0, 1.0)) });
                let channels = self.channels().min(3);
                paint(&numbers, channels, [0.0, 1.0], |[r, g, b, _]| [encode(*r), encode(*g), encode(*b)])
            }
            DisplayMode::Depth { near_m: own } => {
                let near_m = own.unwrap_or(near_m);
                let distances = self.distances_m(near_m).unwrap_or_else(|| numbers.iter().map(|n| n[0]).collect());
                let [_, far] = extent(distances.iter().copied());
                let gray = |distance: f32| if far > 0.0 { quantized(distance / far) } else { 0 };
                // An infinite distance is valid and white; only NaN is marked.
                let rows: Vec<_> = distances.iter().zip(&numbers).map(|(d, n)| [n[0], *d, 0.0, 0.0]).collect();
                paint(&rows, 1, [0.0, far], |[_, distance, ..]| [gray(*distance); 3])
            }
            DisplayMode::Stretch { channel } => {
                let range = self.extent_of(&numbers, channel);
                paint(&numbers, self.looked_at(channel), range, |n| [quantized(within(n[channel as usize], range)); 3])
            }
            DisplayMode::Plain { channel } => {
                paint(&numbers, self.looked_at(channel), [0.0, 1.0], |n| [quantized(n[channel as usize]); 3])
            }
            DisplayMode::False { channel, range } => {
                let range = range.unwrap_or_else(|| self.extent_of(&numbers, channel));
                paint(&numbers, self.looked_at(channel), range, |n| turbo(within(n[channel as usize], range)))
            }
        }
    }

    /// Returns the mode that `Auto` selects.
    fn natural(&self) -> DisplayMode {
        let channel = Channel::Red;
        match self.numeric() {
            Numeric::Uint | Numeric::Sint => DisplayMode::False { channel, range: None },
            Numeric::Depth => DisplayMode::Stretch { channel },
            Numeric::Float if self.channels() < 3 && !self.is_display() => DisplayMode::Stretch { channel },
            Numeric::Float => DisplayMode::Color { stops: 0.0 },
        }
    }

    /// Returns whether the format is unsigned normalized, so that texels can be shown unchanged.
    fn is_display(&self) -> bool {
        use Format::*;
        matches!(
            self.format,
            R8Unorm | Rg8Unorm | Rgba8Unorm | Rgba8UnormSrgb | Bgra8Unorm | Bgra8UnormSrgb | Rgb10a2Unorm
        )
    }

    /// Returns the number of channels that are checked for NaN and infinity.
    fn looked_at(&self, channel: Channel) -> usize {
        self.channels().max(channel as usize + 1)
    }

    fn extent_of(&self, numbers: &[[f32; 4]], channel: Channel) -> [f32; 2] {
        extent(numbers.iter().map(|n| n[channel as usize]))
    }
}

/// Colors all texels, and marks those with NaN or infinity in the first `channels`.
fn paint(numbers: &[[f32; 4]], channels: usize, range: [f32; 2], color: impl Fn(&[f32; 4]) -> [u8; 3]) -> DisplayImage {
    let mut shown = DisplayImage { rgba8: Vec::with_capacity(numbers.len() * 4), range, non_finite: 0 };
    for texel in numbers {
        // Only NaN and infinity have all exponent bits set.
        let bad = texel.iter().take(channels).any(|n| n.to_bits() & 0x7f80_0000 == 0x7f80_0000);
        shown.non_finite += usize::from(bad);
        shown.rgba8.extend(if bad { LOUD } else { color(texel) });
        shown.rgba8.push(255);
    }
    shown
}

/// Returns the minimum and the maximum finite value; zeros if there is none.
fn extent(numbers: impl Iterator<Item = f32>) -> [f32; 2] {
    let finite = numbers.filter(|n| n.is_finite());
    let found = finite
        .fold(None, |found: Option<[f32; 2]>, n| Some(found.map_or([n, n], |[low, high]| [low.min(n), high.max(n)])));
    found.unwrap_or_default()
}

/// Maps `x` from the range to 0…1; returns 0 for an empty range.
fn within(x: f32, [low, high]: [f32; 2]) -> f32 {
    if high > low { (x - low) / (high - low) } else { 0.0 }
}

fn quantized(x: f32) -> u8 {
    (x.clamp(0.0, 1.0) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::Aspect;

    fn of(format: Format, numbers: &[[f32; 4]]) -> Texels {
        let bits = numbers.iter().map(|n| n.map(f32::to_bits)).collect();
        Texels { format, aspect: Aspect::All, size: [numbers.len() as u32, 1], bits }
    }

    fn first_channel(shown: &DisplayImage) -> Vec<u8> {
        shown.rgba8.chunks_exact(4).map(|t| t[0]).collect()
    }

    #[test]
    fn exposure_is_in_stops_and_light_is_encoded() {
        let light = of(Format::Rgba16Float, &[[0.25, 1.0, 0.0, 1.0]]);
        // In sRGB, 0.25 is 137 (0.5371 · 255) and 0.5 is 188.
        assert_eq!(light.display(DisplayMode::Auto, 1.0).rgba8, [137, 255, 0, 255]);
        assert_eq!(light.display(DisplayMode::Color { stops: 1.0 }, 1.0).rgba8, [188, 255, 0, 255]);
        let codes = of(Format::Rgba8Unorm, &[[0.25, 1.0, 0.0, 1.0]]);
        assert_eq!(codes.display(DisplayMode::Auto, 1.0).rgba8, [64, 255, 0, 255], "normalized values are unchanged");
    }

    #[test]
    fn depth_is_linear_in_distance() {
        // With the near plane at 0.1 m, the depths are 0.1, 0.2 and 0.4 m; 0 is infinitely far.
        let depth = of(Format::Depth32Float, &[1.0, 0.5, 0.25, 0.0].map(|d| [d, 0.0, 0.0, 1.0]));
        let shown = depth.display(DisplayMode::Depth { near_m: Some(0.1) }, 9.0);
        assert_eq!((first_channel(&shown), shown.range), (vec![64, 128, 255, 255], [0.0, 0.4]));
        assert_eq!(shown.non_finite, 0);
        let stretched = depth.display(DisplayMode::Auto, 9.0);
        assert_eq!((first_channel(&stretched), stretched.range), (vec![255, 128, 64, 0], [0.0, 1.0]));
    }

    #[test]
    fn non_finite_values_are_magenta_in_every_mode() {
        let modes = ["auto", "color:-2", "stretch", "plain:g", "false:r:0,1", "false"];
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let light = of(Format::Rgba16Float, &[[0.0, bad, 0.0, 1.0], [0.0, 0.5, 0.0, 1.0]]);
            for mode in modes {
                let shown = light.display(mode.parse().expect("a mode"), 1.0);
                assert_eq!((&shown.rgba8[..3], shown.non_finite), (&LOUD[..], 1), "{mode} {bad}");
                assert_ne!(&shown.rgba8[4..7], &LOUD[..], "{mode}");
            }
        }
        let depth = of(Format::Depth32Float, &[[f32::NAN, 0.0, 0.0, 1.0]]);
        assert_eq!(depth.display(DisplayMode::Depth { near_m: None }, 1.0).non_finite, 1);
    }

    #[test]
    fn integers_are_shown_in_false_color() {
        let bits = [0u32, 5, 10].map(|n| [n, 0, 0, 1]).to_vec();
        let ids = Texels { format: Format::R32Uint, aspect: Aspect::All, size: [3, 1], bits };
        let shown = ids.display(DisplayMode::Auto, 1.0);
        let expected: Vec<u8> = [0.0, 0.5, 1.0].into_iter().flat_map(|x| turbo(x).into_iter().chain([255])).collect();
        assert_eq!((shown.rgba8, shown.range), (expected, [0.0, 10.0]));
    }

    #[test]
    fn display_modes_are_parsed() {
        let read = |text: &str| text.parse::<DisplayMode>();
        assert_eq!(read("depth:0.5"), Ok(DisplayMode::Depth { near_m: Some(0.5) }));
        assert_eq!(read("false:b:-1,2"), Ok(DisplayMode::False { channel: Channel::Blue, range: Some([-1.0, 2.0]) }));
        assert_eq!(read("false:0,2"), Ok(DisplayMode::False { channel: Channel::Red, range: Some([0.0, 2.0]) }));
        assert_eq!(read("stretch:a"), Ok(DisplayMode::Stretch { channel: Channel::Alpha }));
        for wrong in ["", "sepia", "color:x", "depth:0", "depth:-1", "plain:q", "false:2,1", "false:r:1", "false:r:g:b"]
        {
            let message = read(wrong).map_err(|e| e.to_string());
            assert!(message.as_ref().is_err_and(|e| e.contains(&format!("`{wrong}`"))), "{wrong}: {message:?}");
        }
    }
}
