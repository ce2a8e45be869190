//! The DFG table on the GPU.

use std::path::Path;

use framegraph_shaders::reference::dfg::Visibility;
use framegraph_shaders::{Module, library};
use wgpu::{
    Extent3d, TexelCopyBufferLayout, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
    TextureView,
};

use super::cache::{Cache, Key};
use super::draw::{Program, draw};
use super::{IblError, Origin, entry};
use framegraph_scene::error::SceneError;
use framegraph_scene::progress::{Progress, ProgressFn, Stage, report};
use framegraph_wgpu::{DeviceError, Gpu, read_texture};

const DFG: Module<'_> = library::pass("pass/dfg.wgsl").unwrap();

/// Rows that one submission draws: what can be interrupted.
const ROWS_PER_STEP: u32 = 16;

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

impl DfgSettings {
    /// Visible-normal samples of the GGX lobe in each texel.
    pub const GGX_SAMPLES: u32 = 1024;
    /// Uniform samples of the cloth lobe in each texel.
    pub const CLOTH_SAMPLES: u32 = 4096;

    fn check(&self) -> Result<(), SceneError> {
        if (16..=256).contains(&self.texels) {
            return Ok(());
        }
        let value = self.texels.to_string();
        Err(SceneError::Parameter { parameter: "DFG table size", value, range: "16…256 texels" })
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
    /// The table.
    pub view: TextureView,
    /// Its size and term.
    pub settings: DfgSettings,
    /// Whether it was computed or found.
    pub origin: Origin,
    /// What went wrong with the cache, a line each; the table is right all the same.
    pub warnings: Vec<String>,
}

impl DfgTable {
    /// Computes the table, or finds it in `cache`. Reports each step as
    /// [`Stage::Lighting`].
    ///
    /// # Errors
    ///
    /// When the size is out of range, when `progress` asks to stop, or when the device fails.
    pub fn new(
        gpu: &Gpu,
        settings: DfgSettings,
        cache: &Cache,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, IblError> {
        settings.check()?;
        let key = key(settings);
        let mut warnings = Vec::new();
        let found = cache.load(key, entry::DFG, &mut warnings).and_then(|payload| {
            let texels = entry::decode_dfg(&payload, settings.texels);
            texels.map_err(|reason| warnings.push(cache.damaged(key, reason))).ok()
        });
        let (texture, origin) = match found {
            Some(bytes) => (write(gpu, settings.texels, &bytes)?, Origin::Cached),
            None => {
                let texture = integrate(gpu, settings, progress)?;
                if cache.is_on() && gpu.info().backend != wgpu::Backend::Noop {
                    let bytes = read_texture(gpu, &texture)?.bytes;
                    cache.store(key, entry::DFG, || entry::encode_dfg(&bytes, settings.texels), &mut warnings);
                }
                (texture, Origin::Computed)
            }
        };
        Ok(Self { view: texture.create_view(&Default::default()), settings, origin, warnings })
    }
}

fn key(settings: DfgSettings) -> Key {
    let mut key = Key::new("DFG table");
    let fast = u32::from(settings.visibility == Visibility::Fast);
    key.add(&[settings.texels, fast, DfgSettings::GGX_SAMPLES, DfgSettings::CLOTH_SAMPLES]);
    key.add_shader("pass/dfg.wgsl");
    key
}

fn create(gpu: &Gpu, texels: u32, usage: TextureUsages) -> Texture {
    gpu.device.create_texture(&TextureDescriptor {
        label: Some("dfg"),
        size: Extent3d { width: texels, height: texels, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba16Float,
        usage: usage | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn integrate(gpu: &Gpu, settings: DfgSettings, progress: &mut ProgressFn<'_>) -> Result<Texture, IblError> {
    let texels = settings.texels;
    let program = Program::new(gpu, &DFG)?;
    let fast = f64::from(u8::from(settings.visibility == Visibility::Fast));
    let constants = [
        ("TABLE_TEXELS", f64::from(texels)),
        ("FAST_VISIBILITY", fast),
        ("GGX_SAMPLES", f64::from(DfgSettings::GGX_SAMPLES)),
        ("CLOTH_SAMPLES", f64::from(DfgSettings::CLOTH_SAMPLES)),
    ];
    let pipeline = program.pipeline(gpu, "fs_main", TextureFormat::Rgba16Float, &constants)?;
    let texture = gpu.guard("the DFG table", || create(gpu, texels, TextureUsages::RENDER_ATTACHMENT))?;
    let view = texture.create_view(&Default::default());
    let total = texels.div_ceil(ROWS_PER_STEP);
    for step in 0..total {
        let rows = step * ROWS_PER_STEP..((step + 1) * ROWS_PER_STEP).min(texels);
        gpu.guard("the DFG table", || draw(gpu, &pipeline, &view, texels, rows, &[]))?;
        gpu.wait()?;
        let progressed =
            Progress { stage: Stage::Lighting, done: step as usize + 1, total: total as usize, item: "DFG table" };
        report(progress, Path::new("DFG table"), progressed)?;
    }
    Ok(texture)
}

fn write(gpu: &Gpu, texels: u32, bytes: &[u8]) -> Result<Texture, DeviceError> {
    gpu.guard("the DFG table", || {
        let texture = create(gpu, texels, TextureUsages::COPY_DST);
        gpu.queue.write_texture(
            texture.as_image_copy(),
            bytes,
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texels * 8), rows_per_image: None },
            Extent3d { width: texels, height: texels, depth_or_array_layers: 1 },
        );
        texture
    })
}
