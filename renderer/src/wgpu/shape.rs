//! The shape of a physical texture or buffer: what two requests must share to be served by one object.

use super::device::Gpu;
use super::format::{buffer_usages, texture_format, texture_usages};
use super::pool::Shape;
use super::support::{Unsupported, check_buffer, check_texture};
use framegraph::{Dimension, Format, TextureDesc, Usage};
use wgpu::{Buffer, BufferUsages, Extent3d, Texture, TextureDimension, TextureUsages};

/// Everything that a physical texture is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureShape {
    /// Width and height in texels, then layers (or the depth of a three-dimensional texture).
    pub size: [u32; 3],
    /// The format it is made with; the linear one when `srgb_views` is set.
    pub format: Format,
    /// Levels.
    pub mips: u32,
    /// Samples per texel.
    pub samples: u32,
    /// Two or three dimensions.
    pub dimension: Dimension,
    /// What it may be used for.
    pub usage: TextureUsages,
    /// Views may also use the twin of the format in the sRGB transfer function.
    pub srgb_views: bool,
}

impl TextureShape {
    /// The shape of `desc` in a frame of `frame` texels.
    pub fn new(desc: &TextureDesc, frame: [u32; 2], usage: Usage, srgb_views: bool) -> Self {
        let [width, height] = desc.extent.resolve(frame);
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

impl Shape for TextureShape {
    type Object = Texture;

    fn serves(&self, request: &Self) -> bool {
        let same =
            Self { usage: request.usage, srgb_views: request.srgb_views, format: request.format, ..*self } == *request;
        let format = self.format == request.format
            || (self.srgb_views && self.format.without_srgb() == request.format.without_srgb());
        same && format
            && self.usage.contains(request.usage)
            && self.is_memoryless() == request.is_memoryless()
            && (self.srgb_views || !request.srgb_views)
    }

    fn waste(&self, request: &Self) -> u32 {
        (self.usage - request.usage).bits().count_ones() + u32::from(self.srgb_views != request.srgb_views)
    }

    fn bytes(&self) -> u64 {
        let [width, height, layers] = self.size;
        let extent = framegraph::Extent::absolute(width, height);
        let desc =
            TextureDesc::new(extent, self.format).mips(self.mips.min(255) as u8).samples(self.samples.min(255) as u8);
        TextureDesc { dimension: self.dimension, ..desc }.layers(layers.min(65535) as u16).bytes([0, 0])
    }

    fn create(&self, gpu: &Gpu, label: &str) -> Result<Texture, Unsupported> {
        check_texture(gpu, self, label)?;
        let [width, height, depth_or_array_layers] = self.size;
        let linear = texture_format(self.format.without_srgb());
        let twins = [linear.add_srgb_suffix(), linear];
        Ok(gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: Extent3d { width, height, depth_or_array_layers },
            mip_level_count: self.mips,
            sample_count: self.samples,
            dimension: match self.dimension {
                Dimension::D2 => TextureDimension::D2,
                Dimension::D3 => TextureDimension::D3,
            },
            format: texture_format(self.format),
            usage: self.usage,
            view_formats: if self.srgb_views { &twins } else { &[] },
        }))
    }
}

/// Everything that a physical buffer is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferShape {
    /// Size in bytes, rounded up to a multiple of 4, which copies and clears need.
    pub bytes: u64,
    /// What it may be used for.
    pub usage: BufferUsages,
}

impl BufferShape {
    /// The shape of a buffer of `bytes` bytes. Copying is always allowed: it costs nothing.
    pub fn new(bytes: u64, usage: Usage) -> Self {
        let usage = buffer_usages(usage) | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        Self { bytes: bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT), usage }
    }
}

impl Shape for BufferShape {
    type Object = Buffer;

    fn serves(&self, request: &Self) -> bool {
        // Equal sizes, so that a shader's `arrayLength` is the same whichever buffer serves.
        self.bytes == request.bytes && self.usage.contains(request.usage)
    }

    fn waste(&self, request: &Self) -> u32 {
        (self.usage - request.usage).bits().count_ones()
    }

    fn bytes(&self) -> u64 {
        self.bytes
    }

    fn create(&self, gpu: &Gpu, label: &str) -> Result<Buffer, Unsupported> {
        check_buffer(gpu, self.bytes, label)?;
        let Self { bytes: size, usage } = *self;
        Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::Extent;

    fn shape(usage: Usage, format: Format, twins: bool) -> TextureShape {
        TextureShape::new(&TextureDesc::new(Extent::absolute(8, 4), format), [1, 1], usage, twins)
    }

    #[test]
    fn a_texture_serves_what_it_covers() {
        let both = Usage::ATTACHMENT.union(Usage::SAMPLED);
        let wide = shape(both, Format::Rgba8Unorm, false);
        let narrow = shape(Usage::ATTACHMENT, Format::Rgba8Unorm, false);
        assert!(wide.serves(&narrow) && !narrow.serves(&wide));
        assert_eq!((wide.waste(&narrow), wide.waste(&wide)), (1, 0));
        assert!(!wide.serves(&narrow.memoryless()) && !narrow.memoryless().serves(&narrow));
        let srgb = shape(both, Format::Rgba8UnormSrgb, false);
        let twins = shape(both, Format::Rgba8UnormSrgb, true);
        assert!(!wide.serves(&srgb) && twins.serves(&srgb) && twins.serves(&wide) && !srgb.serves(&twins));
        assert_eq!(twins.format, Format::Rgba8Unorm);
    }

    #[test]
    fn bytes_are_those_of_the_desc() {
        let desc = TextureDesc::new(Extent::fraction(2), Format::Rgba16Float).mips(3).layers(2);
        assert_eq!(TextureShape::new(&desc, [64, 32], Usage::SAMPLED, false).bytes(), desc.bytes([64, 32]));
        assert_eq!(BufferShape::new(5, Usage::UNIFORM).bytes(), 8);
    }
}
