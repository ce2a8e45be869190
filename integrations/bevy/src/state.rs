//! Objects of a traced device: what each id in a call refers to.

use crate::observed::{Binding, Effect, ObservedBuffer, ObservedTexture, Region, Use, Used, extent};
use crate::trace::{Action, OUTPUT_MARK};
use framegraph::{Aspect, Dimension, Entry, Exit, TextureDesc};
use framegraph_wgpu::format_of;
use std::collections::HashMap;
use wgpu_core::binding_model::BindingResource;
use wgpu_core::id::{Marker, PointerId};
use wgpu_core::resource::TextureViewDescriptor;

/// Returns the number of an id. Numbers are addresses, which later objects may reuse.
pub(crate) fn key<T: Marker>(id: &PointerId<T>) -> usize {
    let PointerId::PointerId(number, _) = id;
    number.get()
}

/// Properties of a render pipeline that decide what a pass writes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pipeline {
    /// Blends, or writes only some channels.
    pub(crate) partial: bool,
    /// Writes depth or stencil.
    pub(crate) writes_depth: bool,
    /// Tests depth or stencil.
    pub(crate) tests_depth: bool,
}

/// All objects that the calls so far created.
#[derive(Debug, Default)]
pub(crate) struct State {
    pub(crate) textures: Vec<ObservedTexture>,
    pub(crate) buffers: Vec<ObservedBuffer>,
    /// Parallel to `textures`: destroyed or dropped.
    pub(crate) dropped: Vec<bool>,
    /// Textures marked as output of a camera.
    pub(crate) outputs: Vec<usize>,
    pub(crate) pipelines: HashMap<usize, Pipeline>,
    pub(crate) groups: HashMap<usize, Vec<Use>>,
    texture_ids: HashMap<usize, usize>,
    views: HashMap<usize, Region>,
    buffer_ids: HashMap<usize, usize>,
    layouts: HashMap<usize, HashMap<u32, wgpu::BindingType>>,
}

impl State {
    /// Updates the objects by a call that creates or drops one.
    pub(crate) fn apply(&mut self, action: &Action) {
        match action {
            Action::CreateTexture(id, desc) => self.create_texture(key(id), desc),
            Action::DropTexture(id) | Action::DestroyTexture(id) => {
                if let Some(texture) = self.texture_ids.get(&key(id)) {
                    self.dropped[*texture] = true;
                }
            }
            Action::CreateTextureView { id, parent, desc } => self.create_view(key(id), key(parent), desc),
            Action::CreateBuffer(id, desc) => {
                self.buffer_ids.insert(key(id), self.buffers.len());
                self.buffers.push(ObservedBuffer { name: name(&desc.label, "buffer"), bytes: desc.size });
            }
            Action::CreateBindGroupLayout(id, desc) => {
                let entries = desc.entries.iter().map(|entry| (entry.binding, entry.ty)).collect();
                self.layouts.insert(key(id), entries);
            }
            Action::CreateBindGroup(id, desc) => {
                let layout = self.layouts.get(&key(&desc.layout));
                let mut uses = Vec::new();
                for entry in desc.entries.iter() {
                    let ty = layout.and_then(|layout| layout.get(&entry.binding)).copied();
                    self.bound(&entry.resource, ty, &mut uses);
                }
                self.groups.insert(key(id), uses);
            }
            Action::CreateGeneralRenderPipeline { id, desc } => {
                let targets = desc.fragment.as_ref().map_or(&[][..], |fragment| &fragment.targets);
                let partial = |t: &wgpu::ColorTargetState| t.blend.is_some() || t.write_mask != wgpu::ColorWrites::ALL;
                let depth = desc.depth_stencil.as_ref();
                let stencil = depth.is_some_and(|d| !d.stencil.is_read_only(desc.primitive.cull_mode));
                let pipeline = Pipeline {
                    partial: targets.iter().flatten().any(partial),
                    writes_depth: stencil || depth.is_some_and(|d| d.depth_write_enabled != Some(false)),
                    tests_depth: depth.is_some(),
                };
                self.pipelines.insert(key(id), pipeline);
            }
            _ => {}
        }
    }

    /// Returns the region of a view; `None` if its texture is left out.
    pub(crate) fn view(&self, id: usize) -> Option<Region> {
        self.views.get(&id).copied()
    }

    /// Returns the index of a buffer.
    pub(crate) fn buffer(&self, id: usize) -> Option<usize> {
        self.buffer_ids.get(&id).copied()
    }

    /// Returns one level of a texture and the layers of a copy, and `true` if the copy covers them.
    pub(crate) fn copied(
        &self,
        id: usize,
        mip: u32,
        origin: wgpu::Origin3d,
        size: wgpu::Extent3d,
    ) -> Option<(Region, bool)> {
        let texture = *self.texture_ids.get(&id)?;
        let desc = &self.textures[texture].desc;
        let [width, height] = desc.mip_extent([1, 1], mip);
        let flat = desc.dimension == Dimension::D2;
        let (layer, layers) = if flat { (origin.z, size.depth_or_array_layers) } else { (0, desc.layers.into()) };
        let whole = origin.x == 0 && origin.y == 0 && size.width >= width && size.height >= height;
        let whole = whole && (flat || size.depth_or_array_layers >= desc.slices(mip));
        let region = Region {
            texture,
            mip: mip as u8,
            mips: 1,
            layer: layer as u16,
            layers: layers as u16,
            aspect: Aspect::All,
            view: None,
        };
        Some((region, whole))
    }

    fn create_texture(&mut self, id: usize, desc: &wgpu_core::resource::TextureDescriptor<'_>) {
        self.texture_ids.remove(&id);
        let Some(format) = format_of(desc.format) else { return };
        let dimension = match desc.dimension {
            wgpu::TextureDimension::D3 => Dimension::D3,
            wgpu::TextureDimension::D2 => Dimension::D2,
            wgpu::TextureDimension::D1 => return,
        };
        self.texture_ids.insert(id, self.textures.len());
        self.dropped.push(false);
        self.textures.push(ObservedTexture {
            name: name(&desc.label, "texture"),
            desc: TextureDesc {
                extent: extent(desc.size.width, desc.size.height),
                format,
                mips: desc.mip_level_count as u8,
                samples: desc.sample_count as u8,
                layers: desc.size.depth_or_array_layers as u16,
                dimension,
            },
            entry: Entry::Undefined,
            exit: Exit::Discard,
        });
    }

    fn create_view(&mut self, id: usize, parent: usize, desc: &TextureViewDescriptor<'_>) {
        self.views.remove(&id);
        let Some(&texture) = self.texture_ids.get(&parent) else { return };
        if desc.label.as_deref() == Some(OUTPUT_MARK) {
            self.outputs.push(texture);
        }
        let own = &self.textures[texture].desc;
        let range = &desc.range;
        let mip = range.base_mip_level as u8;
        let layer = if own.dimension == Dimension::D3 { 0 } else { range.base_array_layer as u16 };
        let rest = own.layers - layer;
        let layers = range.array_layer_count.map_or(rest, |count| count as u16);
        let flat = matches!(desc.dimension, Some(wgpu::TextureViewDimension::D2));
        let layers = if own.dimension == Dimension::D3 {
            rest
        } else if flat {
            1
        } else {
            layers
        };
        let region = Region {
            texture,
            mip,
            mips: range.mip_level_count.map_or(own.mip_count([1, 1]) as u8 - mip, |count| count as u8),
            layer,
            layers,
            aspect: match range.aspect {
                wgpu::TextureAspect::DepthOnly => Aspect::Depth,
                wgpu::TextureAspect::StencilOnly => Aspect::Stencil,
                _ => Aspect::All,
            },
            view: desc
                .format
                .and_then(format_of)
                .filter(|format| *format != own.format && format.is_srgb() != own.format.is_srgb()),
        };
        self.views.insert(id, region);
    }

    /// Adds the resources of one binding. Resources of an unknown layout count as read.
    fn bound(&self, resource: &TraceBinding, ty: Option<wgpu::BindingType>, uses: &mut Vec<Use>) {
        let (binding, effect) = match ty {
            Some(wgpu::BindingType::StorageTexture { access, .. }) => {
                let effect = match access {
                    wgpu::StorageTextureAccess::ReadOnly => Effect::Read,
                    wgpu::StorageTextureAccess::WriteOnly => Effect::Overwrite,
                    _ => Effect::Modify,
                };
                (Binding::Storage, effect)
            }
            Some(wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Storage { read_only }, .. }) => {
                (Binding::Storage, if read_only { Effect::Read } else { Effect::Modify })
            }
            Some(wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, .. }) => {
                (Binding::Uniform, Effect::Read)
            }
            _ => (Binding::Sampled, Effect::Read),
        };
        let mut add = |of: Option<Used>| uses.extend(of.map(|of| Use { of, binding, effect }));
        let view = |id| self.view(key(id)).map(Used::Texture);
        let buffer = |id| self.buffer(key(id)).map(Used::Buffer);
        match resource {
            BindingResource::TextureView(id) => add(view(id)),
            BindingResource::TextureViewArray(ids) => ids.iter().for_each(|id| add(view(id))),
            BindingResource::Buffer(part) => add(buffer(&part.buffer)),
            BindingResource::BufferArray(parts) => parts.iter().for_each(|part| add(buffer(&part.buffer))),
            _ => {}
        }
    }
}

type TraceBinding = BindingResource<
    'static,
    PointerId<wgpu_core::id::markers::Buffer>,
    PointerId<wgpu_core::id::markers::Sampler>,
    PointerId<wgpu_core::id::markers::TextureView>,
    PointerId<wgpu_core::id::markers::Tlas>,
    PointerId<wgpu_core::id::markers::ExternalTexture>,
>;

/// Returns a label without the characters that graph files reserve.
pub(crate) fn name(label: &Option<std::borrow::Cow<'_, str>>, other: &str) -> String {
    let label = label.as_deref().filter(|label| !label.trim().is_empty()).unwrap_or(other);
    label.replace(['@', '"', '\\', '`'], " ").trim().to_owned()
}
