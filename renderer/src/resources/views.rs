//! Cache of texture views by texture and part.

use crate::cache::{Cache, CacheCounts};
use crate::device::error::{DeviceError, ErrorScopes};
use crate::device::format::{sampled_aspect, texture_aspect, texture_format};
use crate::hash::KeyHashBuilder;
use framegraph::{Dimension, Format, Range};
use std::hash::BuildHasher;
use wgpu::{Device, Texture, TextureAspect, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension};

/// Description of a texture view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ViewDesc {
    /// Format of the texels.
    pub format: Format,
    /// Dimension in shaders.
    pub dimension: TextureViewDimension,
    /// Planes of a depth-stencil format; `All` for color.
    pub aspect: TextureAspect,
    /// First level and number of levels.
    pub mips: (u32, u32),
    /// First layer and number of layers.
    pub layers: (u32, u32),
    /// Usages of the view; empty inherits those of the texture.
    pub usage: TextureUsages,
}

impl ViewDesc {
    /// Creates the description of a view of `range`, for a texture with `mips` levels and `layers` layers.
    ///
    /// One layer becomes a 2D view, several layers a 2D array view. With `attached`, both planes of a depth-stencil
    /// format are included, otherwise depth only.
    pub fn new(format: Format, dimension: Dimension, range: Range, (mips, layers): (u32, u32), attached: bool) -> Self {
        let levels = range.mip_range(mips);
        let slices = range.layer_range(layers);
        let (dimension, layers) = match dimension {
            Dimension::D3 => (TextureViewDimension::D3, (0, 1)),
            Dimension::D2 if slices.len() == 1 => (TextureViewDimension::D2, (slices.start, 1)),
            Dimension::D2 => (TextureViewDimension::D2Array, (slices.start, slices.len() as u32)),
        };
        let aspect = if attached { texture_aspect(range.aspect) } else { sampled_aspect(format, range.aspect) };
        let usage = TextureUsages::empty();
        Self { format, dimension, aspect, mips: (levels.start, levels.len() as u32), layers, usage }
    }

    /// Returns the description with another dimension (for example a cube or an array of one layer).
    #[must_use]
    pub fn as_dimension(self, dimension: TextureViewDimension) -> Self {
        Self { dimension, ..self }
    }

    /// Returns the description with these usages.
    #[must_use]
    pub fn used_as(self, usage: TextureUsages) -> Self {
        Self { usage, ..self }
    }
}

/// Cache of texture views. See the [module documentation](self).
#[derive(Debug, Default)]
pub(crate) struct ViewCache(Cache<(Texture, ViewDesc), TextureView>);

impl ViewCache {
    /// Returns hits and creations since the cache was created.
    pub(crate) fn counts(&self) -> CacheCounts {
        self.0.counts()
    }

    /// Returns the view with this description. `name` is the name of the texture, for the view's label.
    ///
    /// # Errors
    /// Fails with wgpu's reason, for example if an import lacks the view format.
    pub(crate) fn get(
        &self,
        device: &Device,
        texture: &Texture,
        desc: ViewDesc,
        name: &str,
    ) -> Result<TextureView, DeviceError> {
        let hash = KeyHashBuilder::default().hash_one((texture, desc));
        let is = |(of, known): &(Texture, ViewDesc)| of == texture && *known == desc;
        self.0.get(hash, is, || {
            let scopes = ErrorScopes::open(device);
            let view = create(texture, desc, name);
            scopes.close("a view")?;
            Ok(((texture.clone(), desc), view))
        })
    }

    /// Begins a frame. Drops views that were not requested for `max_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        self.0.begin_frame(max_age);
    }

    /// Drops all views of a texture that is being freed, so that they do not keep it alive.
    pub(crate) fn forget(&mut self, texture: &Texture) {
        self.0.retain(|(of, _)| of != texture);
    }

    /// Drops all views.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }
}

fn create(texture: &Texture, desc: ViewDesc, name: &str) -> TextureView {
    let ViewDesc { format, dimension, aspect, mips, layers, usage } = desc;
    let last = |(first, count): (u32, u32)| first + count - 1;
    let label = format!("{name}, levels {} to {}, layers {} to {}", mips.0, last(mips), layers.0, last(layers));
    texture.create_view(&TextureViewDescriptor {
        label: Some(&label),
        format: (aspect == TextureAspect::All).then(|| texture_format(format)),
        dimension: Some(dimension),
        usage: (!usage.is_empty()).then_some(usage),
        aspect,
        base_mip_level: mips.0,
        mip_level_count: Some(mips.1),
        base_array_layer: layers.0,
        array_layer_count: Some(layers.1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;

    #[test]
    fn ranges_become_views() {
        let whole = ViewDesc::new(Format::R8Unorm, Dimension::D2, Range::ALL, (3, 6), false);
        assert_eq!((whole.dimension, whole.mips, whole.layers), (TextureViewDimension::D2Array, (0, 3), (0, 6)));
        let part = Range { mip: 1, mips: 1, layer: 4, layers: 1, ..Range::ALL };
        let one = ViewDesc::new(Format::Depth32FloatStencil8, Dimension::D2, part, (3, 6), false);
        assert_eq!((one.dimension, one.mips, one.layers), (TextureViewDimension::D2, (1, 1), (4, 1)));
        assert_eq!(one.aspect, TextureAspect::DepthOnly);
        let attached = ViewDesc::new(Format::Depth32FloatStencil8, Dimension::D2, part, (3, 6), true);
        assert_eq!(attached.aspect, TextureAspect::All);
    }

    #[test]
    fn a_view_is_created_once_until_its_texture_is_freed() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R8Unorm,
            usage: TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let desc = ViewDesc::new(Format::R8Unorm, Dimension::D2, Range::ALL, (1, 1), false);
        let mut cache = ViewCache::default();
        let first = cache.get(&gpu.device, &texture, desc, "image")?;
        assert_eq!(cache.get(&gpu.device, &texture, desc, "image")?, first);
        assert_ne!(cache.get(&gpu.device, &texture, desc.as_dimension(TextureViewDimension::D2Array), "image")?, first);
        cache.forget(&texture);
        assert_ne!(cache.get(&gpu.device, &texture, desc, "image")?, first);
        assert_eq!(cache.counts(), CacheCounts { hits: 1, created: 3 });
        Ok(())
    }
}
