//! The state of a graph under construction: resources, defined contents, and the attachments of the last pass.

use super::Entropy;
use super::profile::{FRAME, Profile};
use framegraph::access::Range;
use framegraph::barrier::{Stages, State};
use framegraph::format::{Aspect, Format};
use framegraph::graph::Graph;
use framegraph::handle::{Buffer, Previous, Texture};
use framegraph::resource::{Dimension, Entry, Exit, Extent, TextureDesc};

/// A texture of the graph.
pub(super) struct Tex {
    pub(super) handle: Texture,
    pub(super) desc: TextureDesc,
    /// The texture may be written.
    pub(super) writable: bool,
    /// A pass reads it.
    pub(super) read: bool,
    /// Indexed by `(mip · layers + layer) · 2 + plane`; slices count as layers.
    defined: Vec<bool>,
}

/// A buffer of the graph.
pub(super) struct Buf {
    pub(super) handle: Buffer,
    /// Number of pieces of [`PIECE_BYTES`], at most 64.
    pieces: u8,
    /// Bit mask of pieces with defined contents.
    defined: u64,
}

/// A graph under construction.
pub(super) struct World<'w, 'e> {
    pub(super) entropy: &'w mut Entropy<'e>,
    pub(super) profile: Profile,
    pub(super) graph: Graph,
    pub(super) textures: Vec<Tex>,
    pub(super) buffers: Vec<Buf>,
    pub(super) previous: Vec<(Previous, TextureDesc)>,
    /// Attachments of the last raster pass: texture and range.
    pub(super) last: Vec<(usize, Range)>,
    /// Descriptors that most textures of this graph use.
    palette: Vec<TextureDesc>,
    names: u32,
}

/// Size of buffer pieces that accesses use: the binding alignment of wgpu.
pub(super) const PIECE_BYTES: u64 = 256;

impl Buf {
    fn new(handle: Buffer, bytes: u64, defined: bool) -> Self {
        let pieces = (bytes / PIECE_BYTES).min(64) as u8;
        Self { handle, pieces, defined: if defined { u64::MAX } else { 0 } }
    }

    fn mask(&self, pieces: Option<(u8, u8)>) -> u64 {
        let (first, end) = pieces.unwrap_or((0, self.pieces));
        (first..end).fold(0, |mask, piece| mask | 1 << piece)
    }

    pub(super) fn is_defined(&self, pieces: Option<(u8, u8)>) -> bool {
        self.mask(pieces) & !self.defined == 0
    }

    pub(super) fn define(&mut self, pieces: Option<(u8, u8)>) {
        self.defined |= self.mask(pieces);
    }
}

impl Tex {
    fn slots(&self, range: Range) -> impl Iterator<Item = usize> + use<> {
        let (desc, format, layers) = (self.desc, self.desc.format, self.desc.slices(0));
        let mips = range.mip_range(self.desc.mip_count(FRAME));
        mips.flat_map(move |mip| {
            range.layer_range(desc.slices(mip)).flat_map(move |layer| {
                let planes = (0..format.planes()).filter(move |p| range.aspect.selects_plane(format, *p));
                planes.map(move |plane| ((mip * layers + layer) * 2 + plane) as usize)
            })
        })
    }

    /// Returns `true` if every part of the range is defined.
    pub(super) fn is_defined(&self, range: Range) -> bool {
        let holds = |slot: usize| self.defined.get(slot).copied().unwrap_or(false);
        self.slots(range).all(holds)
    }

    /// Marks every part of the range as defined.
    pub(super) fn define(&mut self, range: Range) {
        for slot in self.slots(range) {
            // Sloppy ranges may exceed the texture.
            if let Some(part) = self.defined.get_mut(slot) {
                *part = true;
            }
        }
    }
}

impl<'w, 'e> World<'w, 'e> {
    pub(super) fn new(entropy: &'w mut Entropy<'e>, profile: Profile) -> Self {
        Self {
            entropy,
            profile,
            graph: Graph::new(),
            textures: Vec::new(),
            buffers: Vec::new(),
            previous: Vec::new(),
            last: Vec::new(),
            palette: Vec::new(),
            names: 0,
        }
    }

    /// Returns a new name with a prefix.
    pub(super) fn name(&mut self, prefix: &str) -> String {
        self.names += 1;
        format!("{prefix}{}", self.names)
    }

    /// Returns `true` now and then if rules may be violated, otherwise `false`.
    pub(super) fn slips(&mut self) -> bool {
        self.profile.sloppy && self.entropy.one_in(12)
    }

    /// Declares imports and histories.
    pub(super) fn import_and_declare(&mut self) {
        for _ in 0..1 + self.entropy.below(3) {
            let desc = self.any_desc();
            self.palette.push(desc);
        }
        for _ in 0..self.entropy.below(4) {
            let entry = self.entry();
            let exit = self.entropy.pick(&[Exit::Keep, Exit::Keep, Exit::Discard]);
            let defined = entry.is_defined();
            if self.entropy.one_in(5) && !self.profile.plain {
                let name = self.name("import_buffer");
                let handle = self.graph.import_buffer(&name, 1 << 10, entry, exit);
                self.buffers.push(Buf::new(handle, 1 << 10, defined));
            } else {
                let desc = self.desc();
                let name = self.name("import");
                let handle = self.graph.import_texture(&name, desc, entry, exit);
                self.add(handle, desc, defined);
            }
        }
        for _ in 0..self.entropy.below(3) {
            if self.profile.plain || self.entropy.one_in(2) {
                continue;
            }
            let (desc, name) = (self.desc(), self.name("history"));
            let frames = 1 + self.entropy.below(2) as u8;
            let handle = self.graph.history(&name, desc, frames);
            self.add(handle, desc, false);
            let age = 1 + self.entropy.below(u32::from(frames)) as u8;
            if let Ok(previous) = self.graph.previous(handle, age) {
                self.previous.push((previous, desc));
            }
        }
    }

    fn entry(&mut self) -> Entry {
        if !self.entropy.one_in(4) {
            return self.entropy.pick(&[Entry::Undefined, Entry::Defined]);
        }
        let state = self.entropy.pick(&[State::Undefined, State::Sampled, State::ColorAttachment, State::CopySource]);
        Entry::Left { state, stages: self.entropy.pick(&[Stages::NONE, Stages::SHADER, Stages::COLOR, Stages::COPY]) }
    }

    fn add(&mut self, handle: Texture, desc: TextureDesc, defined: bool) -> usize {
        let count = desc.mip_count(FRAME) * desc.slices(0) * 2;
        self.textures.push(Tex { handle, desc, writable: true, read: false, defined: vec![defined; count as usize] });
        self.textures.len() - 1
    }

    /// Creates a transient texture.
    pub(super) fn texture(&mut self, desc: TextureDesc) -> usize {
        let name = self.name("t");
        let handle = self.graph.texture(&name, desc);
        self.add(handle, desc, false)
    }

    /// Creates a transient buffer.
    pub(super) fn buffer(&mut self) -> usize {
        let name = self.name("b");
        let bytes = self.entropy.pick(&[256, 1 << 10, 1 << 14]);
        let handle = self.graph.buffer(&name, bytes);
        self.buffers.push(Buf::new(handle, bytes, false));
        self.buffers.len() - 1
    }

    /// Returns a range of pieces, or `None` for the whole buffer.
    pub(super) fn pieces(&mut self, buffer: usize) -> Option<(u8, u8)> {
        if self.profile.plain_accesses || self.entropy.one_in(2) {
            return None;
        }
        // Near the start, so that ranges overlap.
        let most = self.buffers[buffer].pieces.min(5);
        let first = self.entropy.below(most.into()) as u8;
        let end = first + 1 + self.entropy.below(u32::from(most - first)) as u8;
        Some((first, end))
    }

    /// Returns a random descriptor, usually from the palette.
    pub(super) fn desc(&mut self) -> TextureDesc {
        if self.palette.is_empty() || self.entropy.one_in(4) {
            self.any_desc()
        } else {
            let palette = std::mem::take(&mut self.palette);
            let desc = self.entropy.pick(&palette);
            self.palette = palette;
            desc
        }
    }

    fn any_desc(&mut self) -> TextureDesc {
        let format = self.format();
        let [width, height] = FRAME;
        let extent = self.entropy.pick(&[
            Extent::FRAME,
            Extent::FRAME,
            Extent::absolute(width, height),
            Extent::fraction(2),
            Extent::absolute(width / 2, height / 2),
        ]);
        let mut desc = TextureDesc::new(extent, format);
        if self.profile.plain {
            return desc;
        }
        match self.entropy.below(11) {
            6 => desc = desc.samples(4),
            7 => desc = desc.mips(2 + self.entropy.below(2) as u8),
            8 => desc = desc.layers(2 + self.entropy.below(2) as u16),
            9 => desc = desc.mips(TextureDesc::ALL_MIPS).layers(2),
            10 if format.is_color_renderable() && self.profile.volumes => {
                desc = desc.mips(1 + self.entropy.below(3) as u8).layers(4);
                desc.dimension = Dimension::D3;
            }
            _ => {}
        }
        if self.slips() {
            desc = match self.entropy.below(5) {
                0 => desc.samples(3),
                1 => desc.mips(40),
                2 => desc.layers(0),
                3 => desc.extent(Extent::absolute(0, 9000)),
                _ => TextureDesc { dimension: Dimension::D3, layers: 4, ..desc },
            };
        }
        desc
    }

    fn format(&mut self) -> Format {
        use Format as F;
        self.entropy.pick(&[
            F::Rgba8Unorm,
            F::Rgba16Float,
            F::Rgba8UnormSrgb,
            F::Depth32Float,
            F::Rgba16Float,
            F::R8Unorm,
            F::Depth32FloatStencil8,
            F::Rgba32Float,
            F::R32Uint,
            F::Depth24PlusStencil8,
            F::Stencil8,
        ])
    }

    /// Returns a random range of a texture; for attachments, one level.
    pub(super) fn range(&mut self, texture: usize, attachment: bool) -> Range {
        let desc = self.textures[texture].desc;
        let (mips, layers) = (desc.mip_count(FRAME), desc.tracked_layers());
        let mut range = Range::ALL;
        if attachment || self.entropy.one_in(2) {
            range.mip = self.entropy.below(mips) as u8;
            range.mips = 1;
            if mips == 1 && self.entropy.one_in(2) {
                range.mips = u8::MAX; // the same range in another form
            }
        }
        let layers = if desc.dimension == Dimension::D3 { 0 } else { layers };
        let slices = if layers == 0 { desc.slices(range.mip.into()) } else { 0 };
        if attachment && slices > 1 {
            (range.layer, range.layers) = (self.entropy.below(slices) as u16, 1);
        }
        match self.entropy.below(3) {
            1 if layers > 0 => {
                range.layer = self.entropy.below(layers) as u16;
                let left = layers - u32::from(range.layer);
                range.layers = 1 + self.entropy.below(left) as u16;
            }
            2 if layers > 0 => range.layers = layers as u16,
            _ => {}
        }
        if desc.format.planes() == 2 {
            range.aspect = self.entropy.pick(&[Aspect::All, Aspect::Depth, Aspect::Stencil]);
        }
        if attachment && !self.profile.plain_accesses && !self.profile.plain && self.entropy.one_in(6) {
            range.view = match desc.format {
                Format::Rgba8Unorm => Some(Format::Rgba8UnormSrgb),
                Format::Rgba8UnormSrgb => Some(Format::Rgba8Unorm),
                _ => None,
            };
        }
        if self.slips() {
            range.mip = range.mip.wrapping_add(self.entropy.below(3) as u8);
            range.layers = range.layers.wrapping_add(1);
        }
        range
    }

    /// Adds exports and returns the graph.
    pub(super) fn finish(mut self) -> Graph {
        for index in 0..self.textures.len() {
            let texture = &self.textures[index];
            // Textures with readers are exported less often, so that they can share memory or be inlined.
            let odds = if texture.read { 8 } else { 2 };
            let whole = texture.is_defined(Range::ALL);
            let wanted = self.entropy.one_in(odds) || (!texture.read && self.entropy.one_in(2));
            if whole && wanted || self.slips() {
                let handle = self.textures[index].handle;
                let readback = self.entropy.one_in(3);
                let exported = if readback { self.graph.readback(handle) } else { self.graph.export(handle) };
                assert!(exported.is_ok() || self.profile.sloppy, "a valid export was rejected");
                self.textures[index].read = true;
            }
        }
        for index in 0..self.buffers.len() {
            if self.buffers[index].is_defined(None) && self.entropy.one_in(3) || self.slips() {
                let handle = self.buffers[index].handle;
                let readback = self.entropy.one_in(3);
                let graph = &mut self.graph;
                let exported = if readback { graph.readback_buffer(handle) } else { graph.export_buffer(handle) };
                assert!(exported.is_ok() || self.profile.sloppy, "a valid export was rejected");
            }
        }
        let count = if self.profile.forwards { self.textures.len() as u32 } else { 0 };
        for _ in 0..4 * count {
            let [from, to] = [(); 2].map(|()| self.entropy.below(count) as usize);
            let (from, to) = (self.textures[from].handle, self.textures[to].handle);
            let mip = self.entropy.below(3) as u8;
            // Invalid forwards are ignored.
            let _ = if self.entropy.one_in(2) {
                self.graph.forward(from, to)
            } else {
                self.graph.forward(from, to.mip(mip))
            };
        }
        self.graph
    }
}
