//! Textures and buffers that the application owns, bound to the graph's imports for one frame.

use crate::named::Named;
use framegraph::{Buffer, Desc, Dimension, Format, Graph, Plan, ResourceId, Texture};
use wgpu::TextureDimension;

use crate::device::format::{buffer_usages, texture_format, texture_usages};

/// What each import stands for in this frame.
///
/// ```
/// # use framegraph_wgpu::Imports;
/// # fn bind(back: framegraph::Texture, image: &wgpu::Texture, counters: &wgpu::Buffer) -> Imports {
/// let mut imports = Imports::new();
/// imports.texture(back, image).buffer_named("counters", counters);
/// # imports
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Imports {
    textures: Vec<(Key<Texture>, wgpu::Texture, Lifetime)>,
    buffers: Vec<(Key<Buffer>, wgpu::Buffer)>,
}

/// How long views of an imported texture are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lifetime {
    /// As long as it keeps being imported.
    Kept,
    /// For this frame.
    Frame,
}

#[derive(Clone, Debug)]
enum Key<H> {
    Handle(H),
    Name(String),
    Row(ResourceId),
}

/// What is wrong with an import.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ImportError {
    /// Nothing was bound to an import that passes use.
    #[error("nothing is bound to the import `{resource}`; bind it with `Imports::{}`", if *.is_buffer { "buffer" } else { "texture" })]
    Missing {
        /// The imported resource.
        resource: Named<ResourceId>,
        /// Whether it is a buffer, not a texture.
        is_buffer: bool,
    },
    /// What was bound is not what was declared.
    #[error("the import `{resource}` was declared with {mismatch}")]
    Differs {
        /// The imported resource.
        resource: Named<ResourceId>,
        /// The property that differs.
        mismatch: ImportMismatch,
    },
}

impl std::fmt::Debug for ImportError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// A property of an import as it was declared (or as the passes need it), and as it is.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs, reason = "the fields of each are what was declared or needed, and what there is")]
pub enum ImportMismatch {
    /// Width and height in texels.
    #[error("{}×{} texels, but what is bound to it has {}×{} texels; declare its true size, or compile for the frame's new size", .declared[0], .declared[1], .actual[0], .actual[1])]
    Size { declared: [u32; 2], actual: [u32; 2] },
    /// The texture's format.
    #[error("format {declared:?}, but what is bound to it has format {actual:?}; declare its true format")]
    Format { declared: Format, actual: wgpu::TextureFormat },
    /// Layers of an array, or the depth of a three-dimensional texture.
    #[error("{} layers, {:?}, but what is bound to it has {} layers, {:?}; declare its true layers", .declared.0, .declared.1, .actual.0, .actual.1)]
    Layers { declared: (u32, TextureDimension), actual: (u32, TextureDimension) },
    /// Mip levels.
    #[error("{declared} levels, but what is bound to it has {actual} levels; declare its true levels")]
    Levels { declared: u32, actual: u32 },
    /// Samples per texel.
    #[error("{declared} samples, but what is bound to it has {actual} samples; declare its true samples")]
    Samples { declared: u32, actual: u32 },
    /// Uses of a texture.
    #[error("{needed:?}, but what is bound to it has {actual:?}; create it with these uses")]
    TextureUsages { needed: wgpu::TextureUsages, actual: wgpu::TextureUsages },
    /// Size of a buffer in bytes.
    #[error("{declared} bytes, but what is bound to it has {actual} bytes; declare its true size")]
    Bytes { declared: u64, actual: u64 },
    /// Uses of a buffer.
    #[error("{needed:?}, but what is bound to it has {actual:?}; create it with these uses")]
    BufferUsages { needed: wgpu::BufferUsages, actual: wgpu::BufferUsages },
}

impl std::fmt::Debug for ImportMismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Imports {
    /// A set without imports.
    pub fn new() -> Self {
        Self::default()
    }

    /// Binds `texture` to the import that any version of `handle` names. Views of it are kept from frame to frame.
    pub fn texture(&mut self, handle: Texture, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Handle(handle), texture.clone(), Lifetime::Kept));
        self
    }

    /// As [`Imports::texture`], by the full name of the resource.
    pub fn texture_named(&mut self, name: &str, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Name(name.to_owned()), texture.clone(), Lifetime::Kept));
        self
    }

    /// Binds the image of a surface: nothing of it is kept when the frame has been submitted.
    pub fn surface(&mut self, handle: Texture, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Handle(handle), texture.clone(), Lifetime::Frame));
        self
    }

    /// Binds `buffer` to the import that any version of `handle` names.
    pub fn buffer(&mut self, handle: Buffer, buffer: &wgpu::Buffer) -> &mut Self {
        self.buffers.push((Key::Handle(handle), buffer.clone()));
        self
    }

    /// As [`Imports::buffer`], by the full name of the resource.
    pub fn buffer_named(&mut self, name: &str, buffer: &wgpu::Buffer) -> &mut Self {
        self.buffers.push((Key::Name(name.to_owned()), buffer.clone()));
        self
    }

    /// Binds `texture` to a resource, and keeps nothing of it when the frame has been submitted.
    pub(crate) fn lend_at(&mut self, resource: ResourceId, texture: wgpu::Texture) {
        self.textures.push((Key::Row(resource), texture, Lifetime::Frame));
    }

    /// As [`Imports::texture`], by the row of the graph: for graphs from files, whose resources have no handles.
    pub fn texture_at(&mut self, resource: ResourceId, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Row(resource), texture.clone(), Lifetime::Kept));
        self
    }

    /// As [`Imports::buffer`], by the row of the graph.
    pub fn buffer_at(&mut self, resource: ResourceId, buffer: &wgpu::Buffer) -> &mut Self {
        self.buffers.push((Key::Row(resource), buffer.clone()));
        self
    }

    /// Forgets everything bound and keeps the memory.
    pub fn clear(&mut self) {
        self.textures.clear();
        self.buffers.clear();
    }

    /// The texture bound to a resource, checked against its declaration.
    pub(crate) fn find_texture(
        &self,
        plan: &Plan,
        resource: ResourceId,
    ) -> Result<(&wgpu::Texture, Lifetime), ImportError> {
        let Some((texture, lifetime)) = self.texture_of(plan.graph(), resource) else {
            return Err(ImportError::Missing { resource: Named::resource(plan, resource), is_buffer: false });
        };
        match texture_mismatch(plan, resource, texture) {
            Some(mismatch) => Err(ImportError::Differs { resource: Named::resource(plan, resource), mismatch }),
            None => Ok((texture, lifetime)),
        }
    }

    /// The texture bound to a resource of `graph`, unchecked.
    pub(crate) fn texture_of(&self, graph: &Graph, resource: ResourceId) -> Option<(&wgpu::Texture, Lifetime)> {
        let found = self.textures.iter().rev().find(|(key, ..)| key.names(graph, resource, |g, h| g.resource_of(h)));
        found.map(|(_, texture, lifetime)| (texture, *lifetime))
    }

    /// The buffer bound to a resource of `graph`, unchecked.
    pub(crate) fn buffer_of(&self, graph: &Graph, resource: ResourceId) -> Option<&wgpu::Buffer> {
        let found =
            self.buffers.iter().rev().find(|(key, _)| key.names(graph, resource, |g, h| g.resource_of_buffer(h)));
        found.map(|(_, buffer)| buffer)
    }

    /// The buffer bound to a resource, checked against its declaration.
    pub(crate) fn find_buffer(&self, plan: &Plan, resource: ResourceId) -> Result<&wgpu::Buffer, ImportError> {
        let graph = plan.graph();
        let Some(buffer) = self.buffer_of(graph, resource) else {
            return Err(ImportError::Missing { resource: Named::resource(plan, resource), is_buffer: true });
        };
        let differs = |mismatch| Err(ImportError::Differs { resource: Named::resource(plan, resource), mismatch });
        let (declared, actual) = (graph.resources()[resource.index()].desc.bytes(plan.frame()), buffer.size());
        if actual < declared {
            return differs(ImportMismatch::Bytes { declared, actual });
        }
        let (needed, actual) = (buffer_usages(plan.resources()[resource.index()].usage), buffer.usage());
        if !actual.contains(needed) {
            return differs(ImportMismatch::BufferUsages { needed, actual });
        }
        Ok(buffer)
    }
}

impl<H: Copy> Key<H> {
    fn names(&self, graph: &Graph, resource: ResourceId, of: impl Fn(&Graph, H) -> Option<ResourceId>) -> bool {
        match self {
            Self::Handle(handle) => of(graph, *handle) == Some(resource),
            Self::Name(name) => graph.resource_name(resource) == name,
            Self::Row(row) => *row == resource,
        }
    }
}

/// The first property in which `texture` is not what was declared, if there is one.
fn texture_mismatch(plan: &Plan, resource: ResourceId, texture: &wgpu::Texture) -> Option<ImportMismatch> {
    let Desc::Texture(desc) = &plan.graph().resources()[resource.index()].desc else {
        return None;
    };
    let dimension = match desc.dimension {
        Dimension::D2 => TextureDimension::D2,
        Dimension::D3 => TextureDimension::D3,
    };
    let (size, declared) = (texture.size(), desc.extent.texels(plan.frame()));
    let mips = desc.mip_count(plan.frame());
    let needed = texture_usages(plan.resources()[resource.index()].usage);
    let layers = ((u32::from(desc.layers), dimension), (size.depth_or_array_layers, texture.dimension()));
    if declared != [size.width, size.height] {
        Some(ImportMismatch::Size { declared, actual: [size.width, size.height] })
    } else if texture_format(desc.format) != texture.format() {
        Some(ImportMismatch::Format { declared: desc.format, actual: texture.format() })
    } else if layers.0 != layers.1 {
        Some(ImportMismatch::Layers { declared: layers.0, actual: layers.1 })
    } else if mips != texture.mip_level_count() {
        Some(ImportMismatch::Levels { declared: mips, actual: texture.mip_level_count() })
    } else if u32::from(desc.samples) != texture.sample_count() {
        Some(ImportMismatch::Samples { declared: desc.samples.into(), actual: texture.sample_count() })
    } else if !texture.usage().contains(needed) {
        Some(ImportMismatch::TextureUsages { needed, actual: texture.usage() })
    } else {
        None
    }
}
