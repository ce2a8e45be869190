//! Prefiltered environment: the contribution of an environment to shading.

use framegraph_scene::environment::ShBands;
use framegraph_scene::light::Light;
use glam::{Vec3, Vec4};
use wgpu::{TextureFormat, TextureView};

/// Number of coefficients for five bands of irradiance: 9 + 0 + 9.
pub const IRRADIANCE_COEFFICIENTS: usize = 18;

/// Prefiltered environment on a device.
///
/// Irradiance/π is `irradiance_sh5(irradiance, n)` of `wgsl/lib/sh.wgsl`. For fewer [`bands`](Self::bands), use `sh2`
/// or `sh` with the first 4 or 9 coefficients. Prefiltered radiance is the specular cube at `specular_lod(roughness,
/// roughness_one_lod)` of `wgsl/lib/image_light.wgsl`, times [`texel_nits`](Self::texel_nits). Both are in nits for an
/// environment in nits. Multiply them by intensity and exposure.
#[derive(Debug)]
pub struct ImageLight {
    /// Name of the environment, for messages.
    pub name: String,
    /// Irradiance / π as coefficients of the polynomials of `irradiance_sh5`: bands 0 to 2 in the first nine, band 4
    /// in the others. xyz is linear Rec.709 in nits, w is 0. Omitted bands are zero. An `array<vec4<f32>, 18>` in a
    /// uniform buffer has this layout.
    pub irradiance: [Vec4; IRRADIANCE_COEFFICIENTS],
    /// Number of bands that a shader needs to evaluate.
    pub bands: ShBands,
    /// Cube view of all levels of prefiltered radiance, in units of [`texel_nits`](Self::texel_nits). Sample it
    /// trilinearly.
    pub specular: TextureView,
    /// Format of the cube's texels: `Rg11b10Ufloat` or `Rgba16Float`, or `Rgba8Unorm` for RGBM ([`is_rgbm`](Self::is_rgbm)).
    pub format: TextureFormat,
    /// Width and height of level 0 of the cube in texels.
    pub cube_texels: u32,
    /// Number of levels of the cube, from a mirror to roughness 1.
    pub level_count: u32,
    /// Index of the last level, as an argument of `specular_lod`.
    pub roughness_one_lod: f32,
    /// Radiance in nits of a texel with value 1: a power of two that brings the brightest texel into the range of the
    /// format.
    pub texel_nits: f32,
    /// Mean luminance over all directions, without the sun, in nits.
    pub luminance_nits: f32,
    /// Unit vector toward the dominant light; `None` for uniform light.
    pub dominant_direction: Option<Vec3>,
    /// True if the environment is uniform. Lobes then use the harmonics, and the cube is not read.
    pub is_even: bool,
    /// Sun, if it is separate from the map.
    pub sun: Option<Light>,
    /// True if the cube was loaded from a cache on disk.
    pub from_cache: bool,
    /// One line for each clamped value and each cache error.
    pub warnings: Vec<String>,
    /// Size of the cube in bytes.
    pub size_bytes: u64,
}

impl ImageLight {
    /// Returns true if shaders must decode the cube's texels by `linear_from_rgbm` of `wgsl/lib/rgbm.wgsl`.
    #[must_use]
    pub fn is_rgbm(&self) -> bool {
        self.format == TextureFormat::Rgba8Unorm
    }

    /// Returns the coefficients times `scale`. Shaders expect intensity times exposure.
    #[must_use]
    pub fn exposed_irradiance(&self, scale: f32) -> [Vec4; IRRADIANCE_COEFFICIENTS] {
        self.irradiance.map(|c| c * scale)
    }
}
