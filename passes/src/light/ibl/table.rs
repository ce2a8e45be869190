//! DFG table: directional albedo of the lobes, independent of the environment.

use framegraph_shaders::reference::dfg::Visibility;
use wgpu::TextureView;

/// Size and visibility term of the DFG table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DfgSettings {
    /// Width and height in texels, 16…256. The error is at most 0.0022 with 128 texels, and 0.0057 with 64.
    pub texels: u32,
    /// Visibility term of shading. Another term breaks energy conservation.
    pub visibility: Visibility,
}

impl Default for DfgSettings {
    fn default() -> Self {
        Self { texels: 128, visibility: Visibility::Exact }
    }
}

/// Directional albedo of the lobes, on a device: `Rgba16Float`, columns from n·v = 0 to 1, rows from perceptual
/// roughness 0 to 1, texel centers at both ends. Sample it at `dfg_uv` of `wgsl/lib/dfg.wgsl`, bilinearly and clamped.
///
/// Red is ∫ D·V·Fc·cos with Fc = (1 - v·h)⁵, and green ∫ D·V·cos. The specular albedo is mix(red, green, f0), and
/// multiple scattering adds the factor f0·(1/green - 1). Blue is ∫ D·V·cos of the cloth lobe. Alpha is 1.
#[derive(Debug)]
pub struct DfgTable {
    /// View of the texture, which has one level.
    pub view: TextureView,
    /// Size and visibility term.
    pub settings: DfgSettings,
    /// True if the table was loaded from a cache on disk.
    pub from_cache: bool,
    /// One line for each cache error. The table is valid in spite of them.
    pub warnings: Vec<String>,
}
