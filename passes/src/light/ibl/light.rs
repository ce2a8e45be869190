//! Image-based light: what an environment adds to every surface, ready for shaders to look up.

use framegraph_scene::environment::ShBands;
use framegraph_scene::light::Light;
use glam::{Vec3, Vec4};
use wgpu::{TextureFormat, TextureView};

/// Coefficients that five bands of irradiance leave: 9 + 0 + 9.
pub const IRRADIANCE_COEFFICIENTS: usize = 18;

/// An environment as light, on one device.
///
/// To shade with it: irradiance/π is `irradiance_sh5(irradiance, n)` (or `sh2`, `sh` with the first 4 or
/// 9, see [`bands`](Self::bands)) of `wgsl/lib/sh.wgsl`; the radiance that a lobe gathers is the specular
/// cube at `specular_lod(roughness, roughness_one_lod)` of `wgsl/lib/image_light.wgsl` times
/// [`texel_nits`](Self::texel_nits). Both are in nits for an environment in nits: multiply by intensity
/// and exposure.
#[derive(Debug)]
pub struct ImageLight {
    /// The environment's name, for messages.
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
    /// Format of the cube's texels: `Rg11b10Ufloat` or `Rgba16Float`, or `Rgba8Unorm` for RGBM ([`is_rgbm`](Self::is_rgbm)).
    pub format: TextureFormat,
    /// Width and height of level 0 of the cube in texels.
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
    /// The environment is the same in all directions: lobes see what the harmonics say, and the cube is not read.
    pub is_even: bool,
    /// The sun, where it is apart from the map.
    pub sun: Option<Light>,
    /// Whether the cube was found in a cache on disk rather than computed.
    pub from_cache: bool,
    /// Texels that were clamped, and what went wrong with the cache, a line each.
    pub warnings: Vec<String>,
    /// Bytes of the cube.
    pub size_bytes: u64,
}

impl ImageLight {
    /// Whether shaders decode the cube's texels by `linear_from_rgbm` of `wgsl/lib/rgbm.wgsl`.
    #[must_use]
    pub fn is_rgbm(&self) -> bool {
        self.format == TextureFormat::Rgba8Unorm
    }

    /// The coefficients times `scale`: intensity times exposure gives what shaders are handed.
    #[must_use]
    pub fn exposed_irradiance(&self, scale: f32) -> [Vec4; IRRADIANCE_COEFFICIENTS] {
        self.irradiance.map(|c| c * scale)
    }
}
