//! Sizes of the levels of bloom.

use super::settings::{BloomQuality, BloomSettings};

/// Maximum side of a level in texels.
const MAX_TEXELS: f32 = 2048.0;
/// Sides of levels in low quality are multiples of this number, so that four halvings are exact.
const LOW_MULTIPLE: u32 = 16;

/// Sizes of the bloom passes for a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BloomChain {
    /// Sizes between the picture and the largest level, in texels.
    pub halves: Vec<[u32; 2]>,
    /// Size of the largest level, in texels.
    pub size: [u32; 2],
    /// Number of levels, at least one.
    pub levels: u8,
}

impl BloomChain {
    /// Returns the sizes for a picture of `size_texels`.
    pub fn new(settings: &BloomSettings, size_texels: [u32; 2]) -> Self {
        let (span, _) = BloomSettings::span(size_texels, settings.multiple_px);
        let mut picture = span.map(|side| side as u32);
        let height = settings.height_texels.clamp(1, 2048) as f32;
        let mut size = [height * span[0] / span[1], height].map(|side| side.clamp(1.0, MAX_TEXELS));
        let most = (size[0].max(size[1]) as u32).ilog2() as u8 + 1;
        let mut levels = settings.levels.clamp(1, BloomSettings::MAX_LEVELS).min(most);
        if settings.quality == BloomQuality::Low {
            size = size.map(|side| (side as u32 / LOW_MULTIPLE * LOW_MULTIPLE).max(LOW_MULTIPLE) as f32);
        }
        let mut halves = Vec::new();
        while (0..2).any(|i| 2.0 * size[i] < picture[i] as f32) {
            if settings.quality == BloomQuality::High {
                if size.iter().any(|side| 2.0 * side > MAX_TEXELS) {
                    break;
                }
                size = size.map(|side| 2.0 * side);
                levels = (levels + 1).min(BloomSettings::MAX_LEVELS);
            } else {
                picture = picture.map(|side| (side / 2).max(1));
                halves.push(picture);
            }
        }
        Self { halves, size: size.map(|side| (side as u32).max(1)), levels }
    }

    /// Returns the size of a level in texels.
    pub fn level_size(&self, level: u8) -> [u32; 2] {
        self.size.map(|side| (side >> level).max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(quality: BloomQuality, size: [u32; 2]) -> BloomChain {
        BloomChain::new(&BloomSettings { quality, ..BloomSettings::DEFAULT }, size)
    }

    /// Sizes worked out by hand from Filament's rules.
    #[test]
    fn sizes_are_filaments() {
        use BloomQuality::{High, Low, Medium};
        for (quality, picture, halves, size, levels) in [
            (High, [640, 368], vec![], [667, 384], 6),
            (Low, [640, 368], vec![], [656, 384], 6),
            (Low, [1920, 1080], vec![[960, 540]], [672, 384], 6),
            (Medium, [1920, 1080], vec![[960, 540]], [682, 384], 6),
            (High, [1920, 1080], vec![], [1365, 768], 7),
            // Two more would be wider than may be.
            (High, [7680, 1080], vec![], [2048, 384], 6),
        ] {
            assert_eq!(chain(quality, picture), BloomChain { halves, size, levels }, "{quality:?} {picture:?}");
        }
        let padded = BloomSettings { multiple_px: 16, quality: High, ..BloomSettings::DEFAULT };
        assert_eq!(BloomChain::new(&padded, [640, 360]), chain(High, [640, 368]));
    }

    /// Every size has at least one level, and every level at least one texel.
    #[test]
    fn hard_case_52_every_level_has_texels() {
        for quality in [BloomQuality::Low, BloomQuality::Medium, BloomQuality::High] {
            for picture in [[0, 0], [1, 1], [1, 777], [3, 2], [16384, 1]] {
                for height_texels in [0, 1, 17, 4000] {
                    let settings = BloomSettings { quality, height_texels, levels: 200, ..BloomSettings::DEFAULT };
                    let chain = BloomChain::new(&settings, picture);
                    assert!((1..=BloomSettings::MAX_LEVELS).contains(&chain.levels), "{picture:?}: {chain:?}");
                    let sides = |level| chain.level_size(level).into_iter().all(|side| (1..=2048).contains(&side));
                    assert!((0..chain.levels).all(sides) && chain.halves.iter().flatten().all(|side| *side > 0));
                    let largest = *chain.size.iter().max().expect("two sides");
                    assert!(largest >> (chain.levels - 1) >= 1, "no level repeats another: {chain:?}");
                }
            }
        }
    }
}
