//! Imports: textures and buffers of the application, bound to a graph for one frame.

use crate::named::Named;
use framegraph::{Buffer, Desc, Dimension, Format, Graph, Plan, ResourceId, Texture};
use wgpu::TextureDimension;

use crate::device::format::{buffer_usages, joined, texture_format, texture_usages};

/// Textures and buffers to bind to the imports of a graph in one frame.
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

/// Cache duration of the views of an imported texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lifetime {
    /// Until the texture is no longer imported.
    Kept,
    /// For one frame, as needed for surface textures.
    Frame,
}

#[derive(Clone, Debug)]
enum Key<H> {
    Handle(H),
    Name(String),
    Row(ResourceId),
}

/// Error: an import is missing or does not match its declaration.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum ImportError {
    /// No texture or buffer is bound to an import that passes use.
    #[error("no {} is bound to the import `{resource}`; bind one with `Imports::{}`", kind(*.is_buffer), kind(*.is_buffer))]
    Missing {
        /// Imported resource.
        resource: Named<ResourceId>,
        /// True if the resource is a buffer.
        is_buffer: bool,
    },
    /// The bound texture or buffer does not match the declaration.
    #[error("the import `{resource}` was declared with {mismatch}")]
    Differs {
        /// Imported resource.
        resource: Named<ResourceId>,
        /// Property that differs.
        mismatch: ImportMismatch,
    },
    /// One texture or buffer is bound to two imports, and a pass writes one of them.
    #[error(
        "the imports `{resource}` and `{other}` are bound to one {}; declare `Graph::may_alias{}`, or import it once",
        kind(*.is_buffer), if *.is_buffer { "_buffer" } else { "" }
    )]
    Shared {
        /// Imported resource.
        resource: Named<ResourceId>,
        /// Other import with the same texture or buffer.
        other: Named<ResourceId>,
        /// The imports are buffers.
        is_buffer: bool,
    },
}

impl std::fmt::Debug for ImportError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Mismatch between the declaration of an import (or the usages of its passes) and the bound texture or buffer.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs, reason = "the fields are the declared or needed value, and the actual value")]
pub enum ImportMismatch {
    /// Width and height in texels.
    #[error("{}×{} texels, but the bound texture has {}×{}; declare its actual size, or compile for the new frame size", .declared[0], .declared[1], .actual[0], .actual[1])]
    Size { declared: [u32; 2], actual: [u32; 2] },
    /// Format of a texture.
    #[error("format {declared:?}, but the bound texture has format {actual:?}; declare its actual format")]
    Format { declared: Format, actual: wgpu::TextureFormat },
    /// Layers of an array texture, or depth of a 3D texture.
    #[error("{} layers ({}), but the bound texture has {} ({}); declare its actual layers", .declared.0, dimensions(.declared.1), .actual.0, dimensions(.actual.1))]
    Layers { declared: (u32, TextureDimension), actual: (u32, TextureDimension) },
    /// Number of mip levels.
    #[error("{declared} mip levels, but the bound texture has {actual}; declare its actual levels")]
    Levels { declared: u32, actual: u32 },
    /// Samples per texel.
    #[error("{declared} samples, but the bound texture has {actual}; declare its actual samples")]
    Samples { declared: u32, actual: u32 },
    /// Usages of a texture.
    #[error("usages {}, but the bound texture has {}; create it with these usages", joined(.needed.iter_names()), joined(.actual.iter_names()))]
    TextureUsages { needed: wgpu::TextureUsages, actual: wgpu::TextureUsages },
    /// Size of a buffer in bytes.
    #[error("{declared} bytes, but the bound buffer has {actual}; declare its actual size")]
    Bytes { declared: u64, actual: u64 },
    /// Usages of a buffer.
    #[error("usages {}, but the bound buffer has {}; create it with these usages", joined(.needed.iter_names()), joined(.actual.iter_names()))]
    BufferUsages { needed: wgpu::BufferUsages, actual: wgpu::BufferUsages },
}

impl std::fmt::Debug for ImportMismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Imports {
    /// Creates an empty set of imports.
    pub fn new() -> Self {
        Self::default()
    }

    /// Binds `texture` to the import of any version of `handle`. Views of it are cached between frames.
    pub fn texture(&mut self, handle: Texture, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Handle(handle), texture.clone(), Lifetime::Kept));
        self
    }

    /// Binds `texture` to the import with this full name, like [`Imports::texture`].
    pub fn texture_named(&mut self, name: &str, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Name(name.to_owned()), texture.clone(), Lifetime::Kept));
        self
    }

    /// Binds the texture of a surface. All references to it are released once the frame is submitted.
    pub fn surface(&mut self, handle: Texture, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Handle(handle), texture.clone(), Lifetime::Frame));
        self
    }

    /// Binds `buffer` to the import of any version of `handle`.
    pub fn buffer(&mut self, handle: Buffer, buffer: &wgpu::Buffer) -> &mut Self {
        self.buffers.push((Key::Handle(handle), buffer.clone()));
        self
    }

    /// Binds `buffer` to the import with this full name, like [`Imports::buffer`].
    pub fn buffer_named(&mut self, name: &str, buffer: &wgpu::Buffer) -> &mut Self {
        self.buffers.push((Key::Name(name.to_owned()), buffer.clone()));
        self
    }

    /// Binds `texture` to a resource for one frame only.
    pub(crate) fn lend_at(&mut self, resource: ResourceId, texture: wgpu::Texture) {
        self.textures.push((Key::Row(resource), texture, Lifetime::Frame));
    }

    /// Binds `texture` to a resource, like [`Imports::texture`]. For graphs from files, whose resources have no
    /// handles.
    pub fn texture_at(&mut self, resource: ResourceId, texture: &wgpu::Texture) -> &mut Self {
        self.textures.push((Key::Row(resource), texture.clone(), Lifetime::Kept));
        self
    }

    /// Binds `buffer` to a resource, like [`Imports::buffer`].
    pub fn buffer_at(&mut self, resource: ResourceId, buffer: &wgpu::Buffer) -> &mut Self {
        self.buffers.push((Key::Row(resource), buffer.clone()));
        self
    }

    /// Removes all bindings but keeps the memory.
    pub fn clear(&mut self) {
        self.textures.clear();
        self.buffers.clear();
    }

    /// Returns the texture bound to a resource, checked against its declaration.
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

    /// Returns the texture bound to a resource of `graph`, without checks.
    pub(crate) fn texture_of(&self, graph: &Graph, resource: ResourceId) -> Option<(&wgpu::Texture, Lifetime)> {
        let found = self.textures.iter().rev().find(|(key, ..)| key.names(graph, resource, |g, h| g.resource_of(h)));
        found.map(|(_, texture, lifetime)| (texture, *lifetime))
    }

    /// Returns the buffer bound to a resource of `graph`, without checks.
    pub(crate) fn buffer_of(&self, graph: &Graph, resource: ResourceId) -> Option<&wgpu::Buffer> {
        let found =
            self.buffers.iter().rev().find(|(key, _)| key.names(graph, resource, |g, h| g.resource_of_buffer(h)));
        found.map(|(_, buffer)| buffer)
    }

    /// Returns the buffer bound to a resource, checked against its declaration.
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

const fn kind(is_buffer: bool) -> &'static str {
    if is_buffer { "buffer" } else { "texture" }
}

const fn dimensions(dimension: TextureDimension) -> &'static str {
    match dimension {
        TextureDimension::D1 => "1D",
        TextureDimension::D2 => "2D",
        TextureDimension::D3 => "3D",
    }
}

/// Returns the first mismatch between `texture` and its declaration.
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
