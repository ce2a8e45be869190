//! Pool implementation for textures and buffers: which object serves a request, and how it is created.

use crate::device::format::{both_forms, texture_format};
use crate::device::gpu::Gpu;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::Pooled;
use crate::resources::support::{Unsupported, check_buffer, check_texture};
use framegraph::{Dimension, TextureDesc};
use wgpu::{Buffer, Extent3d, Texture, TextureDimension};

impl Pooled for PhysicalTextureDesc {
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
        let formats = both_forms(texture_format(self.format));
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
            view_formats: if self.srgb_views { &formats } else { &[] },
        }))
    }
}

impl Pooled for PhysicalBufferDesc {
    type Object = Buffer;

    fn serves(&self, request: &Self) -> bool {
        // Sizes must be equal, so that `arrayLength` in shaders does not depend on the buffer.
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
    use framegraph::{Extent, Format, Usage};

    fn shape(usage: Usage, format: Format, views: bool) -> PhysicalTextureDesc {
        PhysicalTextureDesc::new(&TextureDesc::new(Extent::absolute(8, 4), format), [1, 1], usage, views)
    }

    #[test]
    fn a_texture_serves_requests_that_it_covers() {
        let both = Usage::ATTACHMENT.union(Usage::SAMPLED);
        let wide = shape(both, Format::Rgba8Unorm, false);
        let narrow = shape(Usage::ATTACHMENT, Format::Rgba8Unorm, false);
        assert!(wide.serves(&narrow) && !narrow.serves(&wide));
        assert_eq!((wide.waste(&narrow), wide.waste(&wide)), (1, 0));
        assert!(!wide.serves(&narrow.memoryless()) && !narrow.memoryless().serves(&narrow));
        let srgb = shape(both, Format::Rgba8UnormSrgb, false);
        let views = shape(both, Format::Rgba8UnormSrgb, true);
        assert!(!wide.serves(&srgb) && views.serves(&srgb) && views.serves(&wide) && !srgb.serves(&views));
        assert_eq!(views.format, Format::Rgba8Unorm);
    }

    #[test]
    fn bytes_are_those_of_the_desc() {
        let desc = TextureDesc::new(Extent::fraction(2), Format::Rgba16Float).mips(3).layers(2);
        assert_eq!(PhysicalTextureDesc::new(&desc, [64, 32], Usage::SAMPLED, false).bytes(), desc.bytes([64, 32]));
        assert_eq!(PhysicalBufferDesc::new(5, Usage::UNIFORM).bytes(), 8);
    }
}
