//! What a stand-in binds: everything that its pass reads or stores to, as far as the device allows.

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::execute::part::{BoundBuffer, BoundResource, ViewPart};
use crate::pipelines::bind_groups::Binding;
use framegraph::{Access, AccessKind, Aspect, Desc, Dimension, Format, Numeric, TextureDesc};
use wgpu::{StorageTextureAccess, TextureFormatFeatureFlags};

/// Width and height of a workgroup in invocations.
pub(super) const WORKGROUP: u32 = 8;

/// What stands behind one binding.
#[derive(Clone, Copy, Debug)]
pub(super) enum BindingKind {
    /// A texture that is fetched from.
    Fetched(TextureBinding),
    /// A storage texture that is read.
    Loaded(TextureBinding),
    /// A storage texture that is written.
    Stored(TextureBinding),
    /// A uniform buffer of this many floats, at most four.
    Uniform(u64),
    /// A storage buffer that is read.
    Read,
    /// A storage buffer that is written.
    Written,
}

/// How a shader sees a texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextureBinding {
    pub(super) format: Format,
    pub(super) aspect: Aspect,
    pub(super) dimension: Dimension,
    pub(super) layers: u32,
    pub(super) samples: u8,
}

/// The bindings of group 0.
#[derive(Debug, Default)]
pub(super) struct Bindings {
    /// Each beside its number, as bind groups take them.
    pub(super) rows: Vec<(u32, Binding)>,
    /// What each is, in the same order.
    pub(super) what: Vec<BindingKind>,
    /// A vertex buffer and an index buffer to set, where the pass reads some.
    pub(super) vertices: Option<BoundBuffer>,
    pub(super) indices: Option<BoundBuffer>,
    /// Width and height of the largest texture that is stored to; one workgroup's where there is none.
    pub(super) extent: [u32; 2],
}

/// Levels of the storage texture with the most of them, at least 1.
pub(super) fn levels_written(cx: &Cx<'_>) -> u32 {
    let (plan, graph) = (cx.plan(), cx.plan().graph());
    let levels = cx.accesses().filter_map(|id| {
        let access = &graph.accesses()[id.index()];
        let desc = graph.resources()[access.resource.index()].desc.texture()?;
        let stored = access.kind == AccessKind::StorageWrite;
        stored.then(|| access.range.mip_range(desc.mip_count(plan.frame())).len() as u32)
    });
    levels.max().unwrap_or(1).max(1)
}

impl Bindings {
    /// Looks up every access of the pass that is no attachment, and binds what can be bound; storage textures that are
    /// written in their level number `level`, of those that the access names.
    ///
    /// # Errors
    /// When something has no memory.
    pub(super) fn of(cx: &mut Cx<'_>, level: u32) -> Result<Self, RecordError> {
        let (plan, graph) = (cx.plan(), cx.plan().graph());
        let mut bindings = Self { extent: [WORKGROUP; 2], ..Self::default() };
        let limits = cx.gpu().device.limits();
        let mut left = [
            limits.max_sampled_textures_per_shader_stage,
            limits.max_storage_textures_per_shader_stage,
            limits.max_storage_buffers_per_shader_stage,
            limits.max_uniform_buffers_per_shader_stage,
        ];
        for id in cx.accesses() {
            let access = &graph.accesses()[id.index()];
            if access.kind.is_attachment() {
                continue;
            }
            let desc = graph.resources()[access.resource.index()].desc;
            let Desc::Texture(texture) = desc else {
                let BoundResource::Buffer(buffer) = cx.resource(id)? else { continue };
                bindings.buffer(access, buffer, &mut left);
                continue;
            };
            let levels = access.range.mip_range(texture.mip_count(plan.frame()));
            let written = access.kind == AccessKind::StorageWrite;
            if written && level as usize >= levels.len() {
                continue;
            }
            let mip = match access.kind {
                AccessKind::StorageWrite => Some((levels.start + level) as u8),
                AccessKind::StorageRead => Some(levels.start as u8),
                _ => None,
            };
            let BoundResource::Texture { view, .. } = cx.resource_part(id, ViewPart { mip, ..ViewPart::WHOLE })? else {
                continue;
            };
            let format = plan.format(access.resource).unwrap_or(texture.format);
            if let Some((what, class)) = textured(cx, access, &texture, format)
                && left[class] > 0
            {
                left[class] -= 1;
                if written {
                    let [width, height] = texture.mip_extent(plan.frame(), mip.unwrap_or(0).into());
                    let [w, h] = bindings.extent;
                    bindings.extent = [w.max(width), h.max(height)];
                }
                bindings.push(what, view.into());
            }
        }
        Ok(bindings)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    fn push(&mut self, what: BindingKind, binding: Binding) {
        self.rows.push((self.rows.len() as u32, binding));
        self.what.push(what);
    }

    fn buffer(&mut self, access: &Access, buffer: BoundBuffer, left: &mut [u32; 4]) {
        let floats = buffer.bytes / 4;
        let (what, class) = match access.kind {
            AccessKind::Vertex => return self.vertices = Some(buffer),
            AccessKind::Index => return self.indices = Some(buffer),
            AccessKind::StorageRead => (BindingKind::Read, 2),
            AccessKind::StorageWrite => (BindingKind::Written, 2),
            AccessKind::Uniform => (BindingKind::Uniform(floats.min(4)), 3),
            _ => return,
        };
        if left[class] > 0 && floats > 0 {
            left[class] -= 1;
            self.push(what, buffer.into());
        }
    }
}

/// How a texture is bound, and which limit it counts against; none where the device cannot bind it so.
fn textured(cx: &Cx<'_>, access: &Access, desc: &TextureDesc, format: Format) -> Option<(BindingKind, usize)> {
    let layers = match desc.dimension {
        Dimension::D2 => access.range.layer_range(desc.layers.into()).len() as u32,
        Dimension::D3 => u32::from(desc.layers),
    };
    let aspect = access.range.aspect;
    let shape = TextureBinding { format, aspect, dimension: desc.dimension, layers, samples: desc.samples };
    // A multisampled array can be bound nowhere.
    if desc.samples > 1 && layers > 1 {
        return None;
    }
    let flags = cx.gpu().format_features(format).flags;
    match access.kind {
        AccessKind::Sampled | AccessKind::SamePixel => Some((BindingKind::Fetched(shape), 0)),
        AccessKind::StorageRead => {
            flags.contains(TextureFormatFeatureFlags::STORAGE_READ_ONLY).then_some((BindingKind::Loaded(shape), 1))
        }
        AccessKind::StorageWrite => {
            flags.contains(TextureFormatFeatureFlags::STORAGE_WRITE_ONLY).then_some((BindingKind::Stored(shape), 1))
        }
        _ => None,
    }
}

impl TextureBinding {
    /// The WGSL type of a texture that is fetched from, and the function that makes four floats of a fetched texel.
    pub(super) fn fetched(&self) -> (String, &'static str) {
        let (scalar, depth, floats) = match self.format.numeric() {
            Numeric::Depth if self.aspect == Aspect::Stencil || !self.format.has_depth() => ("u32", false, "from_uint"),
            Numeric::Depth => ("f32", true, "from_depth"),
            Numeric::Float => ("f32", false, "vec4f"),
            Numeric::Uint => ("u32", false, "from_uint"),
            Numeric::Sint => ("i32", false, "from_sint"),
        };
        let array = if self.layers > 1 { "_array" } else { "" };
        let of = if depth { String::new() } else { format!("<{scalar}>") };
        let name = match (self.dimension, self.samples, depth) {
            (Dimension::D3, ..) => "texture_3d".to_owned(),
            (_, 1, false) => format!("texture_2d{array}"),
            (_, 1, true) => format!("texture_depth_2d{array}"),
            (_, _, false) => "texture_multisampled_2d".to_owned(),
            (_, _, true) => "texture_depth_multisampled_2d".to_owned(),
        };
        (name + &of, floats)
    }

    /// The WGSL type of a storage texture, and the type of its texels.
    pub(super) fn stored(&self, access: StorageTextureAccess) -> (String, &'static str) {
        let dimension = match (self.dimension, self.layers) {
            (Dimension::D3, _) => "3d",
            (_, 1) => "2d",
            _ => "2d_array",
        };
        let word = if access == StorageTextureAccess::ReadOnly { "read" } else { "write" };
        let format = format!("{:?}", self.format).to_lowercase();
        let texel = match self.format.numeric() {
            Numeric::Uint => "vec4u",
            Numeric::Sint => "vec4i",
            Numeric::Float | Numeric::Depth => "vec4f",
        };
        (format!("texture_storage_{dimension}<{format}, {word}>"), texel)
    }
}
