//! Mapping from texel values to displayed colors: channels, range and curve.

use super::read::Found;
use framegraph::Numeric;

/// Quantity that a picture of a texture shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// Values of the channels.
    #[default]
    Values,
    /// Distance from the camera in meters, of reversed depth with the far plane at infinity.
    Distance,
    /// First selected channel in the Turbo color map (Mikhailov, 2019).
    FalseColor,
}

/// Mapping from texel values to displayed colors.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Displayed quantity.
    pub shown: Shown,
    /// Displayed channels: red, green, blue, alpha. A single one is shown as gray.
    pub channels: [bool; 4],
    /// Values shown as black and as white, or as the first and the last color.
    pub range: [f32; 2],
    /// Encodes linear light as sRGB.
    pub srgb: bool,
}

impl Default for Look {
    fn default() -> Self {
        Self { shown: Shown::Values, channels: [true, true, true, false], range: [0.0, 1.0], srgb: false }
    }
}

impl Look {
    /// Returns the usual look of a texture.
    ///
    /// - Colors are shown from 0 to 1; light as sRGB.
    /// - Depth, and floats with fewer than three channels, are shown from their minimum to their maximum.
    /// - Integers and stencil are shown in false color.
    pub fn natural(found: &Found) -> Self {
        let format = found.texels.format;
        let count = found.channels();
        let channels = [0, 1, 2, 3].map(|channel| channel < count.min(3));
        let is_normalized = format!("{format:?}").contains("norm");
        match found.texels.numeric() {
            Numeric::Uint | Numeric::Sint => {
                let channels = [true, false, false, false];
                Self { shown: Shown::FalseColor, channels, range: apart(found.span), srgb: false }
            }
            Numeric::Float if is_normalized || count >= 3 => {
                Self { channels, srgb: format.is_srgb() || !is_normalized, ..Self::default() }
            }
            Numeric::Float | Numeric::Depth => Self { channels, range: apart(found.span), ..Self::default() },
        }
    }

    /// Returns the first displayed channel.
    pub fn channel(&self) -> usize {
        self.channels.iter().position(|on| *on).unwrap_or(0)
    }

    /// Returns the range that shows every value of a texture.
    pub fn whole(&self, found: &Found) -> [f32; 2] {
        if self.shown == Shown::Distance {
            let far_m = found.numbers.iter().map(|texel| found.near_m / texel[0]).filter(|m| m.is_finite());
            return [0.0, far_m.fold(found.near_m, f32::max)];
        }
        apart(found.span)
    }
}

/// Makes a range nonempty.
fn apart([low, high]: [f32; 2]) -> [f32; 2] {
    if low < high { [low, high] } else { [low, low + 1.0] }
}
