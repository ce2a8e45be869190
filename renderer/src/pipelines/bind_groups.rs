//! Cache of bind groups by layout and resources.

use crate::cache::{Cache, CacheCounts, LastEntry};
use crate::device::error::{DeviceError, ErrorScopes};
use crate::hash::KeyHashBuilder;
use std::hash::BuildHasher;
use std::num::NonZeroU64;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, Buffer, BufferBinding, Device,
    Sampler, TextureView,
};

/// A resource to bind at one `@binding` of a group.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Binding {
    /// A sampled or storage texture.
    View(TextureView),
    /// A filtering or comparison sampler.
    Sampler(Sampler),
    /// A uniform or storage buffer, or a range of it.
    Buffer {
        /// Buffer to bind.
        buffer: Buffer,
        /// Offset in bytes, a multiple of the device's offset alignment.
        offset: u64,
        /// Size in bytes; `None` binds up to the end of the buffer.
        bytes: Option<NonZeroU64>,
    },
}

impl From<TextureView> for Binding {
    fn from(view: TextureView) -> Self {
        Self::View(view)
    }
}

impl From<Sampler> for Binding {
    fn from(sampler: Sampler) -> Self {
        Self::Sampler(sampler)
    }
}

impl From<Buffer> for Binding {
    fn from(buffer: Buffer) -> Self {
        Self::Buffer { buffer, offset: 0, bytes: None }
    }
}

impl Binding {
    fn resource(&self) -> BindingResource<'_> {
        match self {
            Self::View(view) => BindingResource::TextureView(view),
            Self::Sampler(sampler) => BindingResource::Sampler(sampler),
            Self::Buffer { buffer, offset, bytes } => {
                BindingResource::Buffer(BufferBinding { buffer, offset: *offset, size: *bytes })
            }
        }
    }
}

/// Description of a bind group: layout and bindings.
type Bound = (BindGroupLayout, Box<[(u32, Binding)]>);

/// Last bind group of a request.
pub(crate) type LastGroup = LastEntry<Bound, BindGroup>;

/// Cache of bind groups. See the [module documentation](self).
#[derive(Debug, Default)]
pub(crate) struct BindGroupCache(Cache<Bound, BindGroup>);

impl BindGroupCache {
    /// Returns hits and creations since the cache was created.
    pub(crate) fn counts(&self) -> CacheCounts {
        self.0.counts()
    }

    /// Returns the bind group of `layout` with `bindings`, which are pairs of `@binding` number and resource. `last` is
    /// the last result of this request. `label` is called if the group is created.
    ///
    /// # Errors
    /// Fails with wgpu's reason; nothing is cached in that case.
    pub(crate) fn get(
        &self,
        last: &mut LastGroup,
        device: &Device,
        layout: &BindGroupLayout,
        bindings: &[(u32, Binding)],
        label: impl FnOnce() -> String,
    ) -> Result<BindGroup, DeviceError> {
        self.0.get_repeated(
            last,
            || KeyHashBuilder::default().hash_one((layout, bindings)),
            |(of, bound)| of == layout && **bound == *bindings,
            || {
                let group = create(device, layout, bindings, &label())?;
                Ok(((layout.clone(), bindings.into()), group))
            },
        )
    }

    /// Makes the groups of the last frame visible to [`BindGroupCache::check`].
    pub(crate) fn settle(&mut self) {
        self.0.merge_fresh();
    }

    /// Checks that the resources of all groups with the layout `old` can be bound with the layout `new`.
    ///
    /// # Errors
    /// Returns the bindings and wgpu's reason.
    pub(crate) fn check(
        &self,
        device: &Device,
        old: &BindGroupLayout,
        new: &BindGroupLayout,
    ) -> Result<(), (Box<[(u32, Binding)]>, DeviceError)> {
        let mut bound = self.0.keys().filter(|(layout, _)| layout == old);
        bound.try_for_each(|(_, bindings)| {
            create(device, new, bindings, "reload").map(drop).map_err(|error| (bindings.clone(), error))
        })
    }

    /// Begins a frame. Drops groups that were not requested for `max_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        self.0.begin_frame(max_age);
    }

    /// Drops all groups with a view of a texture that is being freed.
    pub(crate) fn forget(&mut self, texture: &wgpu::Texture) {
        self.0.retain(|(_, bound)| {
            !bound.iter().any(|(_, b)| matches!(b, Binding::View(view) if view.texture() == texture))
        });
    }

    /// Drops all groups with a buffer that is being freed.
    pub(crate) fn forget_buffer(&mut self, buffer: &Buffer) {
        self.0.retain(|(_, bound)| {
            !bound.iter().any(|(_, b)| matches!(b, Binding::Buffer { buffer: held, .. } if held == buffer))
        });
    }

    /// Drops all groups.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }
}

fn create(
    device: &Device,
    layout: &BindGroupLayout,
    bindings: &[(u32, Binding)],
    label: &str,
) -> Result<BindGroup, DeviceError> {
    let entries: Vec<_> =
        bindings.iter().map(|(binding, b)| BindGroupEntry { binding: *binding, resource: b.resource() }).collect();
    let scopes = ErrorScopes::open(device);
    let group = device.create_bind_group(&BindGroupDescriptor { label: Some(label), layout, entries: &entries });
    scopes.close("a bind group")?;
    Ok(group)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;
    use wgpu::{BindGroupLayoutEntry, BindingType, BufferBindingType, BufferUsages, ShaderStages};

    #[test]
    fn a_bind_group_is_created_once_per_set_of_resources() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let ty =
            BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
        let entry = BindGroupLayoutEntry { binding: 3, visibility: ShaderStages::FRAGMENT, ty, count: None };
        let layout =
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[entry] });
        let size =
            wgpu::BufferDescriptor { label: None, size: 1024, usage: BufferUsages::UNIFORM, mapped_at_creation: false };
        let (a, b) = (gpu.device.create_buffer(&size), gpu.device.create_buffer(&size));
        let mut cache = BindGroupCache::default();
        let get = |cache: &BindGroupCache, binding: Binding| {
            cache.get(&mut LastGroup::default(), &gpu.device, &layout, &[(3, binding)], || "group".to_owned())
        };
        let first = get(&cache, a.clone().into())?;
        assert_eq!(get(&cache, a.clone().into())?, first);
        assert_ne!(get(&cache, b.into())?, first);
        let part = |offset| Binding::Buffer { buffer: a.clone(), offset, bytes: NonZeroU64::new(16) };
        assert_ne!(get(&cache, part(256))?, first);
        for _ in 0..2 {
            let refused = get(&cache, part(255)).map(|_| ());
            assert!(matches!(refused, Err(DeviceError::Refused { .. })), "{refused:?}");
        }
        assert_eq!(cache.counts(), CacheCounts { hits: 1, created: 3 });
        cache.forget_buffer(&a);
        assert_ne!(get(&cache, a.clone().into())?, first);
        Ok(())
    }
}
