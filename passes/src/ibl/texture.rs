//! The specular cube as a texture: its format, its bytes, its views.

use wgpu::{
    Extent3d, TexelCopyBufferLayout, Texture, TextureDescriptor, TextureDimension, TextureFormat,
    TextureFormatFeatureFlags, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

use framegraph::Format;
use framegraph_wgpu::{DeviceError, Gpu};

/// Size, levels and format of a specular cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CubeShape {
    pub texels: u32,
    pub levels: u32,
    pub format: TextureFormat,
}

impl CubeShape {
    /// Width and height of a level.
    pub fn level_texels(&self, level: u32) -> u32 {
        (self.texels >> level).max(1)
    }

    pub fn texel_bytes(&self) -> u32 {
        if self.format == TextureFormat::Rg11b10Ufloat { 4 } else { 8 }
    }

    /// Bytes of one face of a level.
    pub fn face_bytes(&self, level: u32) -> usize {
        (self.level_texels(level).pow(2) * self.texel_bytes()) as usize
    }

    /// Bytes of all levels.
    pub fn bytes(&self) -> u64 {
        (0..self.levels).map(|level| 6 * self.face_bytes(level) as u64).sum()
    }

    /// An empty texture of one face of a level, to draw into and copy from.
    pub fn create_face(&self, gpu: &Gpu, level: u32) -> Texture {
        let side = self.level_texels(level);
        gpu.device.create_texture(&TextureDescriptor {
            label: Some("a face of the specular cube"),
            size: Extent3d { width: side, height: side, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: self.format,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// An empty cube with these uses beside being sampled.
    pub fn create(&self, gpu: &Gpu, label: &str, usage: TextureUsages) -> Texture {
        gpu.device.create_texture(&TextureDescriptor {
            label: Some(label),
            size: Extent3d { width: self.texels, height: self.texels, depth_or_array_layers: 6 },
            mip_level_count: self.levels,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: self.format,
            usage: usage | TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })
    }
}

/// The smallest format that the device can draw into and filter.
pub(super) fn cube_format(gpu: &Gpu) -> TextureFormat {
    let features = gpu.format_features(Format::Rg11b10Ufloat);
    let usages = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    let small =
        features.allowed_usages.contains(usages) && features.flags.contains(TextureFormatFeatureFlags::FILTERABLE);
    if small { TextureFormat::Rg11b10Ufloat } else { TextureFormat::Rgba16Float }
}

/// The whole cube.
pub(super) fn cube_view(cube: &Texture) -> TextureView {
    cube.create_view(&TextureViewDescriptor {
        label: Some("cube"),
        dimension: Some(TextureViewDimension::Cube),
        ..Default::default()
    })
}

/// One level of the cube, to be sampled while another is drawn.
pub(super) fn level_view(cube: &Texture, level: u32) -> TextureView {
    cube.create_view(&TextureViewDescriptor {
        label: Some("level of a cube"),
        dimension: Some(TextureViewDimension::Cube),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

/// One face of a level, to draw into.
pub(super) fn face_view(cube: &Texture, level: u32, face: u32) -> TextureView {
    cube.create_view(&TextureViewDescriptor {
        label: Some("face of a cube"),
        dimension: Some(TextureViewDimension::D2),
        base_mip_level: level,
        mip_level_count: Some(1),
        base_array_layer: face,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// Copies a face drawn apart into its place.
pub(super) fn place_face(gpu: &Gpu, face: &Texture, cube: &Texture, level: u32, layer: u32) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let place = wgpu::TexelCopyTextureInfo {
        texture: cube,
        mip_level: level,
        origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
        aspect: wgpu::TextureAspect::All,
    };
    encoder.copy_texture_to_texture(face.as_image_copy(), place, face.size());
    gpu.queue.submit([encoder.finish()]);
}

/// A cube with these bytes: those of each level, its six faces one after the other, rows without padding.
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
