//! Image files: PNG for display colors, OpenEXR for linear light.

use std::path::{Path, PathBuf};

use crate::codec::{self, Picture8};
use crate::error::SceneError;
use crate::memory::{Loan, Memory, OverBudget};
use crate::read::{file_bytes, read_file, read_start};

pub use crate::codec::{CodecError, FileKind, HdrError, KtxError};

/// Maximum width and height for [`read_rgba8`], in texels.
const MAX_SIDE_TEXELS: u32 = 1 << 15;

/// Size of the prefix that is first searched for a header.
const START_BYTES: u64 = 1 << 16;

/// Error of reading an image file.
#[derive(thiserror::Error)]
pub enum PictureError {
    /// The file cannot be decoded.
    #[error("{path}: {error}")]
    Codec {
        /// Path of the file.
        path: PathBuf,
        /// Error of the decoder.
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

/// Writes `rgba8` (four bytes a texel, rows from the top, sRGB-encoded, straight alpha) as PNG.
///
/// # Errors
/// Fails if the size is zero or does not match the number of bytes, or if writing fails.
#[cfg(feature = "png")]
pub fn encode_png(to: impl std::io::Write, texels: [u32; 2], rgba8: &[u8]) -> Result<(), CodecError> {
    check_size(texels, rgba8.len())?;
    codec::png::encode(to, texels, rgba8)
}

/// Writes `rgba` (four numbers a texel, rows from the top, linear light) as OpenEXR with 32-bit floats.
///
/// # Errors
/// Returns the errors of [`encode_png`].
#[cfg(feature = "exr")]
pub fn encode_exr(
    to: impl std::io::Write + std::io::Seek,
    texels: [u32; 2],
    rgba: &[[f32; 4]],
) -> Result<(), CodecError> {
    check_size(texels, rgba.len() * 4)?;
    codec::exr::encode(to, texels, rgba)
}

/// Reads a PNG, JPEG or WebP image; returns its size and its sRGB-encoded texels, four bytes each, rows from the top.
/// The features `png`, `jpeg` and `webp` enable one format each.
///
/// # Errors
/// Fails if the file is missing or cannot be decoded.
pub fn read_rgba8(path: &Path) -> Result<([u32; 2], Vec<u8>), PictureError> {
    let decoded = codec::decode_8(&read_file(path)?, MAX_SIDE_TEXELS);
    let Picture8 { size_texels, rgba8 } = decoded.map_err(|error| PictureError::Codec { path: path.into(), error })?;
    Ok((size_texels, rgba8))
}

/// Reads a PNG, JPEG or WebP image within a memory budget: first the header, then the pixels. The loan covers the
/// texels and one copy for upload to a device; hold it as long as they exist.
///
/// # Errors
/// Returns the errors of [`read_rgba8`], and [`SceneError::Memory`] if the budget is exceeded.
pub fn read_rgba8_within<'a>(path: &Path, memory: &'a Memory) -> Result<([u32; 2], Vec<u8>, Loan<'a>), PictureError> {
    let file_bytes = file_bytes(path)?;
    let codec = |error| PictureError::Codec { path: path.into(), error };
    let start = read_start(path, START_BYTES)?;
    let header = match codec::header_8(&start, MAX_SIDE_TEXELS) {
        // Some files have large metadata before the header.
        Err(CodecError::Other(_)) if file_bytes > START_BYTES => {
            let _whole = memory.lend(file_bytes).map_err(|budget| over(path, String::new(), budget))?;
            codec::header_8(&read_file(path)?, MAX_SIDE_TEXELS)
        }
        header => header,
    };
    let header = header.map_err(codec)?;
    let (size, rgba8_bytes) = (header.size_texels, header.rgba8_bytes());
    let bytes = rgba8_bytes + rgba8_bytes.max(header.working_bytes + file_bytes);
    let loan = memory.lend(bytes).map_err(|budget| over(path, format!("{}×{}", size[0], size[1]), budget))?;
    let (found, rgba8) = read_rgba8(path)?;
    if found != size {
        let reason = "its size changed while it was read".into();
        return Err(SceneError::Malformed { file: path.into(), at: "picture".into(), reason }.into());
    }
    Ok((size, rgba8, loan))
}

fn over(path: &Path, at: String, budget: OverBudget) -> PictureError {
    SceneError::Memory { file: path.into(), at, budget }.into()
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
    fn a_picture_over_the_budget_is_refused_by_its_header() -> Result<(), Box<dyn std::error::Error>> {
        let folder = std::env::temp_dir().join(format!("framegraph-picture-within-{}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        let png = folder.join("a.png");
        encode_png(std::fs::File::create(&png)?, [256, 256], &vec![7; 256 * 256 * 4])?;
        // The texels need 256 KiB, and the copy for upload as much.
        let told = read_rgba8_within(&png, &Memory::new(511 << 10)).map(drop).map_err(|told| told.to_string());
        assert!(told.as_ref().is_err_and(|told| told.contains("a.png") && told.contains("256×256")), "{told:?}");
        let memory = Memory::new(1 << 20);
        let (size, rgba8, loan) = read_rgba8_within(&png, &memory)?;
        assert_eq!((size, rgba8.len()), ([256, 256], 256 << 10));
        assert!(memory.keep(600 << 10).is_err(), "it is lent as long as the texels are there");
        drop(loan);
        assert!(memory.keep(600 << 10).is_ok());
        // The header is truncated: no memory is requested.
        std::fs::write(&png, &std::fs::read(&png)?[..20])?;
        assert!(read_rgba8_within(&png, &memory).is_err_and(|told| told.to_string().contains("a.png")));
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
