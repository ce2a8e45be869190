//! Environments from Radiance `.hdr` (Ward, 1991), OpenEXR `.exr`, and cube maps in Khronos textures.

use std::path::Path;

use super::clean::clean;
use super::cube_file;
use super::definition::Environment;
use super::equirect::EquirectMap;
use super::refused::refused;
use crate::codec::{FileKind, PictureF32, decode_f32, header_f32};
use crate::error::{SceneError, one_line};
use crate::options::LoadOptions;
use crate::progress::{Progress, ProgressFn, Stage, report};
use crate::read::{file_bytes, read_file};

/// Maximum map size; 16384 × 8192 is the largest in circulation.
const MAX_TEXELS: [u32; 2] = [16384, 8192];

impl Environment {
    /// Loads an environment with the default options.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Environment::load_with`].
    pub fn load(path: &Path, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        Self::load_with(path, &LoadOptions::default(), progress)
    }

    /// Loads an equirectangular image in Radiance `.hdr` or OpenEXR `.exr`, or a cube map in a Khronos texture, `.ktx`
    /// or `.ktx2`. The format is detected from the content.
    ///
    /// Cube maps must have uncompressed floating-point texels. A cube map with several levels and irradiance under the
    /// metadata key `sh`, as written by Filament's `cmgen`, is used as [`filtered`](Self::filtered) light.
    ///
    /// Negative, infinite and NaN texels are clamped, counted and reported in [`warnings`](Self::warnings). The memory
    /// of the map stays charged to `options.memory`.
    ///
    /// # Errors
    ///
    /// Returns a one-line error with the file and the reason.
    pub fn load_with(path: &Path, options: &LoadOptions, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        let length = file_bytes(path)?;
        let over = |budget| SceneError::Memory { file: path.into(), at: "environment".into(), budget };
        options.memory.keep(length).map_err(over)?;
        let loaded = read_file(path).and_then(|bytes| load(path, &bytes, options, progress));
        options.memory.free(length);
        loaded
    }

    /// Loads an environment from bytes; `path` is its name in messages.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Environment::load_with`].
    pub fn load_bytes(
        path: &Path,
        bytes: &[u8],
        options: &LoadOptions,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, SceneError> {
        load(path, bytes, options, progress)
    }
}

/// Bytes of a texel of a map.
const TEXEL_BYTES: u64 = 16;

fn load(
    path: &Path,
    bytes: &[u8],
    options: &LoadOptions,
    progress: &mut ProgressFn<'_>,
) -> Result<Environment, SceneError> {
    if let Some(kind @ (FileKind::Ktx1 | FileKind::Ktx2)) = FileKind::of(bytes) {
        return cube_file::load(path, kind, bytes, options, progress);
    }
    let name = one_line(&path.display().to_string());
    let step = |done: usize| Progress { stage: Stage::Environment, done, total: 2, item: &name };
    let over = |at: String| move |budget| SceneError::Memory { file: path.into(), at, budget };
    report(progress, path, step(0))?;
    let [width, height] = header_f32(bytes, MAX_TEXELS).map_err(|error| refused(path, error))?;
    let map_bytes = u64::from(width) * u64::from(height) * TEXEL_BYTES;
    // Counted twice: the map, and its solid-angle-weighted mip levels.
    let at = format!("environment, {width}×{height}");
    options.memory.keep(2 * map_bytes).map_err(over(at))?;
    options.memory.free(map_bytes);
    let decoded = decode_f32(bytes, MAX_TEXELS).map_err(|error| refused(path, error));
    let PictureF32 { size_texels: [width, height], rgba: mut texels } =
        decoded.inspect_err(|_| options.memory.free(map_bytes))?;
    report(progress, path, step(1))?;
    let cleaning = clean(&mut texels);
    let mut warnings = cleaning.warnings(&name, texels.len());
    if u64::from(width) != 2 * u64::from(height) {
        warnings.push(format!("{name}: {width}×{height} is not twice as wide as high; interpreted as a full sphere"));
    }
    report(progress, path, step(2))?;
    Ok(Environment { name, map: EquirectMap::new(width, height, texels), sun: None, filtered: None, warnings })
}
