//! Writer of Khronos cube textures, from the formats' specifications, without code shared with the reader.

use glam::{DVec2, DVec3};

/// Right, down and forward axes of each face: OpenGL 4.6, table 8.19.
const FACES: [[DVec3; 3]; 6] = [
    [DVec3::NEG_Z, DVec3::NEG_Y, DVec3::X],
    [DVec3::Z, DVec3::NEG_Y, DVec3::NEG_X],
    [DVec3::X, DVec3::Z, DVec3::Y],
    [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
    [DVec3::X, DVec3::NEG_Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z],
];

/// A cube texture to write.
#[derive(Clone, Debug)]
pub struct CubeFile {
    /// Width of the faces at level 0, in texels.
    pub size: u32,
    /// Texels of each level in file order: faces, rows, columns.
    pub levels: Vec<Vec<DVec3>>,
    /// Value of the metadata key `sh`.
    pub sh: Option<String>,
}

/// Texel format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texels {
    /// Four half floats.
    Rgba16,
    /// Three half floats.
    Rgb16,
    /// Four floats.
    Rgba32,
    /// Three floats.
    Rgb32,
    /// Unsigned floats of 11, 11 and 10 bits.
    Rg11b10,
    /// Three mantissas of 9 bits with a shared exponent of 5 bits.
    Rgb9e5,
}

impl Texels {
    /// All formats.
    pub const ALL: [Self; 6] = [Self::Rgba16, Self::Rgb16, Self::Rgba32, Self::Rgb32, Self::Rg11b10, Self::Rgb9e5];

    /// Returns OpenGL's internal format and Vulkan's format.
    const fn numbers(self) -> [u32; 2] {
        match self {
            Self::Rgba16 => [0x881A, 97],
            Self::Rgb16 => [0x881B, 90],
            Self::Rgba32 => [0x8814, 109],
            Self::Rgb32 => [0x8815, 106],
            Self::Rg11b10 => [0x8C3A, 122],
            Self::Rgb9e5 => [0x8C3D, 123],
        }
    }

    /// Returns the maximum rounding error, relative to the brightest channel.
    pub const fn error(self) -> f64 {
        match self {
            Self::Rgba16 | Self::Rgb16 => 1.0 / 2048.0,
            Self::Rgba32 | Self::Rgb32 => 1e-7,
            Self::Rg11b10 => 1.0 / 64.0,
            Self::Rgb9e5 => 1.0 / 256.0,
        }
    }

    fn write(self, color: DVec3, big_endian: bool, out: &mut Vec<u8>) {
        let mut word = |number: u64, bytes: usize| {
            let all = number.to_be_bytes();
            let mut part = all[8 - bytes..].to_vec();
            if !big_endian {
                part.reverse();
            }
            out.extend(part);
        };
        let rgb = color.to_array();
        let rgba = [rgb[0], rgb[1], rgb[2], 1.0];
        match self {
            Self::Rgba16 => rgba.iter().for_each(|c| word(small_float(*c, 10), 2)),
            Self::Rgb16 => rgb.iter().for_each(|c| word(small_float(*c, 10), 2)),
            Self::Rgba32 => rgba.iter().for_each(|c| word(u64::from((*c as f32).to_bits()), 4)),
            Self::Rgb32 => rgb.iter().for_each(|c| word(u64::from((*c as f32).to_bits()), 4)),
            Self::Rg11b10 => {
                let [r, g, b] = [small_float(rgb[0], 6), small_float(rgb[1], 6), small_float(rgb[2], 5)];
                word(r + (g << 11) + (b << 22), 4);
            }
            Self::Rgb9e5 => {
                // The shared exponent leaves room for the brightest channel after rounding.
                let most = rgb.iter().copied().fold(0.0, f64::max).max(1e-30);
                let mut exponent = most.log2().floor().max(-16.0) + 16.0;
                if (most / (exponent - 24.0).exp2()).round() > 511.0 {
                    exponent += 1.0;
                }
                let part = |c: f64| (c / (exponent - 24.0).exp2()).round() as u64;
                word(part(rgb[0]) + (part(rgb[1]) << 9) + (part(rgb[2]) << 18) + ((exponent as u64) << 27), 4);
            }
        }
    }
}

/// Rounds to an unsigned float with a 5-bit exponent and `mantissa` bits; values below 2^-14 are denormal.
fn small_float(value: f64, mantissa: i32) -> u64 {
    let steps = f64::from(mantissa).exp2();
    if value < f64::exp2(-14.0) {
        return (value * f64::exp2(14.0) * steps).round() as u64;
    }
    let exponent = value.log2().floor();
    let part = ((value / exponent.exp2() - 1.0) * steps).round() as u64;
    // A mantissa that rounds up to two carries into the exponent.
    ((exponent as i64 + 15) as u64) * steps as u64 + part
}

impl CubeFile {
    /// Creates a cube with a mip chain from a function of level and direction.
    pub fn new(size: u32, levels: u32, radiance: impl Fn(u32, DVec3) -> DVec3) -> Self {
        let texels = |level: u32| {
            let side = (size >> level).max(1);
            let place = |i: u32| (f64::from(i) + 0.5) / f64::from(side) * 2.0 - 1.0;
            let mut texels = Vec::new();
            for [right, down, forward] in FACES {
                for y in 0..side {
                    for x in 0..side {
                        let at = DVec2::new(place(x), place(y));
                        texels.push(radiance(level, (forward + right * at.x + down * at.y).normalize()));
                    }
                }
            }
            texels
        };
        Self { size, levels: (0..levels).map(texels).collect(), sh: None }
    }

    /// Adds coefficients of irradiance in spherical harmonics.
    pub fn with_sh(self, factors: &[DVec3]) -> Self {
        let line = |c: &DVec3| format!("{:.9} {:.9} {:.9}\n", c.x, c.y, c.z);
        Self { sh: Some(factors.iter().map(line).collect()), ..self }
    }

    fn metadata(&self, big_endian: bool) -> Vec<u8> {
        let mut out = Vec::new();
        let entries = [("tool", Some("test")), ("sh", self.sh.as_deref())];
        for (key, value) in entries.into_iter().filter_map(|(key, value)| Some((key, value?))) {
            let entry = [key.as_bytes(), &[0], value.as_bytes()].concat();
            put(&mut out, entry.len() as u32, big_endian);
            out.extend(entry);
            out.resize(out.len().div_ceil(4) * 4, 0);
        }
        out
    }

    /// Returns the file in version 1, as `cmgen` writes it.
    pub fn ktx1(&self, texels: Texels, big_endian: bool) -> Vec<u8> {
        let metadata = self.metadata(big_endian);
        let mut out = vec![0xAB, 0x4B, 0x54, 0x58, 0x20, 0x31, 0x31, 0xBB, 0x0D, 0x0A, 0x1A, 0x0A];
        let type_size = match texels {
            Texels::Rgba16 | Texels::Rgb16 => 2,
            _ => 4,
        };
        let [internal, _] = texels.numbers();
        // Endianness, type, type size, format, internal format, base format; then width, height, depth, elements,
        // faces, levels.
        let head = [0x0403_0201, 0x8C3B, type_size, 0x1907, internal, 0x1907];
        let shape = [self.size, self.size, 0, 0, 6, self.levels.len() as u32, metadata.len() as u32];
        head.into_iter().chain(shape).for_each(|word| put(&mut out, word, big_endian));
        out.extend(metadata);
        for level in &self.levels {
            let mut faces = Vec::new();
            for face in level.chunks_exact(level.len() / 6) {
                let mut bytes = Vec::new();
                face.iter().for_each(|color| texels.write(*color, big_endian, &mut bytes));
                faces.push(bytes);
            }
            put(&mut out, faces[0].len() as u32, big_endian);
            for face in faces {
                out.extend(face);
                out.resize(out.len().div_ceil(4) * 4, 0);
            }
        }
        out
    }

    /// Returns the file in version 2, with the coarsest level first, as specified.
    pub fn ktx2(&self, texels: Texels) -> Vec<u8> {
        let metadata = self.metadata(false);
        let mut out = vec![0xAB, 0x4B, 0x54, 0x58, 0x20, 0x32, 0x30, 0xBB, 0x0D, 0x0A, 0x1A, 0x0A];
        let [_, format] = texels.numbers();
        let count = self.levels.len();
        let index_end = 80 + 24 * count;
        let head = [format, 4, self.size, self.size, 0, 0, 6, count as u32, 0];
        // The reader ignores the format descriptor; metadata follow the index.
        let places = [0, 0, index_end as u32, metadata.len() as u32, 0, 0, 0, 0];
        head.into_iter().chain(places).for_each(|word| put(&mut out, word, false));
        let levels: Vec<Vec<u8>> = self
            .levels
            .iter()
            .map(|level| {
                let mut bytes = Vec::new();
                level.iter().for_each(|color| texels.write(*color, false, &mut bytes));
                bytes
            })
            .collect();
        let mut end = index_end + metadata.len() + levels.iter().map(Vec::len).sum::<usize>();
        for level in &levels {
            end -= level.len();
            for number in [end, level.len(), level.len()] {
                out.extend((number as u64).to_le_bytes());
            }
        }
        out.extend(metadata);
        levels.iter().rev().for_each(|level| out.extend(level));
        out
    }
}

fn put(out: &mut Vec<u8>, word: u32, big_endian: bool) {
    out.extend(if big_endian { word.to_be_bytes() } else { word.to_le_bytes() });
}
