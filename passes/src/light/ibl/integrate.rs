//! Computation of the DFG table on the GPU, some rows per slice.

use std::ops::Range;
use std::sync::Arc;

use framegraph::{
    ClearValue, DeclareError, Entry, Exit, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc,
};
use framegraph_shaders::reference::dfg::Visibility;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, DeviceError, Frame, Gpu, Imports, Record, RecordError, read_texture, texture_2d};
use wgpu::{TexelCopyBufferLayout, TextureFormat, TextureUsages};

use super::cache::{Cache, Key};
use super::entry;
use super::error::IblError;
use super::slices::Slices;
use super::table::{DfgSettings, DfgTable};
use crate::program::full_screen;
use crate::program::{Interface, Program, ProgramDesc};
use framegraph_scene::error::SceneError;
use framegraph_scene::progress::ProgressFn;

static DFG: Module<'static> = library::pass("pass/dfg.wgsl").unwrap();

/// Number of rows per slice; the work can be interrupted between slices.
const ROWS_PER_SLICE: u32 = 16;

/// Interface of [`IntegrateRows`].
static INTERFACE: Interface =
    Interface { groups: &[], constants: &["TABLE_TEXELS", "FAST_VISIBILITY", "GGX_SAMPLES", "CLOTH_SAMPLES"] };

impl DfgSettings {
    /// Number of visible-normal samples of the GGX lobe for each texel.
    pub const GGX_SAMPLES: u32 = 1024;
    /// Number of uniform samples of the cloth lobe for each texel.
    pub const CLOTH_SAMPLES: u32 = 4096;

    fn check(&self) -> Result<(), SceneError> {
        if (16..=256).contains(&self.texels) {
            return Ok(());
        }
        Err(SceneError::Parameter { parameter: "DFG table size", value: self.texels.into(), range: "16…256 texels" })
    }
}

impl DfgTable {
    /// Computes the table, or loads it from `cache`. Reports each slice as
    /// [`Stage::Lighting`](framegraph_scene::Stage::Lighting).
    ///
    /// # Errors
    ///
    /// Fails if the size is out of range, `progress` stops the work, or the device fails.
    pub fn new(
        gpu: &Gpu,
        settings: DfgSettings,
        cache: &Cache,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, IblError> {
        settings.check()?;
        let key = key(settings);
        let mut warnings = Vec::new();
        let found = cache.load(key, entry::DFG, &mut warnings, |payload| entry::decode_dfg(payload, settings.texels));
        let from_cache = found.is_some();
        let texture = match found {
            Some(bytes) => write(gpu, settings.texels, &bytes)?,
            None => {
                let texture = integrate(gpu, settings, progress)?;
                if cache.keeps_results_of(gpu) {
                    let bytes = read_texture(gpu, &texture)?.bytes;
                    cache.store(key, entry::DFG, &entry::encode_dfg(&bytes, settings.texels), &mut warnings);
                }
                texture
            }
        };
        Ok(Self {
            view: texture.create_view(&wgpu::TextureViewDescriptor { label: Some("dfg"), ..Default::default() }),
            settings,
            from_cache,
            warnings,
        })
    }
}

fn key(settings: DfgSettings) -> Key {
    let mut key = Key::of("DFG table", "pass/dfg.wgsl");
    let fast = u32::from(settings.visibility == Visibility::Fast);
    key.add(&[settings.texels, fast, DfgSettings::GGX_SAMPLES, DfgSettings::CLOTH_SAMPLES]);
    key
}

/// Creates an empty table for sampling, readback and `usage`.
pub(super) fn create(gpu: &Gpu, texels: u32, usage: TextureUsages) -> Result<wgpu::Texture, DeviceError> {
    gpu.guard("the DFG table", || {
        gpu.device.create_texture(&texture_2d(
            "dfg",
            [texels, texels],
            TextureFormat::Rgba16Float,
            usage | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
        ))
    })
}

fn integrate(gpu: &Gpu, settings: DfgSettings, progress: &mut ProgressFn<'_>) -> Result<wgpu::Texture, IblError> {
    let program = program()?;
    let table = create(gpu, settings.texels, TextureUsages::RENDER_ATTACHMENT)?;
    let total = settings.texels.div_ceil(ROWS_PER_SLICE);
    let mut slices = Slices::new(gpu, "DFG table", total as usize, progress);
    for slice in 0..total {
        let declare = |frame: &mut Frame, imports: &mut Imports| {
            let texture = declare_slice(settings, slice, &program, frame)?;
            imports.texture(texture, &table);
            Ok(())
        };
        slices.run("DFG table", declare)?;
    }
    Ok(table)
}

/// Returns the integration shader.
pub(super) fn program() -> Result<Arc<Program>, IblError> {
    Ok(Arc::new(Program::new(&ProgramDesc::new(&DFG, &INTERFACE))?))
}

/// Declares one slice and returns the imported table. The first slice clears the table, and later ones keep its rows.
pub(super) fn declare_slice(
    settings: DfgSettings,
    slice: u32,
    program: &Arc<Program>,
    frame: &mut Frame,
) -> Result<Texture, DeclareError> {
    let texels = settings.texels;
    let (entry, intent) = match slice {
        0 => (Entry::Undefined, Intent::Clear(ClearValue::BLACK)),
        _ => (Entry::Defined, Intent::Modify),
    };
    let desc = TextureDesc::new(Extent::absolute(texels, texels), Format::Rgba16Float);
    let table = frame.graph_mut().import_texture("DFG table", desc, entry, Exit::Keep);
    let rows = slice * ROWS_PER_SLICE..((slice + 1) * ROWS_PER_SLICE).min(texels);
    frame.add("integrate", IntegrateRows { program: program.clone(), settings, table, intent, rows })
}

/// Integrates some rows of the table.
struct IntegrateRows {
    program: Arc<Program>,
    settings: DfgSettings,
    table: Texture,
    /// Load operation for the other rows.
    intent: Intent,
    rows: Range<u32>,
}

impl Pass for IntegrateRows {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        pass.color(self.table, self.intent)
    }
}

impl Record for IntegrateRows {
    fn record(&self, _: &Texture, (): &(), cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let Self { program, settings: DfgSettings { texels, visibility }, rows, .. } = self;
        let constants = [
            f64::from(*texels),
            f64::from(*visibility == Visibility::Fast),
            DfgSettings::GGX_SAMPLES.into(),
            DfgSettings::CLOTH_SAMPLES.into(),
        ];
        cx.render_pass()?.set_scissor_rect(0, rows.start, *texels, rows.end - rows.start);
        full_screen::draw(program, &constants, &[], Depth::NONE, cx)
    }
}

/// Creates a table from bytes in rows without padding.
fn write(gpu: &Gpu, texels: u32, bytes: &[u8]) -> Result<wgpu::Texture, DeviceError> {
    let texture = create(gpu, texels, TextureUsages::COPY_DST)?;
    gpu.guard("the DFG table", || {
        gpu.queue.write_texture(
            texture.as_image_copy(),
            bytes,
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texels * 8), rows_per_image: None },
            texture.size(),
        );
    })?;
    Ok(texture)
}
