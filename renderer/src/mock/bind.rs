//! Bindings of a mock recorder: everything that its pass reads or stores to, as far as the device allows.

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::execute::part::{BoundBuffer, BoundResource, ViewPart};
use crate::pipelines::bind_groups::Binding;
use framegraph::{Access, AccessKind, Aspect, Desc, Dimension, Format, Numeric, TextureDesc};
use wgpu::{StorageTextureAccess, TextureFormatFeatureFlags};

/// Width and height of a workgroup in invocations.
pub(super) const WORKGROUP: u32 = 8;

/// Kind of a binding in the shader.
#[derive(Clone, Copy, Debug)]
pub(super) enum BindingKind {
    /// Texture read with `textureLoad`.
    Fetched(TextureBinding),
    /// Storage texture with read access.
    Loaded(TextureBinding),
    /// Storage texture with write access.
    Stored(TextureBinding),
    /// Uniform buffer of this many floats, at most four.
    Uniform(u64),
    /// Storage buffer with read access.
    Read,
    /// Storage buffer with write access.
    Written,
}

/// Shape of a texture in the shader.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextureBinding {
    pub(super) format: Format,
    pub(super) aspect: Aspect,
    pub(super) dimension: Dimension,
    pub(super) layers: u32,
    pub(super) levels: u32,
    pub(super) samples: u8,
}

/// Bindings of group 0.
#[derive(Debug, Default)]
pub(super) struct Bindings {
    /// Binding numbers and resources, for the bind group.
    pub(super) rows: Vec<(u32, Binding)>,
    /// Kind of each binding, in the order of `rows`.
    pub(super) what: Vec<BindingKind>,
    /// Vertex buffer that the pass reads, if any.
    pub(super) vertices: Option<BoundBuffer>,
    /// Index buffer that the pass reads, if any.
    pub(super) indices: Option<BoundBuffer>,
    /// Width and height of the largest texture that is stored to, in texels; one workgroup if there is none.
    pub(super) extent: [u32; 2],
}

/// Returns the largest number of mip levels written through one storage texture, at least 1.
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
    /// Binds every access of the pass that is not an attachment, as far as the device allows. Storage textures are
    /// written at mip `level`, counted from the first level of the access.
    ///
    /// # Errors
    /// Fails if a resource has no memory.
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

/// Returns the kind of a texture binding and the index of its limit. `None` if the device cannot bind the texture this
/// way.
fn textured(cx: &Cx<'_>, access: &Access, desc: &TextureDesc, format: Format) -> Option<(BindingKind, usize)> {
    let levels = access.range.mip_range(desc.mip_count(cx.plan().frame())).len() as u32;
    let layers = match desc.dimension {
        Dimension::D2 => access.range.layer_range(desc.layers.into()).len() as u32,
        Dimension::D3 => u32::from(desc.layers),
    };
    let aspect = access.range.aspect;
    let shape = TextureBinding { format, aspect, dimension: desc.dimension, layers, levels, samples: desc.samples };
    // WebGPU has no multisampled array textures.
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
    /// Returns the WGSL type of a texture for `textureLoad`, and the function that converts a texel to `vec4f`.
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

    /// Returns the WGSL type of a storage texture, and the type of its texels.
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
