//! Pictures as files: PNG for display codes, OpenEXR for linear light. A file is written whole or not at all.

use std::ffi::OsString;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::codec::{self, Picture8};
use crate::error::SceneError;
use crate::read::read_file;

pub use crate::codec::{CodecError, FileKind, HdrError};

/// The largest side of a picture that [`read_rgba8`] takes, in texels.
const MAX_SIDE_TEXELS: u32 = 1 << 15;

/// A picture could not be written or read.
#[derive(thiserror::Error)]
pub enum PictureError {
    /// There are more or fewer values than the size asks for.
    #[error("{path}: a picture of {width}×{height} texels has {expected} values, not {given}")]
    Size {
        /// The file.
        path: PathBuf,
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
        /// Values that there should be.
        expected: usize,
        /// Values that there are.
        given: usize,
    },
    /// The file cannot be created, written or renamed.
    #[error("{path}: {error}")]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        error: std::io::Error,
    },
    /// The file does not decode, or the picture does not encode.
    #[error("{path}: {error}")]
    Codec {
        /// The file.
        path: PathBuf,
        /// What is wrong with the file or the picture.
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
/// [`PictureError`], with the path; an earlier file of that name is left as it was.
#[cfg(feature = "png")]
pub fn write_png(path: &Path, texels: [u32; 2], rgba8: &[u8]) -> Result<(), PictureError> {
    check_size(path, texels, rgba8.len())?;
    write_whole(path, |file| codec::png::encode(file, texels, rgba8))
}

/// Writes `rgba` (four numbers a texel, rows from the top, linear light) as OpenEXR of 32-bit floats.
///
/// # Errors
/// As [`write_png`].
#[cfg(feature = "exr")]
pub fn write_exr(path: &Path, texels: [u32; 2], rgba: &[[f32; 4]]) -> Result<(), PictureError> {
    check_size(path, texels, rgba.len() * 4)?;
    write_whole(path, |file| codec::exr::encode(file, texels, rgba))
}

/// Writes a text, with the same promise as pictures.
///
/// # Errors
/// As [`write_png`].
pub fn write_text(path: &Path, text: &str) -> Result<(), PictureError> {
    write_whole(path, |file| file.write_all(text.as_bytes()).map_err(|error| CodecError::Other(Box::new(error))))
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
fn check_size(path: &Path, [width, height]: [u32; 2], given: usize) -> Result<(), PictureError> {
    let expected = width as usize * height as usize * 4;
    if expected == given {
        Ok(())
    } else {
        Err(PictureError::Size { path: path.into(), width, height, expected, given })
    }
}

/// Writes beside the target under a name of its own, then puts it in its place: a reader sees the old file or the new
/// one, and a failure leaves nothing behind.
fn write_whole<E>(path: &Path, encode: E) -> Result<(), PictureError>
where
    E: FnOnce(&mut BufWriter<File>) -> Result<(), CodecError>,
{
    let at = |error| PictureError::File { path: path.into(), error };
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    let part = path.with_file_name(name);
    let written = write_part(path, &part, encode).and_then(|()| std::fs::rename(&part, path).map_err(at));
    if written.is_err() {
        // The first error is the one to report; a part that cannot be removed was most likely never made.
        drop(std::fs::remove_file(&part));
    }
    written
}

fn write_part<E>(path: &Path, part: &Path, encode: E) -> Result<(), PictureError>
where
    E: FnOnce(&mut BufWriter<File>) -> Result<(), CodecError>,
{
    let at = |error| PictureError::File { path: path.into(), error };
    let mut file = BufWriter::new(File::create(part).map_err(at)?);
    encode(&mut file).map_err(|error| PictureError::Codec { path: path.into(), error })?;
    file.flush().map_err(at)
}

#[cfg(all(test, feature = "png", feature = "exr"))]
mod tests {
    use super::*;

    fn folder(name: &str) -> std::io::Result<PathBuf> {
        let folder = std::env::temp_dir().join(format!("renderer-picture-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        Ok(folder)
    }

    #[test]
    fn what_is_written_is_read_again() -> Result<(), Box<dyn std::error::Error>> {
        let folder = folder("round-trip")?;
        let png = folder.join("a.png");
        let codes = [1, 2, 3, 255, 4, 5, 6, 0];
        write_png(&png, [2, 1], &codes)?;
        assert_eq!(read_rgba8(&png)?, ([2, 1], codes.to_vec()));
        let exr = folder.join("a.exr");
        let light = [[0.5, 1000.0, -1.0, 1.0], [f32::MIN_POSITIVE, 0.0, 65504.0, 0.25]];
        write_exr(&exr, [1, 2], &light)?;
        let read = image::open(&exr)?.into_rgba32f();
        assert_eq!(read.as_raw().as_slice(), light.as_flattened());
        assert_eq!(std::fs::read_dir(&folder)?.count(), 2, "no part is left behind");
        std::fs::remove_dir_all(&folder)?;
        Ok(())
    }

    #[test]
    fn a_failure_names_the_file_and_leaves_the_old_one() -> Result<(), Box<dyn std::error::Error>> {
        let folder = folder("failure")?;
        let png = folder.join("a.png");
        write_png(&png, [1, 1], &[9; 4])?;
        let told = write_png(&png, [0, 0], &[]).map_err(|e| e.to_string());
        assert!(told.is_err_and(|e| e.contains("a.png")), "a picture without texels is refused");
        let told = write_png(&png, [2, 2], &[0; 4]).map_err(|e| e.to_string());
        assert!(told.is_err_and(|e| e.contains("a.png") && e.contains("16 values")));
        assert_eq!(read_rgba8(&png)?.1, [9; 4]);
        assert!(write_png(&folder.join("missing/a.png"), [1, 1], &[0; 4]).is_err());
        assert_eq!(std::fs::read_dir(&folder)?.count(), 1);
        std::fs::remove_dir_all(&folder)?;
        Ok(())
    }
}
