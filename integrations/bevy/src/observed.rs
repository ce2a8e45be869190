//! A frame as a device recorded it: textures, buffers, and passes with their attachments and bindings.

use framegraph::{Aspect, ClearValue, Entry, Exit, Extent, Format, Range, TextureDesc};

/// A frame of a trace. Passes refer to rows of `textures` and `buffers` by index.
#[derive(Clone, Debug, Default)]
pub struct Observed {
    /// All textures that the trace created until the end of the next frame. [`uses`](Self::uses) selects the used ones.
    pub textures: Vec<ObservedTexture>,
    /// All buffers that the trace created until the end of the next frame. Passes refer only to buffers that the GPU
    /// writes in this or the next frame. Other buffers are constant inputs.
    pub buffers: Vec<ObservedBuffer>,
    /// Passes in the order of submission. Each dispatch and each copy is a pass, and consecutive uploads are one pass.
    pub passes: Vec<ObservedPass>,
    /// Index of the texture in which the camera's picture ends.
    pub output: Option<usize>,
    /// Sentences about work that the graph lacks.
    pub left_out: Vec<String>,
}

impl Observed {
    /// Returns whether a pass of the frame attaches, binds or copies a texture.
    pub fn uses(&self, texture: usize) -> bool {
        let bound = |own: &Use| matches!(own.of, Used::Texture(region) if region.texture == texture);
        self.passes
            .iter()
            .any(|pass| pass.uses.iter().any(bound) || pass.attachments.iter().any(|own| own.region.texture == texture))
    }

    /// Returns width and height of the output, or 1×1 if no output was marked.
    pub fn frame_size(&self) -> [u32; 2] {
        let output = self.output.and_then(|output| self.textures.get(output));
        output.map_or([1, 1], |output| output.desc.extent.texels([1, 1]))
    }
}

/// A texture of the device.
#[derive(Clone, Debug)]
pub struct ObservedTexture {
    /// The label, or `texture`.
    pub name: String,
    /// Shape and format, with an absolute extent.
    pub desc: TextureDesc,
    /// Contents at the start of the frame: `Defined` if a pass uses contents of an earlier frame.
    pub entry: Entry,
    /// `Keep` for the output, and for contents that the next frame uses or may use.
    pub exit: Exit,
}

/// A buffer of the device.
#[derive(Clone, Debug)]
pub struct ObservedBuffer {
    /// The label, or `buffer`.
    pub name: String,
    /// Size in bytes.
    pub bytes: u64,
}

/// Kind of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// A render pass.
    Raster,
    /// One dispatch of a compute pass.
    Compute,
    /// A copy by the GPU.
    Copy,
    /// A write by the CPU.
    Upload,
}

/// A render pass, dispatch, copy or upload.
#[derive(Clone, Debug)]
pub struct ObservedPass {
    /// The label.
    pub name: String,
    /// Render pass, dispatch, copy or upload.
    pub work: Work,
    /// Attachments of a render pass.
    pub attachments: Vec<ObservedAttachment>,
    /// Bindings, copies and uploads, without duplicates.
    pub uses: Vec<Use>,
    /// Number of recorded draws; an indirect draw counts once.
    pub draws: u32,
    /// The only draw is one triangle without blending, vertex buffers, depth test, viewport and scissor.
    pub full_screen: bool,
}

/// Part of a texture that a view covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Region {
    /// Index of the texture.
    pub texture: usize,
    /// First level.
    pub mip: u8,
    /// Number of levels.
    pub mips: u8,
    /// First layer.
    pub layer: u16,
    /// Number of layers.
    pub layers: u16,
    /// Planes.
    pub aspect: Aspect,
    /// Format of the view if it differs from the texture's.
    pub view: Option<Format>,
}

impl Region {
    /// Returns the region as a range of a graph's texture with `desc`.
    pub fn range(&self, desc: &TextureDesc) -> Range {
        let all_mips = self.mip == 0 && u32::from(self.mips) == desc.mip_count([1, 1]);
        let all_layers = self.layer == 0 && self.layers == desc.layers;
        Range {
            mip: self.mip,
            mips: if all_mips { Range::ALL.mips } else { self.mips },
            layer: self.layer,
            layers: if all_layers { Range::ALL.layers } else { self.layers },
            aspect: self.aspect,
            view: self.view,
            ..Range::ALL
        }
    }

    /// Returns every level and layer of the region.
    pub fn subresources(&self) -> impl Iterator<Item = (usize, u8, u16)> + use<> {
        let Self { texture, mip, mips, layer, layers, .. } = *self;
        (mip..mip + mips).flat_map(move |mip| (layer..layer + layers).map(move |layer| (texture, mip, layer)))
    }
}

/// Slot of an attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// Color attachment.
    Color(u8),
    /// Depth attachment.
    Depth,
    /// Target of the resolve of a color attachment.
    Resolve(u8),
}

/// Load operation that was recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// Reads the contents from memory.
    Load,
    /// Fills with a value.
    Clear(ClearValue),
    /// Leaves the contents undefined.
    DontCare,
}

/// An attachment of a render pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObservedAttachment {
    /// The attached level and layers.
    pub region: Region,
    /// Slot of the attachment.
    pub slot: Slot,
    /// Load operation of the color or depth plane.
    pub load: Load,
    /// The contents are stored at the end of the pass.
    pub stores: bool,
    /// A pipeline of the pass writes the attachment, or a clear does. `false` for depth that is only tested.
    pub written: bool,
}

impl ObservedAttachment {
    /// Returns the bytes of the attached texels with all samples.
    pub fn bytes(&self, textures: &[ObservedTexture]) -> u64 {
        let desc = &textures[self.region.texture].desc;
        desc.mip_bytes([1, 1], self.region.mip.into()) * u64::from(self.region.layers)
    }
}

/// Effect of a binding or copy on contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Reads.
    Read,
    /// Writes everything.
    Overwrite,
    /// Reads and writes, or writes a part.
    Modify,
}

/// Kind of a binding or copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binding {
    /// Sampled texture.
    Sampled,
    /// Storage texture or buffer.
    Storage,
    /// Uniform buffer.
    Uniform,
    /// Arguments of indirect draws or dispatches.
    Indirect,
    /// Source or target of a copy.
    Copy,
}

/// A binding or copy of a texture or buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Use {
    /// The texture or buffer.
    pub of: Used,
    /// Kind.
    pub binding: Binding,
    /// Read or write.
    pub effect: Effect,
}

/// A used resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Used {
    /// Part of a texture.
    Texture(Region),
    /// A whole buffer, by index.
    Buffer(usize),
}

/// Returns an absolute extent.
pub(crate) const fn extent(width: u32, height: u32) -> Extent {
    Extent::absolute(width, height)
}
