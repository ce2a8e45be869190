//! The DFG table: how much the lobes reflect, whatever the environment.

use framegraph_shaders::reference::dfg::Visibility;
use wgpu::TextureView;

/// How fine the table is, and which visibility term it goes with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DfgSettings {
    /// Width and height in texels, 16…256. 128 err by at most 0.0022, 64 by 0.0057.
    pub texels: u32,
    /// The term that shades: a table made for another breaks the white furnace twice.
    pub visibility: Visibility,
}

impl Default for DfgSettings {
    fn default() -> Self {
        Self { texels: 128, visibility: Visibility::Exact }
    }
}

/// Directional albedo of the lobes, on one device: `Rgba16Float`, columns from n·v = 0 to 1, rows from
/// perceptual roughness 0 to 1, texel centers at both ends. To be looked up at `dfg_uv` of
/// `wgsl/lib/dfg.wgsl`, bilinearly and clamped.
///
/// Red is ∫ D·V·Fc·cos with Fc = (1 - v·h)⁵ and green ∫ D·V·cos: the specular albedo is
/// mix(red, green, f0), and multiple scattering gives back f0·(1/green - 1). Blue is ∫ D·V·cos of the
/// cloth lobe. Alpha is 1.
#[derive(Debug)]
pub struct DfgTable {
    /// The texture, of one level.
    pub view: TextureView,
    /// Its size and visibility term.
    pub settings: DfgSettings,
    /// Whether it was found in a cache on disk rather than computed.
    pub from_cache: bool,
    /// What went wrong with the cache, a line each; the table is right all the same.
    pub warnings: Vec<String>,
}
