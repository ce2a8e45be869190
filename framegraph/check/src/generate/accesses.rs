//! The accesses of a random pass: chosen first, so that they do not conflict, and declared afterwards.

use super::profile::FRAME;
use super::world::{PIECE_BYTES, World};
use framegraph::access::{AccessKind, ClearValue, Intent, Mode, Range};
use framegraph::error::DeclareError;
use framegraph::format::{Aspect, Format};
use framegraph::graph::PassKind;
use framegraph::handle::{Buffer, Part, Texture};
use framegraph::pass_builder::{MAX_COLORS, PassBuilder};
use framegraph::resolve::ResolveMode;

/// The accessed resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    Texture(usize, Range),
    /// A whole buffer, or a range of its pieces.
    Buffer(usize, Option<(u8, u8)>),
    /// An earlier history image.
    Previous(usize),
}

/// A chosen access.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chosen {
    pub(super) what: What,
    pub(super) kind: AccessKind,
    /// `None` for reads.
    pub(super) intent: Option<Intent>,
    /// For a resolve target: index of the chosen access that it resolves.
    pub(super) averages: usize,
    /// Mode of a resolve.
    pub(super) resolve: ResolveMode,
}

/// A pass under construction.
#[derive(Default)]
pub(super) struct Draft {
    pub(super) accesses: Vec<Chosen>,
    pub(super) kind: Option<PassKind>,
    pub(super) side_effect: bool,
    pub(super) pointwise: bool,
    pub(super) blends: bool,
    pub(super) takes_epilogue: bool,
    pub(super) never_merge: bool,
    /// Slot of the first color attachment, if there are enough slots.
    pub(super) first_slot: u8,
}

impl Draft {
    /// Returns `true` if an access can be added without a conflict.
    pub(super) fn admits(&self, world: &World<'_, '_>, what: What, writes: bool) -> bool {
        self.accesses.iter().all(|a| {
            let both_read = a.intent.is_none() && !writes;
            let apart = match (a.what, what) {
                (What::Texture(i, r), What::Texture(j, s)) => {
                    // Few devices write one plane while shaders read the other.
                    let all = |range: Range| Range { aspect: Aspect::All, ..range };
                    i != j || !all(r).overlaps(&all(s), world.textures[i].desc.format)
                }
                // Other bytes may be written in the same way; this case is generated elsewhere.
                (What::Buffer(i, _), What::Buffer(j, _)) => i != j,
                (a, b) => a != b,
            };
            both_read || apart
        })
    }

    pub(super) fn read(&mut self, what: What, kind: AccessKind) {
        self.accesses.push(Chosen { what, kind, intent: None, averages: 0, resolve: ResolveMode::Average });
    }

    pub(super) fn write(&mut self, what: What, kind: AccessKind, intent: Intent) {
        self.accesses.push(Chosen { what, kind, intent: Some(intent), averages: 0, resolve: ResolveMode::Average });
    }

    /// Number of accesses of a kind.
    pub(super) fn count(&self, kind: AccessKind) -> usize {
        self.accesses.iter().filter(|a| a.kind == kind).count()
    }

    /// Bytes per sample of the color attachments.
    pub(super) fn color_bytes(&self, world: &World<'_, '_>) -> u32 {
        let colors = self.accesses.iter().filter(|a| a.kind == AccessKind::Color);
        let bytes = colors.map(|a| match a.what {
            What::Texture(t, _) => world.textures[t].desc.format.tile_bytes(),
            _ => 0,
        });
        bytes.sum()
    }

    /// Declares the pass and records the contents it defines. Fails only if rules were violated on purpose.
    pub(super) fn declare(&self, world: &mut World<'_, '_>, name: &str) {
        let World { graph, textures, buffers, previous, profile, .. } = world;
        let mut handles: Vec<Texture> = textures.iter().map(|t| t.handle).collect();
        let mut buffer_handles: Vec<Buffer> = buffers.iter().map(|b| b.handle).collect();
        let declared = graph.add_fn(name, |p| {
            self.flags(p)?;
            let mut made = Vec::new();
            let colors = self.count(AccessKind::Color) as u8;
            let mut slots = self.first_slot.min(MAX_COLORS.saturating_sub(colors))..;
            for access in &self.accesses {
                let done = match access.what {
                    What::Texture(index, range) => {
                        let part = handles[index].range(range);
                        let averaged = made.get(access.averages).copied().flatten();
                        let done = access.on_texture(p, part, averaged, &mut slots)?;
                        handles[index] = done.unwrap_or(handles[index]);
                        Some(handles[index])
                    }
                    What::Buffer(index, pieces) => {
                        let handle = &mut buffer_handles[index];
                        let part = pieces.map_or((*handle).into(), |(first, end)| {
                            handle.bytes(u64::from(first) * PIECE_BYTES, u64::from(end - first) * PIECE_BYTES)
                        });
                        match access.intent {
                            None => p.read_buffer(part, access.kind).map(drop)?,
                            Some(intent) => {
                                *handle = p.write_buffer(part, access.kind, intent)?;
                            }
                        }
                        None
                    }
                    What::Previous(index) => {
                        access.read_of(p, previous[index].0)?;
                        None
                    }
                };
                made.push(done);
            }
            Ok(())
        });
        match declared {
            Ok(()) => {}
            Err(error) => {
                assert!(profile.sloppy, "a valid pass was rejected: {error}");
                return;
            }
        }
        for (texture, handle) in textures.iter_mut().zip(handles) {
            texture.handle = handle;
        }
        for (buffer, handle) in buffers.iter_mut().zip(buffer_handles) {
            buffer.handle = handle;
        }
        for access in &self.accesses {
            let reads = access.intent.is_none() || access.intent == Some(Intent::Modify);
            match access.what {
                What::Texture(index, range) => {
                    textures[index].read |= reads;
                    if access.intent.is_some() {
                        textures[index].define(range);
                    }
                }
                What::Buffer(index, pieces) => {
                    if access.intent.is_some() {
                        buffers[index].define(pieces);
                    }
                }
                What::Previous(_) => {}
            }
        }
        let drawn = |a: &&Chosen| matches!(a.kind, AccessKind::Color | AccessKind::Depth | AccessKind::Resolve);
        let drawn: Vec<_> = self.accesses.iter().filter(drawn).collect();
        if !drawn.is_empty() {
            world.last.clear();
            world.last.extend(drawn.iter().filter_map(|a| match a.what {
                What::Texture(index, range) => Some((index, range)),
                _ => None,
            }));
        }
    }

    fn flags(&self, p: &mut PassBuilder<'_>) -> Result<(), DeclareError> {
        if self.side_effect {
            p.side_effect();
        }
        if self.pointwise {
            p.pointwise();
        }
        if self.blends {
            p.blends();
        }
        if self.takes_epilogue {
            p.takes_epilogue();
        }
        if self.never_merge {
            p.never_merge();
        }
        self.kind.map_or(Ok(()), |kind| p.kind(kind))
    }
}

impl Chosen {
    /// Declares an access to a texture. Returns the new handle of a write.
    fn on_texture(
        &self,
        p: &mut PassBuilder<'_>,
        part: Part,
        averaged: Option<Texture>,
        slots: &mut impl Iterator<Item = u8>,
    ) -> Result<Option<Texture>, DeclareError> {
        let Some(intent) = self.intent else {
            return self.read_of(p, part).map(|()| None);
        };
        let new = match self.kind {
            AccessKind::Color => p.color_at(slots.next().unwrap_or(0), part, intent)?,
            AccessKind::Depth => p.depth(part, intent)?,
            AccessKind::Resolve => {
                p.resolve_as(self.resolve, averaged.unwrap_or(framegraph::internals::NO_TEXTURE), part)?
            }
            AccessKind::StorageWrite => p.storage_write(part, intent)?,
            _ => p.copy_target(part, intent)?,
        };
        Ok(Some(new))
    }

    fn read_of(
        &self,
        p: &mut PassBuilder<'_>,
        part: impl Into<framegraph::handle::ReadOnly>,
    ) -> Result<(), DeclareError> {
        match self.kind {
            AccessKind::DepthReadOnly => p.depth_read_only(part),
            AccessKind::SamePixel => p.same_pixel(part),
            AccessKind::StorageRead => p.storage_read(part),
            AccessKind::CopySource => p.copy_source(part),
            _ => p.sampled(part),
        }
        .map(drop)
    }
}

/// Returns the intent of a write, depending on previous contents. A clear has a valid value.
pub(super) fn intent(world: &mut World<'_, '_>, what: What, kind: AccessKind) -> Intent {
    let (defined, format) = match what {
        What::Texture(index, range) => {
            let texture = &world.textures[index];
            (texture.is_defined(range), Some(texture.desc.format))
        }
        What::Buffer(index, pieces) => (world.buffers[index].is_defined(pieces), None),
        What::Previous(_) => (true, None),
    };
    let defined = defined || world.slips();
    let mode = world.entropy.pick(&[Mode::Clear, Mode::Overwrite, Mode::Modify, Mode::Modify, Mode::Modify]);
    match mode {
        Mode::Modify if defined => Intent::Modify,
        Mode::Clear => Intent::Clear(clear(world, format, kind)),
        _ => Intent::Overwrite,
    }
}

fn clear(world: &mut World<'_, '_>, format: Option<Format>, kind: AccessKind) -> ClearValue {
    let slips = world.slips();
    let depth = format.is_some_and(Format::is_depth_stencil) != slips;
    match world.entropy.below(4) {
        0 => ClearValue::Zero,
        _ if !kind.is_attachment() => ClearValue::Zero,
        1 if depth => ClearValue::FAR,
        _ if depth => ClearValue::FAR_REVERSED,
        1 => ClearValue::TRANSPARENT,
        _ => ClearValue::BLACK,
    }
}

/// Size, layers and samples of a pass's attachments.
pub(super) type Shape = ([u32; 2], u32, u8);

/// Returns the shape of a range as an attachment.
pub(super) fn shape(world: &World<'_, '_>, texture: usize, range: Range) -> Shape {
    let desc = world.textures[texture].desc;
    let layers = range.layer_range(desc.tracked_layers()).len() as u32;
    (desc.mip_extent(FRAME, range.mip.into()), layers, desc.samples)
}
