//! Environments from Radiance `.hdr` (Ward, 1991) and OpenEXR `.exr` files, and the cleaning of what
//! real files hold: negative radiance from lossy compression, infinities from overflow, NaN.

use std::io::Cursor;
use std::path::Path;

use image::{ImageDecoder, ImageFormat};

use super::Environment;
use super::equirect::EquirectMap;
use crate::scene::error::{SceneError, one_line};
use crate::scene::import::{guard, read_file};
use crate::scene::progress::{Progress, ProgressFn, Stage, report};

/// The largest radiance a texel keeps. Above the sun's disc (1.6e9 nits), and small enough that sums
/// and squares stay finite in f32.
pub const MAX_RADIANCE: f32 = 1e10;

/// What an infinite texel becomes: infinities in files are values that overflowed a half float.
const INFINITY_STANDS_FOR: f32 = 65504.0;

/// Larger maps are refused: 16384 × 8192 is the largest size in circulation.
const MAX_WIDTH: u32 = 16384;
const MAX_HEIGHT: u32 = 8192;

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
    fn warnings(&self, file: &str, texels: usize) -> Vec<String> {
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

/// See [`Environment::load`].
pub(super) fn load(path: &Path, progress: &mut ProgressFn<'_>) -> Result<Environment, SceneError> {
    let name = one_line(&path.display().to_string());
    let step = |done: usize| Progress {
        stage: Stage::Environment,
        done,
        total: 3,
        item: &name,
    };
    report(progress, path, step(0))?;
    let bytes = read_file(path)?;
    report(progress, path, step(1))?;
    let (width, height, mut texels) = decode(path, &bytes)?;
    report(progress, path, step(2))?;
    let cleaning = clean(&mut texels);
    let mut warnings = cleaning.warnings(&name, texels.len());
    if u64::from(width) != 2 * u64::from(height) {
        warnings.push(format!(
            "{name}: {width}×{height} is not twice as wide as high; taken for a whole sphere anyway"
        ));
    }
    report(progress, path, step(3))?;
    Ok(Environment {
        name,
        map: EquirectMap::new(width, height, texels),
        sun: None,
        warnings,
    })
}

fn decode(path: &Path, bytes: &[u8]) -> Result<(u32, u32, Vec<[f32; 4]>), SceneError> {
    let format = match bytes {
        [b'#', b'?', ..] => ImageFormat::Hdr,
        [0x76, 0x2f, 0x31, 0x01, ..] => ImageFormat::OpenExr,
        [] => {
            return Err(SceneError::malformed(
                path,
                "environment",
                "the file is empty",
            ));
        }
        _ => {
            return Err(SceneError::unsupported(
                path,
                "an environment that is neither Radiance .hdr nor OpenEXR .exr",
                "",
            ));
        }
    };
    let failed = |error: String| SceneError::malformed(path, "environment", error);
    guard(|| {
        let decoder = image::ImageReader::with_format(Cursor::new(bytes), format)
            .into_decoder()
            .map_err(|e| failed(e.to_string()))?;
        let (width, height) = decoder.dimensions();
        if width == 0 || height == 0 {
            return Err(failed(format!("its size is {width}×{height}")));
        }
        for (what, value, limit) in [
            ("width in texels", width, MAX_WIDTH),
            ("height in texels", height, MAX_HEIGHT),
        ] {
            if value > limit {
                return Err(SceneError::too_large(
                    path,
                    what,
                    value.into(),
                    limit.into(),
                ));
            }
        }
        let image = image::DynamicImage::from_decoder(decoder)
            .map_err(|e| failed(e.to_string()))?
            .into_rgba32f();
        let texels = image.pixels().map(|p| p.0).collect();
        Ok((width, height, texels))
    })
    .unwrap_or_else(|reason| Err(failed(reason)))
}
