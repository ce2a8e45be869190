//! Image-based light: what an [`Environment`] adds to every surface, ready for shaders to look up.
//!
//! ```text
//!                ┌─> spherical harmonics (f64, CPU) ──> irradiance / π, 18 coefficients
//! Environment ───┤
//!                └─> panorama ─> cube + levels ─> prefiltered cube, a roughness a level      (GPU)
//! DFG table: directional albedo of the lobes over (n·v, roughness), whatever the environment (GPU)
//! ```
//!
//! Both GPU results are computed once and then come from a [`Cache`] on disk, found by the content they
//! were made from. Everything is photometric: the light is in the unit of the environment (nits), and
//! whoever binds it multiplies with intensity and exposure.
//!
//! The split sum is Karis's ("Real Shading in Unreal Engine 4", 2013), filtered importance sampling
//! Křivánek and Colbert's (GPU Gems 3, chapter 20).

mod bake;
pub mod cache;
mod dfg;
mod draw;
mod entry;
mod kernel;
mod settings;
mod texture;

use framegraph_shaders::ShaderError;
use glam::{DVec3, Vec3, Vec4};
use wgpu::{TextureFormat, TextureView};

use self::cache::{Cache, Key};
use framegraph_scene::color::luminance_from_rec709;
use framegraph_scene::environment::{Environment, EquirectMap, Sh, ShBands, cleaned};
use framegraph_scene::error::SceneError;
use framegraph_scene::light::Light;
use framegraph_scene::progress::ProgressFn;
use framegraph_wgpu::{DeviceError, Gpu, ReadbackError};

pub use dfg::{DfgSettings, DfgTable};
pub use kernel::{KernelRow, kernel_rows, lobe_kernel};
pub use settings::IblSettings;

/// Coefficients that five bands of irradiance leave: 9 + 0 + 9.
pub const IRRADIANCE_COEFFICIENTS: usize = 18;

/// Why light could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IblError {
    /// A setting is out of range, or the work was interrupted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A shader is wrong.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The device refused, ran out of memory, or was lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// What was computed could not be read back for the cache.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
}

/// Where something came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// It was computed now.
    Computed,
    /// It was found on disk.
    Cached,
}

/// An environment as light, on one device.
///
/// To shade with it: irradiance/π is `irradiance_sh5(irradiance, n)` (or `sh2`, `sh` with the first 4 or
/// 9, see [`bands`](Self::bands)) of `wgsl/lib/sh.wgsl`; the radiance that a lobe gathers is the specular
/// cube at `specular_lod(roughness, roughness_one_lod)` of `wgsl/lib/image_light.wgsl` times
/// [`texel_nits`](Self::texel_nits). Both are in nits for an environment in nits: multiply by intensity
/// and exposure.
#[derive(Debug)]
pub struct ImageLight {
    /// Of the environment, for messages.
    pub name: String,
    /// Irradiance / π as factors of the polynomials of `irradiance_sh5`: bands 0 to 2 in the first nine,
    /// band 4 in the others; xyz is linear Rec.709 in nits, w is 0. What the chosen bands leave out is
    /// zero. In this layout an `array<vec4<f32>, 18>` of a uniform buffer holds them.
    pub irradiance: [Vec4; IRRADIANCE_COEFFICIENTS],
    /// How many bands are in there: the shader needs to evaluate no more.
    pub bands: ShBands,
    /// Prefiltered radiance in units of [`texel_nits`](Self::texel_nits), a cube view of all levels. To
    /// be sampled trilinearly.
    pub specular: TextureView,
    /// `Rg11b10Ufloat` where the device renders it, else `Rgba16Float`.
    pub format: TextureFormat,
    /// Width and height of level 0 of the cube.
    pub cube_texels: u32,
    /// Levels of the cube: the first is a mirror, the last roughness 1.
    pub level_count: u32,
    /// The number of the last level, as `specular_lod` wants it.
    pub roughness_one_lod: f32,
    /// Radiance in nits of a texel that holds 1: a power of two, chosen so that the brightest texel is
    /// within the format.
    pub texel_nits: f32,
    /// Mean luminance over all directions, the sun apart, in nits.
    pub luminance_nits: f32,
    /// The unit vector toward where most light comes from; `None` for even light.
    pub dominant_direction: Option<Vec3>,
    /// The sun, where it is apart from the map.
    pub sun: Option<Light>,
    /// Whether the cube was computed or found.
    pub origin: Origin,
    /// Texels that were clamped, and what went wrong with the cache, a line each.
    pub warnings: Vec<String>,
    /// Bytes of the cube.
    pub size_bytes: u64,
}

/// What the cache keeps of an environment's light.
struct Kept {
    sh: Sh,
    average: DVec3,
    texel_nits: f32,
    levels: Vec<Vec<u8>>,
}

impl ImageLight {
    /// Makes light of `environment`, or finds it in `cache`.
    ///
    /// Texels that are negative, infinite or NaN are clamped as by [`Environment::load`] and counted in
    /// [`warnings`](Self::warnings); those of a loaded environment already are.
    ///
    /// Reports each step as [`Stage::Lighting`](framegraph_scene::Stage::Lighting) and stops where `progress` asks
    /// to; nothing is written to the cache then.
    ///
    /// # Errors
    ///
    /// When a setting is out of range (the message names it), when the work is interrupted, or when the
    /// device fails. A cache that cannot be read or written is a warning.
    pub fn new(
        gpu: &Gpu,
        environment: &Environment,
        settings: &IblSettings,
        cache: &Cache,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, IblError> {
        settings.check()?;
        let format = texture::cube_format(gpu);
        let (map, cleaning) = cleaned(&environment.map);
        let key = key(&map, settings, format);
        let shape = texture::CubeShape { texels: settings.cube_texels, levels: settings.levels, format };
        let mut warnings = cleaning.warnings(&environment.name, map.texels().len());
        let found = cache.load(key, entry::LIGHT, &mut warnings).and_then(|payload| {
            let kept = entry::decode_light(&payload, &shape);
            kept.map_err(|reason| warnings.push(cache.damaged(key, reason))).ok()
        });
        let (kept, cube, origin) = match found {
            Some(kept) => {
                let cube = texture::write_cube(gpu, &environment.name, &shape, &kept.levels)?;
                (kept, cube, Origin::Cached)
            }
            None => {
                // A device that draws nothing must not leave its zeros for others.
                let keep = cache.is_on() && gpu.info().backend != wgpu::Backend::Noop;
                let (kept, cube) = make(gpu, (&environment.name, &map), settings, &shape, keep, progress)?;
                if keep {
                    cache.store(key, entry::LIGHT, || entry::encode_light(&kept, &shape), &mut warnings);
                }
                (kept, cube, Origin::Computed)
            }
        };
        Ok(Self {
            name: environment.name.clone(),
            irradiance: kept.sh.windowed(settings.window).irradiance_coefficients(),
            bands: settings.bands,
            specular: texture::cube_view(&cube),
            format,
            cube_texels: settings.cube_texels,
            level_count: settings.levels,
            roughness_one_lod: (settings.levels - 1) as f32,
            texel_nits: kept.texel_nits,
            luminance_nits: luminance_from_rec709(kept.average) as f32,
            dominant_direction: kept.sh.dominant_direction().map(|d| d.as_vec3()),
            sun: environment.sun.clone(),
            origin,
            warnings,
            size_bytes: shape.bytes(),
        })
    }

    /// The coefficients times `scale`: intensity times exposure gives what shaders are handed.
    #[must_use]
    pub fn exposed_irradiance(&self, scale: f32) -> [Vec4; IRRADIANCE_COEFFICIENTS] {
        self.irradiance.map(|c| c * scale)
    }
}

fn make(
    gpu: &Gpu,
    (name, map): (&str, &EquirectMap),
    settings: &IblSettings,
    shape: &texture::CubeShape,
    keep: bool,
    progress: &mut ProgressFn<'_>,
) -> Result<(Kept, wgpu::Texture), IblError> {
    let sh = Sh::project(map, settings.bands);
    let average = map.average();
    let bake::Baked { cube, texel_nits, levels } =
        bake::specular_cube(gpu, (name, map), settings, shape, keep, progress)?;
    Ok((Kept { sh, average, texel_nits, levels }, cube))
}

/// All that decides what the cube and the coefficients are. The window is applied after the cache.
fn key(map: &EquirectMap, settings: &IblSettings, format: TextureFormat) -> Key {
    let mut key = Key::new("image light");
    key.add(&[map.width(), map.height(), settings.cube_texels, settings.levels, settings.bands.count() as u32]);
    key.add_text(&format!("{format:?}"));
    key.add(map.texels());
    for level in 0..settings.levels {
        key.add(&bake::level_kernel(settings, level));
    }
    key.add_shader("pass/ibl.wgsl");
    key
}

#[cfg(test)]
mod tests;
