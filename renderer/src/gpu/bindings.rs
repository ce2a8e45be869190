//! Bind groups, made once for each layout and set of resources and kept while somebody asks for them.

use super::hash::Keyed;
use super::views::CacheCounts;
use std::collections::HashMap;
use std::hash::BuildHasher;
use std::num::NonZeroU64;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, Buffer, BufferBinding, Device,
    Sampler, TextureView,
};

/// What is bound at one `@binding` of a group.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Binding {
    /// A sampled, fetched or storage texture.
    View(TextureView),
    /// A sampler.
    Sampler(Sampler),
    /// A uniform or storage buffer, or a part of it.
    Buffer {
        /// The buffer.
        buffer: Buffer,
        /// First byte; a multiple of the device's offset alignment.
        offset: u64,
        /// Bytes; `None` for all that follow.
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

/// Bind groups in use. See the [module](self).
#[derive(Debug, Default)]
pub struct BindGroupCache {
    // By hash, so that looking up allocates nothing; equal hashes are told apart by comparing.
    groups: HashMap<u64, Vec<Entry>, Keyed>,
    hasher: Keyed,
    frame: u64,
    counts: CacheCounts,
}

#[derive(Debug)]
struct Entry {
    layout: BindGroupLayout,
    bindings: Box<[(u32, Binding)]>,
    group: BindGroup,
    used: u64,
}

impl BindGroupCache {
    /// Hits and creations since the cache was made.
    pub fn counts(&self) -> CacheCounts {
        self.counts
    }

    /// The group of that layout with `bindings`, each beside its `@binding` number. Cloning a group is cheap.
    pub fn get(&mut self, device: &Device, layout: &BindGroupLayout, bindings: &[(u32, Binding)]) -> BindGroup {
        let Self { groups, hasher, frame, counts } = self;
        let bucket = groups.entry(hasher.hash_one((layout, bindings))).or_default();
        if let Some(known) = bucket.iter_mut().find(|e| e.layout == *layout && *e.bindings == *bindings) {
            known.used = *frame;
            counts.hits += 1;
            return known.group.clone();
        }
        counts.created += 1;
        let entries: Vec<_> =
            bindings.iter().map(|(binding, b)| BindGroupEntry { binding: *binding, resource: b.resource() }).collect();
        let group = device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries });
        bucket.push(Entry { layout: layout.clone(), bindings: bindings.into(), group: group.clone(), used: *frame });
        group
    }

    /// Begins a frame and drops groups that nobody asked for during `max_age` frames.
    pub fn begin_frame(&mut self, max_age: u64) {
        self.frame += 1;
        let frame = self.frame;
        if frame.is_multiple_of(max_age.max(1)) {
            self.retain(|e| frame - e.used <= max_age);
        }
    }

    /// Drops the groups that hold a view of a texture that is given up.
    pub fn forget(&mut self, texture: &wgpu::Texture) {
        self.retain(|e| !e.bindings.iter().any(|(_, b)| matches!(b, Binding::View(view) if view.texture() == texture)));
    }

    /// Drops everything.
    pub fn clear(&mut self) {
        self.groups.clear();
    }

    fn retain(&mut self, stays: impl Fn(&Entry) -> bool) {
        self.groups.retain(|_, bucket| {
            bucket.retain(&stays);
            !bucket.is_empty()
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::device::{Gpu, OpenError};
    use wgpu::{BindGroupLayoutEntry, BindingType, BufferBindingType, BufferUsages, ShaderStages};

    #[test]
    fn a_group_is_made_once_for_the_same_resources() -> Result<(), OpenError> {
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
        let first = cache.get(&gpu.device, &layout, &[(3, a.clone().into())]);
        assert_eq!(cache.get(&gpu.device, &layout, &[(3, a.clone().into())]), first);
        assert_ne!(cache.get(&gpu.device, &layout, &[(3, b.into())]), first);
        let part = Binding::Buffer { buffer: a, offset: 256, bytes: NonZeroU64::new(16) };
        assert_ne!(cache.get(&gpu.device, &layout, &[(3, part)]), first);
        assert_eq!(cache.counts(), CacheCounts { hits: 1, created: 3 });
        for _ in 0..4 {
            cache.begin_frame(2);
        }
        assert!(cache.groups.is_empty(), "age drops groups");
        Ok(())
    }
}
