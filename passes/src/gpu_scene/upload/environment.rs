//! An environment map on the GPU.

use std::path::Path;

use bytemuck::cast_slice;
use wgpu::{TextureFormat, TextureView};

use super::buffers::limit;
use super::error::UploadError;
use super::textures::write_levels;
use framegraph_scene::environment::Environment;
use framegraph_scene::error::Quantity;
use framegraph_scene::progress::{Progress, ProgressFn, Stage, report};
use framegraph_wgpu::Gpu;

/// Equirectangular radiance map as RGBA16F with a full mip chain, averaged by solid angle. Values are clamped to
/// 65504.
#[derive(Debug)]
pub struct GpuEnvironment {
    /// The whole map, all levels.
    pub view: TextureView,
    /// Width and height of level 0 in texels.
    pub size_texels: [u32; 2],
    /// Number of levels.
    pub level_count: u32,
    /// Size of all levels in bytes.
    pub size_bytes: u64,
}

impl GpuEnvironment {
    /// Uploads the map.
    ///
    /// # Errors
    ///
    /// Fails if the map exceeds a limit of the device, `progress` stops the work, or the device fails.
    pub fn upload(gpu: &Gpu, environment: &Environment, progress: &mut ProgressFn<'_>) -> Result<Self, UploadError> {
        let (name, map) = (&environment.name, &environment.map);
        let side = u64::from(map.width().max(map.height()));
        let largest = gpu.device.limits().max_texture_dimension_2d;
        limit(name, Quantity::Side, side, largest.into())?;
        let levels = map.radiance_levels();
        let bytes: Vec<_> = levels.iter().map(|l| (l.width, l.height, cast_slice::<_, u8>(&l.rgba16f))).collect();
        let view = gpu.guard("the environment map", || {
            write_levels(gpu, name, TextureFormat::Rgba16Float, 8, bytes.iter().copied())
        })?;
        let step = Progress { stage: Stage::Upload, done: 1, total: 1, item: name };
        report(progress, Path::new(name), step)?;
        Ok(Self {
            view,
            size_texels: [map.width(), map.height()],
            level_count: levels.len() as u32,
            size_bytes: bytes.iter().map(|(.., b)| b.len() as u64).sum(),
        })
    }
}
