//! What a physical texture or buffer is made from.

use crate::device::format::{buffer_usages, texture_usages};
use framegraph::{Dimension, Format, TextureDesc, Usage};
use wgpu::{BufferUsages, TextureUsages};

/// Everything that a physical texture is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PhysicalTextureDesc {
    /// Width and height in texels, then layers (or the depth of a three-dimensional texture).
    pub size: [u32; 3],
    /// The format it is made with; the linear one when `srgb_views` is set.
    pub format: Format,
    /// Mip levels.
    pub mips: u32,
    /// Samples per texel.
    pub samples: u32,
    /// Two or three dimensions.
    pub dimension: Dimension,
    /// What it may be used for.
    pub usage: TextureUsages,
    /// Views may have the linear or the sRGB form of the format.
    pub srgb_views: bool,
}

impl PhysicalTextureDesc {
    /// The shape of `desc` in a frame of `frame` texels.
    pub fn new(desc: &TextureDesc, frame: [u32; 2], usage: Usage, srgb_views: bool) -> Self {
        let [width, height] = desc.extent.texels(frame);
        // wgpu makes no multisampled texture that could not be drawn into.
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

    /// The same for an attachment that never leaves the tile: WebGPU wants exactly these two uses.
    #[must_use]
    pub fn memoryless(mut self) -> Self {
        self.usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TRANSIENT_ATTACHMENT;
        self
    }

    /// The uses that a view in `format` may have: an sRGB view of a linear texture cannot be written as storage.
    pub fn view_usages(&self, format: Format) -> TextureUsages {
        if format.is_srgb() { self.usage - TextureUsages::STORAGE_BINDING } else { self.usage }
    }

    /// Whether the texture needs no memory where the device has tiles.
    pub fn is_memoryless(&self) -> bool {
        self.usage.contains(TextureUsages::TRANSIENT_ATTACHMENT)
    }
}

/// Everything that a physical buffer is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PhysicalBufferDesc {
    /// Size in bytes, rounded up to a multiple of 4, which copies and clears need.
    pub bytes: u64,
    /// What it may be used for.
    pub usage: BufferUsages,
}

impl PhysicalBufferDesc {
    /// The shape of a buffer of `bytes` bytes. Copying is always allowed: it costs nothing.
    pub fn new(bytes: u64, usage: Usage) -> Self {
        let usage = buffer_usages(usage) | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        Self { bytes: bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT), usage }
    }
}
