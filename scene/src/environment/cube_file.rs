//! Environments from cube maps in Khronos textures.

use std::path::Path;

use super::clean::clean;
use super::cube::Cube;
use super::definition::Environment;
use super::filtered::FilteredLight;
use super::refused::refused;
use super::sh::Sh;
use crate::codec::{CubeF32, FileKind, cube_header};
use crate::error::{SceneError, one_line};
use crate::options::LoadOptions;
use crate::progress::{Progress, ProgressFn, Stage, report};

/// Maximum face size; a larger cube map would resample to more than the maximum image size.
const MAX_TEXELS: u32 = 4096;

/// Converts a cube map to an environment. If the file contains irradiance, its levels are prefiltered radiance. Without
/// irradiance, or with one level, it is radiance and only the first level is read.
pub(super) fn load(
    path: &Path,
    kind: FileKind,
    bytes: &[u8],
    options: &LoadOptions,
    progress: &mut ProgressFn<'_>,
) -> Result<Environment, SceneError> {
    let name = one_line(&path.display().to_string());
    let step = |done: usize| Progress { stage: Stage::Environment, done, total: 2, item: &name };
    report(progress, path, step(0))?;
    let header = cube_header(kind, bytes, MAX_TEXELS).map_err(|error| refused(path, error))?;
    let size = header.size_texels;
    let harmonics = header.harmonics.filter(|_| header.level_count() > 1);
    let levels = if harmonics.is_some() { header.level_count() } else { 1 };
    let (decoded_bytes, map_bytes) = (header.decoded_bytes(levels), Cube::panorama_bytes(size));
    let at = || format!("environment, a cube of {size}²");
    let over = |budget| SceneError::Memory { file: path.into(), at: at(), budget };
    // The map is counted twice, since its solid-angle-weighted mip levels are made later.
    options.memory.keep(decoded_bytes + 2 * map_bytes).map_err(over)?;
    options.memory.free(if harmonics.is_some() { map_bytes } else { map_bytes + decoded_bytes });

    let CubeF32 { size_texels, mut levels } = header.decode(bytes, levels);
    report(progress, path, step(1))?;
    let cleanings = levels.iter_mut().map(|level| clean(level).warnings(&name, level.len()));
    let warnings = cleanings.flatten().collect();
    let map = Cube { size: size_texels, texels: &levels[0] }.panorama();
    report(progress, path, step(2))?;
    let filtered =
        harmonics.map(|factors| FilteredLight { size_texels, levels, sh: Sh::from_irradiance_over_pi(factors) });
    Ok(Environment { name, map, sun: None, filtered, warnings })
}
