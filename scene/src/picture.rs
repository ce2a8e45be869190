//! Pictures as files: PNG for display codes, OpenEXR for linear light.

use std::path::{Path, PathBuf};

use crate::codec::{self, Picture8};
use crate::error::SceneError;
use crate::read::read_file;

pub use crate::codec::{CodecError, FileKind, HdrError, KtxError};

/// The largest side of a picture that [`read_rgba8`] takes, in texels.
const MAX_SIDE_TEXELS: u32 = 1 << 15;

/// A picture could not be read.
#[derive(thiserror::Error)]
pub enum PictureError {
    /// The file does not decode.
    #[error("{path}: {error}")]
    Codec {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: CodecError,
    },
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] SceneError),
}

impl std::fmt::Debug for PictureError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Writes `rgba8` (four bytes a texel, rows from the top, sRGB codes, straight alpha) as PNG.
///
/// # Errors
/// When the size has no texels or another number of bytes, or nothing can be written.
#[cfg(feature = "png")]
pub fn encode_png(to: impl std::io::Write, texels: [u32; 2], rgba8: &[u8]) -> Result<(), CodecError> {
    check_size(texels, rgba8.len())?;
    codec::png::encode(to, texels, rgba8)
}

/// Writes `rgba` (four numbers a texel, rows from the top, linear light) as OpenEXR of 32-bit floats.
///
/// # Errors
/// As [`encode_png`].
#[cfg(feature = "exr")]
pub fn encode_exr(
    to: impl std::io::Write + std::io::Seek,
    texels: [u32; 2],
    rgba: &[[f32; 4]],
) -> Result<(), CodecError> {
    check_size(texels, rgba.len() * 4)?;
    codec::exr::encode(to, texels, rgba)
}

/// Reads a PNG or JPEG picture (as far as the features `png` and `jpeg` are on) as display codes, four bytes a texel,
/// rows from the top; returns its size beside them.
///
/// # Errors
/// When the file is missing or cannot be decoded.
pub fn read_rgba8(path: &Path) -> Result<([u32; 2], Vec<u8>), PictureError> {
    let decoded = codec::decode_8(&read_file(path)?, MAX_SIDE_TEXELS);
    let Picture8 { size_texels, rgba8 } = decoded.map_err(|error| PictureError::Codec { path: path.into(), error })?;
    Ok((size_texels, rgba8))
}

#[cfg(any(feature = "png", feature = "exr"))]
fn check_size(size_texels: [u32; 2], given: usize) -> Result<(), CodecError> {
    let expected = size_texels[0] as usize * size_texels[1] as usize * 4;
    if expected == given { Ok(()) } else { Err(CodecError::Values { size_texels, expected, given }) }
}

#[cfg(all(test, feature = "png", feature = "exr"))]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn what_is_written_is_read_again() -> Result<(), Box<dyn std::error::Error>> {
        let folder = std::env::temp_dir().join(format!("framegraph-picture-{}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        let (png, codes) = (folder.join("a.png"), [1, 2, 3, 255, 4, 5, 6, 0]);
        encode_png(std::fs::File::create(&png)?, [2, 1], &codes)?;
        assert_eq!(read_rgba8(&png)?, ([2, 1], codes.to_vec()));
        let light = [[0.5, 1000.0, -1.0, 1.0], [f32::MIN_POSITIVE, 0.0, 65504.0, 0.25]];
        let mut exr = Cursor::new(Vec::new());
        encode_exr(&mut exr, [1, 2], &light)?;
        let read = image::load_from_memory(exr.get_ref())?.into_rgba32f();
        assert_eq!(read.as_raw().as_slice(), light.as_flattened());
        std::fs::remove_dir_all(&folder)?;
        Ok(())
    }

    #[test]
    fn sizes_that_do_not_fit_are_refused() {
        let told = |size, codes: &[u8]| encode_png(Vec::new(), size, codes).map_err(|e| e.to_string());
        assert!(told([0, 0], &[]).is_err(), "a picture without texels is refused");
        assert!(told([2, 2], &[0; 4]).is_err_and(|e| e.contains("16 values, not 4")));
        assert!(encode_exr(Cursor::new(Vec::new()), [2, 2], &[[0.0; 4]]).is_err());
    }
}
