//! Specular cube as a texture: format, bytes, views.

use super::settings::EnvironmentFormat;
use framegraph::{Extent, Format, TextureDesc};
use framegraph_scene::environment::EquirectMap;
use framegraph_wgpu::{DeviceError, Gpu, texture_2d, texture_format};
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{
    Extent3d, TexelCopyBufferLayout, Texture, TextureDescriptor, TextureDimension, TextureFormat,
    TextureFormatFeatureFlags, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

/// Size, levels and format of a specular cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CubeShape {
    pub texels: u32,
    pub levels: u32,
    pub format: Format,
}

impl CubeShape {
    /// Returns the width and height of a level.
    pub fn level_texels(&self, level: u32) -> u32 {
        (self.texels >> level).max(1)
    }

    pub fn texel_bytes(&self) -> u32 {
        self.format.block_bytes()
    }

    /// Returns the size of one face of a level in bytes.
    pub fn face_bytes(&self, level: u32) -> usize {
        (self.level_texels(level).pow(2) * self.texel_bytes()) as usize
    }

    /// Returns the size of all levels in bytes.
    pub fn bytes(&self) -> u64 {
        (0..self.levels).map(|level| 6 * self.face_bytes(level) as u64).sum()
    }

    /// Returns the texture description for graphs.
    pub fn desc(&self) -> TextureDesc {
        TextureDesc::new(Extent::absolute(self.texels, self.texels), self.format).mips(self.levels as u8).layers(6)
    }

    /// Creates an empty cube for sampling and `usage`.
    pub fn create(&self, gpu: &Gpu, label: &str, usage: TextureUsages) -> Texture {
        gpu.device.create_texture(&TextureDescriptor {
            label: Some(label),
            size: Extent3d { width: self.texels, height: self.texels, depth_or_array_layers: 6 },
            mip_level_count: self.levels,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: texture_format(self.format),
            usage: usage | TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })
    }
}

/// Returns the format to render a cube in: the smallest that the device can render to and filter, or half floats on
/// request. RGBM is encoded from half floats.
pub(super) fn cube_format(gpu: &Gpu, asked: EnvironmentFormat) -> Format {
    let features = gpu.format_features(Format::Rg11b10Ufloat);
    let usages = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    let small =
        features.allowed_usages.contains(usages) && features.flags.contains(TextureFormatFeatureFlags::FILTERABLE);
    if small && asked == EnvironmentFormat::Rg11b10 { Format::Rg11b10Ufloat } else { Format::Rgba16Float }
}

/// Returns a view of the whole cube.
pub(super) fn cube_view(cube: &Texture) -> TextureView {
    cube.create_view(&TextureViewDescriptor {
        label: Some("cube"),
        dimension: Some(TextureViewDimension::Cube),
        ..Default::default()
    })
}

/// Uploads an equirectangular map in 32-bit floats. Shaders load its texels, since the format may not be filterable.
pub(super) fn panorama_texture(gpu: &Gpu, map: &EquirectMap) -> Texture {
    let desc =
        texture_2d("panorama", [map.width(), map.height()], TextureFormat::Rgba32Float, TextureUsages::TEXTURE_BINDING);
    let texels = bytemuck::cast_slice(map.texels());
    gpu.device.create_texture_with_data(&gpu.queue, &desc, TextureDataOrder::LayerMajor, texels)
}

/// Creates a cube from the bytes of each level: six consecutive faces, rows without padding.
pub(super) fn write_cube(
    gpu: &Gpu,
    label: &str,
    shape: &CubeShape,
    levels: &[Vec<u8>],
) -> Result<Texture, DeviceError> {
    gpu.guard("the specular cube", || {
        let cube = shape.create(gpu, label, TextureUsages::COPY_DST);
        for (level, bytes) in (0..).zip(levels) {
            let side = shape.level_texels(level);
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &cube,
                    mip_level: level,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                bytes,
                TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(side * shape.texel_bytes()),
                    rows_per_image: Some(side),
                },
                Extent3d { width: side, height: side, depth_or_array_layers: 6 },
            );
        }
        cube
    })
}
