//! Descriptions of physical textures and buffers.

use crate::device::format::{buffer_usages, texture_usages};
use framegraph::{Dimension, Format, TextureDesc, Usage};
use wgpu::{BufferUsages, TextureUsages};

/// Description of a physical texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PhysicalTextureDesc {
    /// Width and height in texels, and number of layers (or depth of a 3D texture).
    pub size: [u32; 3],
    /// Format; the linear form if `srgb_views` is set.
    pub format: Format,
    /// Number of mip levels.
    pub mips: u32,
    /// Samples per texel.
    pub samples: u32,
    /// 2D or 3D.
    pub dimension: Dimension,
    /// Usages.
    pub usage: TextureUsages,
    /// True if views may use the linear or the sRGB form of the format.
    pub srgb_views: bool,
}

impl PhysicalTextureDesc {
    /// Creates the description of `desc` in a frame of `frame` texels.
    pub fn new(desc: &TextureDesc, frame: [u32; 2], usage: Usage, srgb_views: bool) -> Self {
        let [width, height] = desc.extent.texels(frame);
        // Multisampled textures must have render attachment usage.
        let of_samples = match desc.samples {
            1 => TextureUsages::empty(),
            _ => TextureUsages::RENDER_ATTACHMENT,
        };
        Self {
            size: [width, height, u32::from(desc.layers)],
            format: if srgb_views { desc.format.without_srgb() } else { desc.format },
            mips: desc.mip_count(frame),
            samples: u32::from(desc.samples),
            dimension: desc.dimension,
            usage: texture_usages(usage) | of_samples,
            srgb_views,
        }
    }

    /// Returns the description with the usages of a memoryless attachment. WebGPU requires exactly these two.
    #[must_use]
    pub fn memoryless(mut self) -> Self {
        self.usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TRANSIENT_ATTACHMENT;
        self
    }

    /// Returns the usages of a view in `format`. An sRGB view of a linear texture does not support storage.
    pub fn view_usages(&self, format: Format) -> TextureUsages {
        if format.is_srgb() { self.usage - TextureUsages::STORAGE_BINDING } else { self.usage }
    }

    /// Returns whether the texture is memoryless on devices with tile memory.
    pub fn is_memoryless(&self) -> bool {
        self.usage.contains(TextureUsages::TRANSIENT_ATTACHMENT)
    }
}

/// Description of a physical buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PhysicalBufferDesc {
    /// Size in bytes, rounded up to a multiple of 4 for copies and clears.
    pub bytes: u64,
    /// Usages.
    pub usage: BufferUsages,
}

impl PhysicalBufferDesc {
    /// Creates the description of a buffer of `bytes` bytes. Copy usages are always included, since they cost nothing.
    pub fn new(bytes: u64, usage: Usage) -> Self {
        let usage = buffer_usages(usage) | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        Self { bytes: bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT), usage }
    }
}
