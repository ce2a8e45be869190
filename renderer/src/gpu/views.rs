//! Texture views, made once for each texture and part and kept while the texture is in use.

use super::format::{sampled_aspect, texture_aspect, texture_format};
use super::hash::Keyed;
use framegraph::{Dimension, Format, Range};
use std::collections::HashMap;
use wgpu::{Texture, TextureAspect, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension};

/// Which part of a texture is seen, and as what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ViewShape {
    /// The format of the texels.
    pub format: Format,
    /// What a shader binds it as.
    pub dimension: TextureViewDimension,
    /// Which planes.
    pub aspect: TextureAspect,
    /// First level and number of levels.
    pub mips: (u32, u32),
    /// First layer and number of layers.
    pub layers: (u32, u32),
    /// What the view may be used for.
    pub usage: TextureUsages,
}

impl ViewShape {
    /// The view of `range` of a texture that has `mips` levels and `layers` layers.
    ///
    /// One layer is seen as two-dimensional, several as an array; with `attached`, both planes of a depth-stencil format,
    /// otherwise depth.
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

    /// The same, seen by shaders as another dimension (a cube, an array of one layer).
    #[must_use]
    pub fn seen_as(self, dimension: TextureViewDimension) -> Self {
        Self { dimension, ..self }
    }

    /// The same, for these uses.
    #[must_use]
    pub fn used_as(self, usage: TextureUsages) -> Self {
        Self { usage, ..self }
    }
}

/// How the cache did, since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CacheCounts {
    /// Requests that found what they asked for.
    pub hits: u64,
    /// Objects made.
    pub created: u64,
}

/// Views of all textures in use. See the [module](self).
#[derive(Debug, Default)]
pub struct ViewCache {
    views: HashMap<(Texture, ViewShape), (TextureView, u64), Keyed>,
    frame: u64,
    counts: CacheCounts,
}

impl ViewCache {
    /// Hits and creations since the cache was made.
    pub fn counts(&self) -> CacheCounts {
        self.counts
    }

    /// The view of that shape. Cloning a view is cheap.
    pub fn get(&mut self, texture: &Texture, shape: ViewShape) -> TextureView {
        let frame = self.frame;
        let counts = &mut self.counts;
        let entry = self.views.entry((texture.clone(), shape));
        let (view, used) = match entry {
            std::collections::hash_map::Entry::Occupied(found) => {
                counts.hits += 1;
                found.into_mut()
            }
            std::collections::hash_map::Entry::Vacant(free) => {
                counts.created += 1;
                free.insert((create(texture, shape), frame))
            }
        };
        *used = frame;
        view.clone()
    }

    /// Begins a frame and drops views that nobody asked for during `max_age` frames.
    pub fn begin_frame(&mut self, max_age: u64) {
        self.frame += 1;
        let frame = self.frame;
        // Looking through all of them costs more than keeping a few for longer.
        if frame.is_multiple_of(max_age.max(1)) {
            self.views.retain(|_, (_, used)| frame - *used <= max_age);
        }
    }

    /// Drops the views of a texture that is given up, so that they do not keep it alive.
    pub fn forget(&mut self, texture: &Texture) {
        self.views.retain(|(of, _), _| of != texture);
    }

    /// Drops everything.
    pub fn clear(&mut self) {
        self.views.clear();
    }
}

fn create(texture: &Texture, shape: ViewShape) -> TextureView {
    let ViewShape { format, dimension, aspect, mips, layers, usage } = shape;
    texture.create_view(&TextureViewDescriptor {
        label: None,
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
    use crate::gpu::device::{Gpu, OpenError};
    use framegraph::Aspect;

    #[test]
    fn ranges_become_views() {
        let whole = ViewShape::new(Format::R8Unorm, Dimension::D2, Range::ALL, (3, 6), false);
        assert_eq!((whole.dimension, whole.mips, whole.layers), (TextureViewDimension::D2Array, (0, 3), (0, 6)));
        let part = Range { mip: 1, mips: 1, layer: 4, layers: 1, aspect: Aspect::All };
        let one = ViewShape::new(Format::Depth32FloatStencil8, Dimension::D2, part, (3, 6), false);
        assert_eq!((one.dimension, one.mips, one.layers), (TextureViewDimension::D2, (1, 1), (4, 1)));
        assert_eq!(one.aspect, TextureAspect::DepthOnly);
        let attached = ViewShape::new(Format::Depth32FloatStencil8, Dimension::D2, part, (3, 6), true);
        assert_eq!(attached.aspect, TextureAspect::All);
    }

    #[test]
    fn a_view_is_made_once_and_dropped_with_age() -> Result<(), OpenError> {
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
        let shape = ViewShape::new(Format::R8Unorm, Dimension::D2, Range::ALL, (1, 1), false);
        let mut cache = ViewCache::default();
        let first = cache.get(&texture, shape);
        assert_eq!(cache.get(&texture, shape), first);
        assert_eq!(cache.counts(), CacheCounts { hits: 1, created: 1 });
        for _ in 0..4 {
            cache.begin_frame(2);
        }
        assert_ne!(cache.get(&texture, shape), first);
        cache.forget(&texture);
        cache.get(&texture, shape);
        assert_eq!(cache.counts(), CacheCounts { hits: 1, created: 3 });
        Ok(())
    }
}
