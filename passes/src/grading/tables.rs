//! Tables on the device, made when they are first asked for.

use super::bake::Baked;
use super::by::{TableDesc, TableFormat};
use super::error::GradingError;
use super::look::{Extras, Look, OwnCurve};
use framegraph_scene::ColorTable;
use framegraph_wgpu::Gpu;
use std::sync::{Arc, Mutex};
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{Extent3d, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView};

/// Most tables that are kept: one for each of a few views. The one made first goes first.
const MAX_TABLES: usize = 8;

/// Tables of looks, by what they were made of: a look that stays has its table made once. A part of the world that
/// [`Post`](crate::effects::post::Post) is recorded with; of one device.
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

/// A table to sample.
#[derive(Clone, Debug)]
pub(crate) struct GpuTable {
    /// Whether it has three axes.
    pub(crate) cube: bool,
    /// The texture.
    pub(crate) view: TextureView,
}

impl GradingTables {
    /// The curve of [`ToneMap::Own`](framegraph_shaders::layout::ToneMap::Own). Tables are made anew.
    pub fn set_own(&mut self, curve: Option<OwnCurve>) {
        self.extras.own = curve;
        self.forget();
    }

    /// Colors that sRGB codes become after everything else, as a `.cube` file states them. Tables are made anew.
    pub fn set_colors(&mut self, colors: Option<ColorTable>) {
        self.extras.colors = colors.map(Arc::new);
        self.forget();
    }

    /// What looks may have beside their settings.
    pub fn extras(&self) -> &Extras {
        &self.extras
    }

    /// How many tables there are.
    pub fn count(&self) -> usize {
        self.made.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).len()
    }

    fn forget(&mut self) {
        self.made.get_mut().unwrap_or_else(|poisoned| poisoned.into_inner()).clear();
    }

    /// The table of a look, made if there is none yet.
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
