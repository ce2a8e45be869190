//! Pictures to compare, as linear light and as display values.

use framegraph_scene::picture::{PictureError, encode_exr, encode_png, read_rgba8};
use program::outputs::{OutputError, Outputs};
use std::path::{Path, PathBuf};

/// A picture in the two forms that metrics use.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height, in pixels.
    pub size_px: [u32; 2],
    /// Linear Rec.709, rows from the top; decoded if the picture is 8-bit.
    pub linear: Vec<[f32; 3]>,
    /// Values clamped to 0…1 and sRGB encoded; divided by 255 if the picture is 8-bit.
    pub encoded: Vec<[f32; 3]>,
}

/// A picture cannot be read.
#[derive(thiserror::Error)]
pub enum ReadError {
    /// The file system or the decoder reported an error.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The decoder of floating-point pictures reported an error.
    #[error("{path}: {error}")]
    Decode {
        /// Path of the file.
        path: PathBuf,
        /// Error of the decoder.
        error: image::ImageError,
    },
    /// A reference has values that are not finite.
    #[error("{path}: {count} texels are not finite")]
    NotFinite {
        /// Path of the file.
        path: PathBuf,
        /// Number of such values.
        count: usize,
    },
}

impl std::fmt::Debug for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Picture {
    /// Creates a picture from linear light, rows from the top.
    pub fn from_linear(size_px: [u32; 2], linear: Vec<[f32; 3]>) -> Self {
        let encoded = linear.iter().map(|rgb| rgb.map(encode)).collect();
        Self { size_px, linear, encoded }
    }

    /// Creates a picture from sRGB values, four bytes per pixel.
    pub fn from_codes(size_px: [u32; 2], rgba8: &[u8]) -> Self {
        let codes = rgba8.chunks_exact(4);
        let encoded: Vec<[f32; 3]> = codes.map(|t| [t[0], t[1], t[2]].map(|c| f32::from(c) / 255.0)).collect();
        let linear = encoded.iter().map(|rgb| rgb.map(decode)).collect();
        Self { size_px, linear, encoded }
    }

    /// Reads an OpenEXR picture of linear light (`.exr`) or an 8-bit picture (any other extension).
    ///
    /// # Errors
    /// The file is missing, cannot be decoded, or has values that are not finite.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("exr")) {
            let (size_px, rgba8) = read_rgba8(path)?;
            return Ok(Self::from_codes(size_px, &rgba8));
        }
        let decoded = image::open(path).map_err(|error| ReadError::Decode { path: path.into(), error })?.into_rgb32f();
        let size_px = [decoded.width(), decoded.height()];
        let linear: Vec<[f32; 3]> = decoded.pixels().map(|p| p.0).collect();
        let picture = Self::from_linear(size_px, linear);
        let count = picture.not_finite();
        if count > 0 { Err(ReadError::NotFinite { path: path.into(), count }) } else { Ok(picture) }
    }

    /// Returns the number of pixels with a channel that is not finite.
    pub fn not_finite(&self) -> usize {
        self.linear.iter().filter(|rgb| rgb.iter().any(|c| !c.is_finite())).count()
    }

    /// Returns the index of the pixel at a point, x and y in 0…1 from the top left.
    pub fn at(&self, [x, y]: [f64; 2]) -> usize {
        let place = |t: f64, side: u32| ((t * f64::from(side)) as usize).min(side as usize - 1);
        place(y, self.size_px[1]) * self.size_px[0] as usize + place(x, self.size_px[0])
    }

    /// Returns the picture with light clamped to 0…1.
    #[must_use]
    pub fn clamped(&self) -> Self {
        let linear = self.linear.iter().map(|rgb| rgb.map(|c| c.clamp(0.0, 1.0))).collect();
        Self { linear, ..self.clone() }
    }

    /// Multiplies the light by a factor, as a negative control.
    #[must_use]
    pub fn brighter(&self, factor: f32) -> Self {
        Self::from_linear(self.size_px, self.linear.iter().map(|rgb| rgb.map(|c| c * factor)).collect())
    }

    /// Writes the display values as PNG.
    ///
    /// # Errors
    /// [`OutputError`], with the path.
    pub fn write_png(&self, path: &Path) -> Result<(), OutputError> {
        let code = |c: f32| (c * 255.0).round() as u8;
        let rgba8: Vec<u8> = self.encoded.iter().flat_map(|[r, g, b]| [code(*r), code(*g), code(*b), 255]).collect();
        let mut outputs = Outputs::default();
        outputs.write(path, |file| encode_png(file, self.size_px, &rgba8))?;
        outputs.commit().map(drop)
    }

    /// Writes the linear light as OpenEXR.
    ///
    /// # Errors
    /// [`OutputError`], with the path.
    pub fn write_exr(&self, path: &Path) -> Result<(), OutputError> {
        let rgba: Vec<[f32; 4]> = self.linear.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let mut outputs = Outputs::default();
        outputs.write(path, |file| encode_exr(file, self.size_px, &rgba))?;
        outputs.commit().map(drop)
    }

    /// Returns the difference of two pictures of equal size: absolute 8-bit differences times eight.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Self {
        let apart = |(a, b): (&[f32; 3], &[f32; 3])| -> [f32; 3] {
            std::array::from_fn(|c| (8.0 * (a[c] - b[c]).abs()).clamp(0.0, 1.0))
        };
        let encoded: Vec<[f32; 3]> = self.encoded.iter().zip(&other.encoded).map(apart).collect();
        let linear = encoded.iter().map(|rgb| rgb.map(decode)).collect();
        Self { size_px: self.size_px, linear, encoded }
    }
}

/// Encodes and clamps a value by IEC 61966-2-1; NaN becomes black.
fn encode(linear: f32) -> f32 {
    let c = if linear > 0.0 { f64::from(linear.min(1.0)) } else { 0.0 };
    let encoded = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    encoded as f32
}

fn decode(encoded: f32) -> f32 {
    let c = f64::from(encoded);
    let linear = if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    linear as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_and_codes_are_two_views_of_one_picture() {
        let codes: Vec<u8> = (0..=255).flat_map(|c| [c, 255 - c, c / 2, 255]).collect();
        let picture = Picture::from_codes([16, 16], &codes);
        let again = Picture::from_linear([16, 16], picture.linear.clone());
        let apart = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
        let worst = picture.encoded.iter().zip(&again.encoded).map(apart).fold(0.0, f32::max);
        assert!(worst < 1e-6, "{worst}");
        assert_eq!(picture.at([0.999, 0.0]), 15);
        assert_eq!(picture.at([1.0, 1.0]), 255);
        let bad = Picture::from_linear([2, 1], vec![[f32::NAN, 0.0, 1.0], [1e9, -1.0, 0.0]]);
        assert_eq!((bad.not_finite(), bad.encoded[1]), (1, [1.0, 0.0, 0.0]));
    }
}
