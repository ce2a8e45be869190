//! Repair of invalid texels in environment maps: negative radiance from lossy compression, infinities from overflow,
//! and NaN.

use std::borrow::Cow;

use super::equirect::EquirectMap;

/// Maximum radiance of a texel. Above the radiance of the sun's disc (1.6e9 nits), and small enough that sums and
/// squares stay finite in f32.
pub const MAX_RADIANCE: f32 = 1e10;

/// Replacement for an infinite channel: infinities in files are values that overflowed a half float.
const INFINITY_STANDS_FOR: f32 = 65504.0;

/// Statistics of a repair. Each texel counts once, in its most severe class.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cleaning {
    /// Texels with a NaN or infinite channel.
    pub non_finite: usize,
    /// Other texels with a negative channel.
    pub negative: usize,
    /// The most negative channel value.
    pub lowest: f32,
    /// Other texels with a channel above [`MAX_RADIANCE`].
    pub excessive: usize,
}

impl Cleaning {
    /// Returns the number of repaired texels.
    #[must_use]
    pub fn clamped(&self) -> usize {
        self.non_finite + self.negative + self.excessive
    }

    /// Returns the warnings for `file` with `texels` texels; empty if nothing was repaired.
    pub fn warnings(&self, file: &str, texels: usize) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.negative > 0 {
            warnings.push(format!(
                "{file}: {} of {texels} texels had negative radiance (lowest {}) and were clamped to 0",
                self.negative, self.lowest
            ));
        }
        if self.non_finite > 0 {
            warnings.push(format!(
                "{file}: {} of {texels} texels were not finite and were clamped (NaN to 0, \
                 infinity to {INFINITY_STANDS_FOR})",
                self.non_finite
            ));
        }
        if self.excessive > 0 {
            warnings.push(format!(
                "{file}: {} of {texels} texels exceeded {MAX_RADIANCE:e} and were clamped to it",
                self.excessive
            ));
        }
        warnings
    }
}

/// Clamps every channel to 0…[`MAX_RADIANCE`] and sets alpha to 1. NaN is detected with `is_finite`, not by comparison.
pub(super) fn clean(texels: &mut [[f32; 4]]) -> Cleaning {
    let mut cleaning = Cleaning::default();
    for texel in texels {
        let [r, g, b, _] = *texel;
        let rgb = [r, g, b];
        if rgb.iter().any(|c| !c.is_finite()) {
            cleaning.non_finite += 1;
        } else if rgb.iter().any(|c| *c < 0.0) {
            cleaning.negative += 1;
            cleaning.lowest = rgb.iter().fold(cleaning.lowest, |a, b| a.min(*b));
        } else if rgb.iter().any(|c| *c > MAX_RADIANCE) {
            cleaning.excessive += 1;
        }
        let [r, g, b] = rgb.map(|c| {
            if c == f32::INFINITY {
                INFINITY_STANDS_FOR
            } else if c.is_finite() {
                c.clamp(0.0, MAX_RADIANCE)
            } else {
                0.0
            }
        });
        *texel = [r, g, b, 1.0];
    }
    cleaning
}

/// Returns the map itself if every texel is valid, otherwise a repaired copy, with the statistics of the repair.
pub fn cleaned(map: &EquirectMap) -> (Cow<'_, EquirectMap>, Cleaning) {
    // Comparisons with NaN are false.
    let sound = |c: &f32| *c >= 0.0 && *c <= MAX_RADIANCE;
    if map.texels().iter().all(|[r, g, b, _]| sound(r) && sound(g) && sound(b)) {
        return (Cow::Borrowed(map), Cleaning::default());
    }
    let mut texels = map.texels().to_vec();
    let cleaning = clean(&mut texels);
    (Cow::Owned(EquirectMap::new(map.width(), map.height(), texels)), cleaning)
}
