//! Environments from Radiance `.hdr` (Ward, 1991) and OpenEXR `.exr` files, and the cleaning of what
//! real files hold: negative radiance from lossy compression, infinities from overflow, NaN.

use std::borrow::Cow;
use std::path::Path;

use super::definition::Environment;
use super::equirect::EquirectMap;
use crate::codec::{CodecError, PictureF32, decode_f32, header_f32};
use crate::error::{SceneError, Unsupported, one_line};
use crate::options::LoadOptions;
use crate::progress::{Progress, ProgressFn, Stage, report};
use crate::read::{file_bytes, read_file};

/// The largest radiance a texel keeps. Above the sun's disc (1.6e9 nits), and small enough that sums
/// and squares stay finite in f32.
pub const MAX_RADIANCE: f32 = 1e10;

/// What an infinite texel becomes: infinities in files are values that overflowed a half float.
const INFINITY_STANDS_FOR: f32 = 65504.0;

/// Larger maps are refused: 16384 × 8192 is the largest size in circulation.
const MAX_TEXELS: [u32; 2] = [16384, 8192];

/// What cleaning changed. Texels are counted, once each, in the order of severity.
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
    /// How many texels were changed.
    #[must_use]
    pub fn clamped(&self) -> usize {
        self.non_finite + self.negative + self.excessive
    }

    /// The warnings for `file` of `texels` texels; none when nothing was changed.
    pub fn warnings(&self, file: &str, texels: usize) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.negative > 0 {
            warnings.push(format!(
                "{file}: {} of {texels} texels had negative radiance (lowest {}) and were clamped \
                 to 0",
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

/// Brings every channel into 0…[`MAX_RADIANCE`] and sets alpha to 1. NaN is found by
/// `is_finite`, never by comparison.
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

/// The map itself where every texel is sound, else a cleaned copy. What was changed is counted.
pub fn cleaned(map: &EquirectMap) -> (Cow<'_, EquirectMap>, Cleaning) {
    // A comparison with NaN is false.
    let sound = |c: &f32| *c >= 0.0 && *c <= MAX_RADIANCE;
    if map.texels().iter().all(|[r, g, b, _]| sound(r) && sound(g) && sound(b)) {
        return (Cow::Borrowed(map), Cleaning::default());
    }
    let mut texels = map.texels().to_vec();
    let cleaning = clean(&mut texels);
    (Cow::Owned(EquirectMap::new(map.width(), map.height(), texels)), cleaning)
}

impl Environment {
    /// [`Environment::load_with`] the default options.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn load(path: &Path, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        Self::load_with(path, &LoadOptions::default(), progress)
    }

    /// Loads a Radiance `.hdr` or OpenEXR `.exr` picture in equirectangular projection. The format
    /// is told from the content.
    ///
    /// Negative, infinite and NaN texels are clamped, counted, and reported in
    /// [`warnings`](Self::warnings). What the map takes stays taken of `options.memory`.
    ///
    /// # Errors
    ///
    /// One line that names the file and the reason.
    pub fn load_with(path: &Path, options: &LoadOptions, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        let length = file_bytes(path)?;
        let over = |budget| SceneError::Memory { file: path.into(), at: "environment".into(), budget };
        options.memory.keep(length).map_err(over)?;
        let loaded = read_file(path).and_then(|bytes| load(path, &bytes, options, progress));
        options.memory.free(length);
        loaded
    }

    /// Loads a picture that is in memory; `path` names it in messages.
    ///
    /// # Errors
    ///
    /// As [`Environment::load_with`].
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
    let name = one_line(&path.display().to_string());
    let step = |done: usize| Progress { stage: Stage::Environment, done, total: 2, item: &name };
    let over = |at: String| move |budget| SceneError::Memory { file: path.into(), at, budget };
    report(progress, path, step(0))?;
    let [width, height] = header_f32(bytes, MAX_TEXELS).map_err(|error| refused(path, error))?;
    let map_bytes = u64::from(width) * u64::from(height) * TEXEL_BYTES;
    // Once for the map, and once for what is made of it: its halves, weighted by solid angle.
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
        warnings
            .push(format!("{name}: {width}×{height} is not twice as wide as high; taken for a whole sphere anyway"));
    }
    report(progress, path, step(2))?;
    Ok(Environment { name, map: EquirectMap::new(width, height, texels), sun: None, warnings })
}

fn refused(path: &Path, error: CodecError) -> SceneError {
    let file = path.to_path_buf();
    match error {
        CodecError::Unknown => SceneError::Unsupported { file, feature: Unsupported::Environment { kind: None } },
        CodecError::Kind(kind) => {
            SceneError::Unsupported { file, feature: Unsupported::Environment { kind: Some(kind) } }
        }
        error => SceneError::Picture { file, at: "environment".into(), error },
    }
}
