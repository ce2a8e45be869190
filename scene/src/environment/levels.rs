//! Mip levels of an environment map as half floats for the GPU.

use std::borrow::Cow;

use half::f16;

use super::equirect::EquirectMap;
use crate::mips::FloatLevel;

/// The largest finite half float.
const F16_MAX: f32 = 65504.0;

/// One level of an environment map: RGBA16F texels, row 0 at the top, alpha 1.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceLevel {
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
    /// `width * height * 4` half floats, 0…65504.
    pub rgba16f: Vec<f16>,
}

impl EquirectMap {
    /// Returns the full mip chain down to 1 × 1, this map first.
    ///
    /// Each level averages radiance by solid angle, so that stretched rows at the poles are not overweighted. The
    /// single texel of the last level is the average over the sphere. Averages are computed in f32 and clamped to half
    /// floats afterwards. A sun that is clamped in the first level thus keeps its energy in the others.
    #[must_use]
    pub fn radiance_levels(&self) -> Vec<RadianceLevel> {
        let mut working = self.weighted();
        let mut levels = vec![half_floats(&working)];
        while working.width > 1 || working.height > 1 {
            working = working.halved();
            levels.push(half_floats(&working));
        }
        levels
    }

    /// Returns the map, or the first of its mip levels of at most `max_width` × `max_width / 2` texels. Levels are
    /// averaged by solid angle in f32. The average over the sphere is preserved, exactly where sizes halve without
    /// remainder.
    #[must_use]
    pub fn reduced(&self, max_width: u32) -> Cow<'_, Self> {
        let (max_width, max_height) = (max_width.max(1) as usize, (max_width as usize / 2).max(1));
        if self.width() as usize <= max_width && self.height() as usize <= max_height {
            return Cow::Borrowed(self);
        }
        let mut working = self.weighted();
        while working.width > max_width || working.height > max_height {
            working = working.halved();
        }
        let texels = working.texels.iter().map(|&[r, g, b, w]| [r / w, g / w, b / w, 1.0]).collect();
        Cow::Owned(Self::new(working.width as u32, working.height as u32, texels))
    }

    /// Returns radiance times the solid angle of its row, relative to the equator; alpha holds the weight.
    fn weighted(&self) -> FloatLevel {
        let height = f64::from(self.height());
        let edge = |y: u32| (f64::from(y) / height * std::f64::consts::PI).cos();
        let width = self.width() as usize;
        let mut working =
            FloatLevel { width, height: self.height() as usize, texels: Vec::with_capacity(self.texels().len()) };
        let widest = 2.0 * (std::f64::consts::FRAC_PI_2 / height).sin();
        for (y, row) in (0..).zip(self.texels().chunks_exact(width)) {
            let weight = ((edge(y) - edge(y + 1)) / widest) as f32;
            let weighted = |t: &[f32; 4]| [t[0] * weight, t[1] * weight, t[2] * weight, weight];
            working.texels.extend(row.iter().map(weighted));
        }
        working
    }
}

fn half_floats(working: &FloatLevel) -> RadianceLevel {
    let half = |v: f32| f16::from_f32(v.clamp(0.0, F16_MAX));
    RadianceLevel {
        width: working.width as u32,
        height: working.height as u32,
        rgba16f: working
            .texels
            .iter()
            .flat_map(|&[r, g, b, w]| [half(r / w), half(g / w), half(b / w), f16::ONE])
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_last_level_is_the_average_over_the_sphere() {
        let map = EquirectMap::from_fn(64, 32, |d| DVec3::new(1.0, 1.0 + d.y, d.x.max(0.0) * 8.0));
        let levels = map.radiance_levels();
        assert_eq!(levels.len(), 7);
        let last = &levels[6];
        assert_eq!((last.width, last.height), (1, 1));
        for (channel, exact) in map.average().to_array().into_iter().enumerate() {
            let got = last.rgba16f[channel].to_f64();
            // Half a unit in the last place of a half float.
            assert!((got / exact - 1.0).abs() < 1e-3, "{channel}: {got} for {exact}");
        }
        assert!(levels.iter().all(|l| l.rgba16f.chunks(4).all(|t| t[3] == f16::ONE)));
    }

    #[test]
    fn reducing_keeps_the_average_and_small_maps() {
        // Odd sizes split rows, whose solid angle is not uniform over their height.
        for (width, into, bound) in [(256, (64, 32), 1e-6), (300, (37, 18), 2e-3)] {
            let radiance = |d: DVec3| DVec3::new(1.0, 1.0 + d.y, d.x.max(0.0) * 8.0);
            let map = EquirectMap::from_fn(width, width / 2, radiance);
            assert!(matches!(map.reduced(width), Cow::Borrowed(_)));
            let small = map.reduced(64);
            assert_eq!((small.width(), small.height()), into);
            let apart = (small.average() - map.average()).length();
            assert!(apart < bound, "{width}: {} {}", small.average(), map.average());
        }
    }

    /// A texel beyond the half-float range is clamped; the averages in coarser levels are not.
    #[test]
    fn energy_survives_the_cut() {
        let mut texels = vec![[0.0, 0.0, 0.0, 1.0]; 8 * 4];
        texels[8] = [1e6, 1e6, 1e6, 1.0];
        let levels = EquirectMap::new(8, 4, texels).radiance_levels();
        assert_eq!(levels[0].rgba16f[8 * 4].to_f32(), F16_MAX);
        // The row below the pole weighs (cos 45° − cos 90°), the first (1 − cos 45°); one of two texels a row is lit.
        // The average is 1e6 / 2 · 0.7071, which is clamped too.
        assert_eq!(levels[1].rgba16f[0].to_f32(), F16_MAX);
        // An eighth of a sphere: 1e6 / 8 · 0.7071 / 2 = 44194.
        let last = levels[3].rgba16f[0].to_f32();
        assert!((last / 44_194.0 - 1.0).abs() < 1e-3, "{last}");
        assert!(levels.iter().flat_map(|l| &l.rgba16f).all(|v| v.is_finite()));
    }
}
