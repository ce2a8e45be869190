//! Lookup tables on the device, made on first use.

use super::bake::Baked;
use super::by::{TableDesc, TableFormat};
use super::error::GradingError;
use super::look::{Extras, Look, OwnCurve};
use framegraph_scene::ColorTable;
use framegraph_wgpu::Gpu;
use std::sync::{Arc, Mutex};
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView};

/// Maximum number of cached tables: one for each of a few views. The oldest is removed first.
const MAX_TABLES: usize = 8;

/// Cache of lookup tables by look: a table is made once while its look stays the same. Part of the world of
/// [`Post`](crate::effects::post::Post). Belongs to one device.
#[derive(Debug, Default)]
pub struct GradingTables {
    extras: Extras,
    made: Mutex<Vec<Made>>,
}

#[derive(Clone, Debug)]
struct Made {
    look: Look,
    desc: TableDesc,
    table: GpuTable,
}

/// Lookup table on the device.
#[derive(Clone, Debug)]
pub(crate) struct GpuTable {
    /// True for three axes.
    pub(crate) cube: bool,
    /// Texture of the table.
    pub(crate) view: TextureView,
}

impl GradingTables {
    /// Sets the curve for [`ToneMap::Own`](framegraph_shaders::layout::ToneMap::Own). Discards all tables.
    pub fn set_own(&mut self, curve: Option<OwnCurve>) {
        self.extras.own = curve;
        self.forget();
    }

    /// Sets the color table applied after everything else, such as one from a `.cube` file. Discards all tables.
    pub fn set_colors(&mut self, colors: Option<ColorTable>) {
        self.extras.colors = colors.map(Arc::new);
        self.forget();
    }

    /// Returns the parts of looks that exist only on the CPU.
    pub fn extras(&self) -> &Extras {
        &self.extras
    }

    /// Returns the number of cached tables.
    pub fn count(&self) -> usize {
        self.made.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).len()
    }

    fn forget(&mut self) {
        self.made.get_mut().unwrap_or_else(|poisoned| poisoned.into_inner()).clear();
    }

    /// Returns the table of a look, and makes it if it is not cached.
    pub(crate) fn get(&self, gpu: &Gpu, look: &Look, desc: TableDesc) -> Result<GpuTable, GradingError> {
        let mut made = self.made.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(found) = made.iter().find(|made| made.look == *look && made.desc == desc) {
            return Ok(found.table.clone());
        }
        let table = upload(gpu, &Baked::new(look, &self.extras, desc)?);
        if made.len() == MAX_TABLES {
            made.remove(0);
        }
        made.push(Made { look: *look, desc, table: table.clone() });
        Ok(table)
    }
}

fn upload(gpu: &Gpu, baked: &Baked) -> GpuTable {
    let side = baked.entries as u32;
    let (size, dimension) = if baked.cube {
        (Extent3d { width: side, height: side, depth_or_array_layers: side }, TextureDimension::D3)
    } else {
        (Extent3d { width: side, height: 1, depth_or_array_layers: 1 }, TextureDimension::D2)
    };
    let desc = TextureDescriptor {
        label: Some("grading table"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension,
        format: match baked.format {
            TableFormat::Rgb10 => TextureFormat::Rgb10a2Unorm,
            TableFormat::Half => TextureFormat::Rgba16Float,
        },
        usage: TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let order = TextureDataOrder::LayerMajor;
    let texture = gpu.device.create_texture_with_data(&gpu.queue, &desc, order, &baked.bytes);
    GpuTable {
        cube: baked.cube,
        view: texture.create_view(&wgpu::TextureViewDescriptor { label: Some("grading table"), ..Default::default() }),
    }
}
