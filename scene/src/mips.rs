//! Mip levels of images: colors are averaged in linear light, normals as vectors.
//!
//! A level is the exact area average of the previous one: each texel covers `n / m` texels per axis. Odd sizes thus
//! neither shift the image nor drop an edge. Levels are computed from unrounded values and rounded once, for storage.

use std::array::from_fn;

use super::color::linear_from_srgb;
use super::texture::{Image, TextureRole};

/// Mip level of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
    /// `width * height * 4` bytes, row 0 at the top.
    pub rgba8: Vec<u8>,
}

/// Returns the number of mip levels of an image down to 1 × 1: ⌊log₂ max⌋ + 1.
#[must_use]
pub fn level_count(width: u32, height: u32) -> u32 {
    width.max(height).max(1).ilog2() + 1
}

/// Returns the mip levels of `image` below the first, largest first. Empty for an image of one texel, or one that
/// [holds them](Image::missing_levels) already.
///
/// - `Color`: averaged in linear light, weighted by alpha, so that transparent texels do not bleed into opaque ones.
/// - `Linear`: averaged as stored.
/// - `Normal`: averaged as vectors and renormalized; opposite ones average to +z.
#[must_use]
pub fn mip_levels(image: &Image, role: TextureRole) -> Vec<Level> {
    let codec = Codec::new(role);
    let Some(rgba8) = image.rgba8().filter(|_| image.missing_levels()) else { return Vec::new() };
    // The image is never converted to floats as a whole, which would need four times its bytes.
    let code = |texel: usize| from_fn(|channel| rgba8[4 * texel + channel]);
    let mut working = halved(image.width as usize, image.height as usize, |texel| codec.decode(code(texel)));
    let mut levels = Vec::new();
    loop {
        let mut rgba8 = Vec::with_capacity(working.texels.len() * 4);
        working.texels.iter().for_each(|t| rgba8.extend(codec.encode(*t)));
        levels.push(Level { width: working.width as u32, height: working.height as u32, rgba8 });
        if working.width == 1 && working.height == 1 {
            return levels;
        }
        working = working.halved();
    }
}

/// Returns the maximum bytes that [`mip_levels`] needs in addition to the image. Stored levels take a third of the
/// image; two float levels have a quarter and a sixteenth of its texels.
#[must_use]
pub fn working_bytes(width: u32, height: u32) -> u64 {
    let texels = u64::from(width) * u64::from(height);
    texels * 4 / 3 + texels * 16 / 4 + texels * 16 / 16
}

/// A float level, in the color space in which levels are averaged.
pub(super) struct FloatLevel {
    /// Width in texels.
    pub width: usize,
    /// Height in texels.
    pub height: usize,
    /// Row 0 at the top.
    pub texels: Vec<[f32; 4]>,
}

impl FloatLevel {
    /// Returns the next level: ⌊n / 2⌋ texels a side, at least 1.
    pub fn halved(&self) -> Self {
        halved(self.width, self.height, |texel| self.texels[texel])
    }
}

/// Returns the level below one of this size, whose texels are read by index.
fn halved(from_width: usize, from_height: usize, texel: impl Fn(usize) -> [f32; 4]) -> FloatLevel {
    let (width, height) = ((from_width / 2).max(1), (from_height / 2).max(1));
    let columns: Vec<Taps> = (0..width).map(|x| taps(x, from_width, width)).collect();
    let mut texels = Vec::with_capacity(width * height);
    for y in 0..height {
        let rows = taps(y, from_height, height);
        for columns in &columns {
            let mut sum = [0.0_f32; 4];
            for (row, row_weight) in rows.iter() {
                for (column, weight) in columns.iter() {
                    let texel = texel(row * from_width + column);
                    let weight = weight * row_weight;
                    sum = from_fn(|i| sum[i] + texel[i] * weight);
                }
            }
            texels.push(sum);
        }
    }
    FloatLevel { width, height, texels }
}

/// Up to three source texels along an axis, with weights that sum to 1.
struct Taps {
    first: usize,
    weights: [f32; 3],
    count: usize,
}

impl Taps {
    fn iter(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        (0..self.count).map(|i| (self.first + i, self.weights[i]))
    }
}

/// Returns the texels of `large` that texel `i` of `small` covers, where `small` is ⌊`large` / 2⌋ or both are 1.
fn taps(i: usize, large: usize, small: usize) -> Taps {
    // In units of 1 / small of a source texel, the texel covers [i·large, (i+1)·large).
    let (begin, end) = (i * large, (i + 1) * large);
    let (first, last) = (begin / small, (end - 1) / small);
    let covered = |texel: usize| ((texel + 1) * small).min(end) - (texel * small).max(begin);
    Taps {
        first,
        weights: from_fn(|k| if first + k <= last { covered(first + k) as f32 / large as f32 } else { 0.0 }),
        count: last - first + 1,
    }
}

/// Conversion between stored 8-bit values and the values that are averaged.
struct Codec {
    role: TextureRole,
    /// Linear values of the 256 sRGB steps.
    linear: Vec<f32>,
    /// Linear values halfway, in sRGB, between adjacent steps: 255 thresholds.
    thresholds: Vec<f32>,
}

impl Codec {
    fn new(role: TextureRole) -> Self {
        let linear = |code: f32| linear_from_srgb(code / 255.0);
        Self {
            role,
            linear: (0..=255_u8).map(|code| linear(f32::from(code))).collect(),
            thresholds: (0..255_u8).map(|code| linear(f32::from(code) + 0.5)).collect(),
        }
    }

    fn decode(&self, code: [u8; 4]) -> [f32; 4] {
        let unit = code.map(|c| f32::from(c) / 255.0);
        match self.role {
            TextureRole::Linear => unit,
            TextureRole::Normal => from_fn(|i| if i < 3 { 2.0 * unit[i] - 1.0 } else { unit[3] }),
            TextureRole::Color => {
                // Fully transparent texels still need a color.
                let weight = unit[3].max(FAINTEST);
                from_fn(|i| if i < 3 { self.linear[code[i] as usize] * weight } else { unit[3] })
            }
        }
    }

    fn encode(&self, value: [f32; 4]) -> [u8; 4] {
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        match self.role {
            TextureRole::Linear => value.map(byte),
            TextureRole::Normal => {
                let vector = glam::Vec3::new(value[0], value[1], value[2]);
                let unit = vector.try_normalize().unwrap_or(glam::Vec3::Z) * 0.5 + 0.5;
                [byte(unit.x), byte(unit.y), byte(unit.z), byte(value[3])]
            }
            TextureRole::Color => {
                // Averages of max(α, ε) lie between max(mean α, ε) and mean α + ε. Division by the largest possible
                // color keeps the result within 0…1.
                let weight = value[3].max(FAINTEST);
                let encode = |v: f32| {
                    let linear = v / weight;
                    self.thresholds.partition_point(|t| *t <= linear) as u8
                };
                [encode(value[0]), encode(value[1]), encode(value[2]), byte(value[3])]
            }
        }
    }
}

/// Minimum weight of a color: far below one 8-bit step of alpha.
const FAINTEST: f32 = 1.0 / 65536.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let rgba8 = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| texel(x, y)).collect();
        Image::from_rgba8("", width, height, rgba8)
    }

    #[test]
    fn every_size_ends_at_one_texel() {
        for (width, height) in [(1, 1), (1, 777), (3, 2), (256, 256), (5, 640)] {
            let image = image(width, height, |_, _| [10, 20, 30, 40]);
            let levels = mip_levels(&image, TextureRole::Color);
            assert_eq!(levels.len() as u32 + 1, level_count(width, height));
            for (i, level) in levels.iter().enumerate() {
                let side = |n: u32| (n >> (i + 1)).max(1);
                assert_eq!((level.width, level.height), (side(width), side(height)));
                assert!(level.rgba8.chunks_exact(4).all(|t| t == [10, 20, 30, 40]));
            }
        }
        assert_eq!(level_count(1, 1), 1);
        assert_eq!(level_count(1, 777), 10);
    }

    /// Alternating black and white: half the light is the sRGB value 188, not 128.
    #[test]
    fn color_is_averaged_in_linear_light() {
        let checker = image(4, 4, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] });
        let color = mip_levels(&checker, TextureRole::Color);
        assert_eq!(color[0].rgba8[..4], [188, 188, 188, 255]);
        assert_eq!(color[1].rgba8, [188, 188, 188, 255]);
        let linear = mip_levels(&checker, TextureRole::Linear);
        assert_eq!(linear[1].rgba8, [128, 128, 128, 255]);
    }

    #[test]
    fn what_is_cut_out_does_not_bleed() {
        let cut = image(2, 1, |x, _| if x == 0 { [200, 10, 10, 255] } else { [0, 255, 0, 0] });
        let level = &mip_levels(&cut, TextureRole::Color)[0];
        assert_eq!(level.rgba8, [200, 10, 10, 128]);
        let nothing = image(2, 2, |_, _| [90, 60, 30, 0]);
        assert_eq!(mip_levels(&nothing, TextureRole::Color)[0].rgba8, [90, 60, 30, 0]);
    }

    #[test]
    fn normals_stay_unit_vectors() {
        let bent = image(2, 2, |x, _| if x == 0 { [255, 128, 128, 255] } else { [128, 255, 128, 255] });
        let level = &mip_levels(&bent, TextureRole::Normal)[0];
        let n = |i: usize| f32::from(level.rgba8[i]) / 127.5 - 1.0;
        assert!(((n(0) * n(0) + n(1) * n(1) + n(2) * n(2)).sqrt() - 1.0).abs() < 0.01);
        assert!((n(0) - std::f32::consts::FRAC_1_SQRT_2).abs() < 0.01);
        let opposite = image(2, 1, |x, _| if x == 0 { [255, 0, 0, 255] } else { [0, 255, 255, 255] });
        assert_eq!(mip_levels(&opposite, TextureRole::Normal)[0].rgba8, [128, 128, 255, 255]);
    }

    /// Three texels average to one by thirds, and five to two by 2½ each: no texel is dropped, and the mean is
    /// preserved.
    #[test]
    fn odd_sizes_use_every_texel() {
        let ramp = |n: u32| image(n, 1, |x, _| [(x * 40) as u8, 0, 0, 255]);
        assert_eq!(mip_levels(&ramp(3), TextureRole::Linear)[0].rgba8[0], 40);
        let five = mip_levels(&ramp(5), TextureRole::Linear);
        // (0 + 40 + 80/2) / 2.5 = 32 and (80/2 + 120 + 160) / 2.5 = 128.
        assert_eq!((five[0].rgba8[0], five[0].rgba8[4]), (32, 128));
        assert_eq!(five[1].rgba8[0], 80);
    }
}
