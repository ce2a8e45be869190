//! Sub-pixel offsets of frames, and the filter of their samples to pixel centers.

use crate::settings::place::Words;
use glam::{DVec2, Vec4};

/// Sequence of sub-pixel offsets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum JitterPattern {
    /// Four positions on a rotated grid.
    Rgss4,
    /// Four positions on a regular grid, alternating between opposite ones.
    Helix4,
    /// Eight positions of the Halton sequence with bases 2 and 3.
    Halton8,
    /// Sixteen positions of the Halton sequence.
    #[default]
    Halton16,
    /// Thirty-two positions of the Halton sequence.
    Halton32,
}

/// Skipped numbers of the Halton sequence: the mean of the following ones is closer to the center, as in Filament.
const SKIPPED: u32 = 409;

impl Words for JitterPattern {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("rgss4", Self::Rgss4),
        ("helix4", Self::Helix4),
        ("halton8", Self::Halton8),
        ("halton16", Self::Halton16),
        ("halton32", Self::Halton32),
    ];
}

impl JitterPattern {
    /// Returns the length of the sequence in frames.
    pub const fn length(self) -> u32 {
        match self {
            Self::Rgss4 | Self::Helix4 => 4,
            Self::Halton8 => 8,
            Self::Halton16 => 16,
            Self::Halton32 => 32,
        }
    }

    /// Returns the offset of a frame to the right and up, in pixels, -0.5 to 0.5.
    pub fn at(self, frame: u32) -> DVec2 {
        let index = frame % self.length();
        let eighths = |places: [[f64; 2]; 4]| DVec2::from_array(places[index as usize]) / 8.0;
        let place = match self {
            Self::Rgss4 => eighths([[5.0, 1.0], [1.0, 3.0], [7.0, 5.0], [3.0, 7.0]]),
            Self::Helix4 => eighths([[2.0, 2.0], [6.0, 6.0], [2.0, 6.0], [6.0, 2.0]]),
            _ => DVec2::new(halton(index + SKIPPED, 2), halton(index + SKIPPED, 3)),
        };
        place - 0.5
    }
}

/// Returns the radical inverse of a number.
fn halton(mut index: u32, base: u32) -> f64 {
    let (mut sum, mut share) = (0.0, 1.0);
    while index > 0 {
        share /= f64::from(base);
        sum += share * f64::from(index % base);
        index /= base;
    }
    sum
}

/// Returns the weights of a texel and its neighbors, row by row from the top left. They filter the color at the pixel
/// center of a picture that is offset by `jitter_px` to the right and up. The filter is a Gaussian as wide as a
/// Blackman-Harris window of 3.3 pixels (Karis), scaled by `width`. The weights sum to 1.
pub(super) fn weights(jitter_px: DVec2, width: f64) -> [Vec4; 3] {
    let bell = |index: usize| {
        let neighbor = DVec2::new((index % 3) as f64 - 1.0, 1.0 - (index / 3) as f64);
        (-2.29 * ((neighbor - jitter_px) / width).length_squared()).exp()
    };
    let bells: [f64; 9] = std::array::from_fn(bell);
    let sum: f64 = bells.iter().sum();
    let of = |row: usize| {
        Vec4::from_array(std::array::from_fn(|i| bells.get(4 * row + i).map_or(0.0, |b| (b / sum) as f32)))
    };
    [of(0), of(1), of(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each pattern covers the pixel: distinct positions with their mean at the center.
    #[test]
    fn patterns_go_about_the_pixel() {
        assert_eq!([1, 2, 3].map(|index| halton(index, 2)), [0.5, 0.25, 0.75]);
        assert!((halton(5, 3) - 7.0 / 9.0).abs() < 1e-15);
        for (_, pattern) in JitterPattern::WORDS {
            let count = pattern.length();
            let places: Vec<DVec2> = (0..count).map(|frame| pattern.at(frame)).collect();
            assert_eq!(pattern.at(count + 1), places[1], "{pattern:?} begins anew");
            assert!(places.iter().all(|p| p.abs().max_element() <= 0.5));
            let mean = places.iter().sum::<DVec2>() / f64::from(count);
            assert!(mean.length() < 0.05, "{pattern:?}: {mean}");
            let nearest = |i: usize| places[..i].iter().map(|p| p.distance(places[i])).fold(1.0, f64::min);
            assert!((1..places.len()).all(|i| nearest(i) > 0.05), "{pattern:?}");
        }
    }

    #[test]
    fn weights_lean_to_where_the_middle_went() {
        let of = |jitter: DVec2| weights(jitter, 1.0).iter().flat_map(Vec4::to_array).collect::<Vec<f32>>();
        let even = of(DVec2::ZERO);
        assert!((even.iter().sum::<f32>() - 1.0).abs() < 1e-6 && even[9..] == [0.0; 3]);
        assert_eq!((even[1], even[3], even[0]), (even[7], even[5], even[8]));
        // The picture moved to the right and up, and so did the pixel center.
        let moved = of(DVec2::new(0.3, 0.2));
        assert!(moved[5] > moved[3] && moved[1] > moved[7] && moved[2] > moved[0].max(moved[8]), "{moved:?}");
        let wide = weights(DVec2::ZERO, 2.0);
        assert!(wide[1].x < even[4], "a wider bell has less in its middle");
    }
}
