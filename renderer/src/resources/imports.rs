//! Textures and buffers that somebody else owns, bound to the graph's imports for one frame.

use framegraph::{Buffer, Desc, Dimension, Graph, Plan, ResourceId, Texture};

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
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImportError {
    /// Nothing was bound to an import that passes use.
    #[error("nothing is bound to the import `{name}`; bind it with `Imports::{call}`")]
    Missing {
        /// The resource.
        name: String,
        /// `texture` or `buffer`.
        call: &'static str,
    },
    /// What was bound is not what was declared.
    #[error("the import `{name}` was declared with {declared}, but what is bound to it has {actual}; {hint}")]
    Differs {
        /// The resource.
        name: String,
        /// The property as declared, or as the passes need it.
        declared: String,
        /// The property as it is.
        actual: String,
        /// What to do.
        hint: &'static str,
    },
}

impl Imports {
    /// No imports.
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
    pub(crate) fn lend_row(&mut self, resource: ResourceId, texture: wgpu::Texture) {
        self.textures.push((Key::Row(resource), texture, Lifetime::Frame));
    }

    /// Binds `texture` to a resource. Views of it are kept from frame to frame.
    pub(crate) fn texture_row(&mut self, resource: ResourceId, texture: wgpu::Texture) {
        self.textures.push((Key::Row(resource), texture, Lifetime::Kept));
    }

    /// Binds `buffer` to a resource.
    pub(crate) fn buffer_row(&mut self, resource: ResourceId, buffer: wgpu::Buffer) {
        self.buffers.push((Key::Row(resource), buffer));
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
        let graph = plan.graph();
        let Some((texture, lifetime)) = self.texture_of(graph, resource) else {
            return Err(ImportError::Missing { name: graph.resource_name(resource).to_owned(), call: "texture" });
        };
        check_texture(plan, resource, texture)?;
        Ok((texture, lifetime))
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
        let name = || graph.resource_name(resource).to_owned();
        let Some(buffer) = self.buffer_of(graph, resource) else {
            return Err(ImportError::Missing { name: name(), call: "buffer" });
        };
        let bytes = graph.resources()[resource.index()].desc.bytes(plan.frame());
        if buffer.size() < bytes {
            let (declared, actual) = (format!("{bytes} bytes"), format!("{} bytes", buffer.size()));
            return Err(ImportError::Differs { name: name(), declared, actual, hint: "declare its true size" });
        }
        let needed = buffer_usages(plan.resources()[resource.index()].usage);
        if !buffer.usage().contains(needed) {
            let (declared, actual) = (format!("{needed:?}"), format!("{:?}", buffer.usage()));
            return Err(ImportError::Differs { name: name(), declared, actual, hint: "create it with these uses" });
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

fn check_texture(plan: &Plan, resource: ResourceId, texture: &wgpu::Texture) -> Result<(), ImportError> {
    let graph = plan.graph();
    let Desc::Texture(desc) = &graph.resources()[resource.index()].desc else {
        return Ok(());
    };
    let [width, height] = desc.extent.resolve(plan.frame());
    let size = texture.size();
    let dimension = match desc.dimension {
        Dimension::D2 => wgpu::TextureDimension::D2,
        Dimension::D3 => wgpu::TextureDimension::D3,
    };
    let needed = texture_usages(plan.resources()[resource.index()].usage);
    let (declared, actual, hint) = if (width, height) != (size.width, size.height) {
        let shown = |w, h| format!("{w}×{h} texels");
        (
            shown(width, height),
            shown(size.width, size.height),
            "declare its true size, or compile for the frame's new size",
        )
    } else if texture_format(desc.format) != texture.format() {
        (format!("format {:?}", desc.format), format!("format {:?}", texture.format()), "declare its true format")
    } else if u32::from(desc.layers) != size.depth_or_array_layers || dimension != texture.dimension() {
        let declared = format!("{} layers, {dimension:?}", desc.layers);
        (
            declared,
            format!("{} layers, {:?}", size.depth_or_array_layers, texture.dimension()),
            "declare its true layers",
        )
    } else if desc.mip_count(plan.frame()) != texture.mip_level_count() {
        let shown = |n| format!("{n} levels");
        (shown(desc.mip_count(plan.frame())), shown(texture.mip_level_count()), "declare its true levels")
    } else if u32::from(desc.samples) != texture.sample_count() {
        let shown = |n| format!("{n} samples");
        (shown(u32::from(desc.samples)), shown(texture.sample_count()), "declare its true samples")
    } else if !texture.usage().contains(needed) {
        (format!("{needed:?}"), format!("{:?}", texture.usage()), "create it with these uses")
    } else {
        return Ok(());
    };
    Err(ImportError::Differs { name: graph.resource_name(resource).to_owned(), declared, actual, hint })
}
