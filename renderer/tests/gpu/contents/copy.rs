//! What a copy pass does, as a list of copies that the recorder and the oracle both follow.
//!
//! A target whose older contents are dead is filled first: color and stencil with a pattern, depth (which no buffer can be
//! copied into) with zeros. Then every source that fits the target goes over its corner, and something of each source is
//! taken down in a buffer of the test's own.

use super::code::planes;
use super::spec::{layers, mips, planes_of, texels};
use framegraph::{Access, AccessKind, Aspect, Desc, Format, Graph, Mode, PassId, ResourceId};

/// A level and layer of a texture, by the row of the pass's accesses that names the texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spot {
    pub access: usize,
    pub mip: u8,
    pub layer: u16,
}

/// One copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copy {
    /// A pattern into one plane.
    Pattern { into: Spot, plane: Aspect },
    /// Zeros into all planes.
    Zero { into: Spot },
    /// A corner of all planes into a corner.
    Texture { from: Spot, into: Spot, texels: [u32; 2] },
    /// A pattern into the first bytes of a buffer.
    PatternBuffer { into: usize, bytes: u64 },
    /// The first bytes of a buffer into those of another.
    Buffer { from: usize, into: usize, bytes: u64 },
    /// Rows of a color texture into a buffer, each at a multiple of `pitch` behind `offset`.
    Rows { from: Spot, into: usize, offset: u64, pitch: u32, texels: [u32; 2] },
    /// The first rows of a plane into a note of the pass.
    Note { note: usize, from: Spot, plane: Aspect, pitch: u32, texels: [u32; 2] },
    /// The first bytes of a buffer into a note of the pass.
    NoteBuffer { note: usize, from: usize, bytes: u64 },
}

/// Notes that a copy pass can leave.
pub const NOTES: usize = 2;

/// Bytes of a note: all of the largest depth plane, which is copied whole or not at all.
pub const NOTE_BYTES: u64 = 8192;

/// Bytes at the start of every buffer that are good arguments of indirect work.
const ARGUMENTS_BYTES: u64 = 16;

/// What a copy pass does; `None` when it asks for what WebGPU cannot copy.
pub fn copies(graph: &Graph, pass: PassId) -> Option<Vec<Copy>> {
    let accesses = graph.accesses_of(pass);
    let mut copies = Vec::new();
    let of_kind = |kind| accesses.iter().enumerate().filter(move |(_, a)| a.kind == kind);
    for (target, row) in of_kind(AccessKind::CopyTarget) {
        let buffer = graph.resources()[row.resource.index()].desc.texture().is_none();
        match row.mode {
            Mode::Overwrite => fill(graph, row, target, &mut copies)?,
            Mode::Clear if buffer => copies.push(Copy::PatternBuffer { into: target, bytes: ARGUMENTS_BYTES }),
            Mode::Clear | Mode::Modify | Mode::Read => {}
        }
        for (source, from) in of_kind(AccessKind::CopySource) {
            over(graph, (source, from), (target, row), &mut copies);
        }
    }
    let sources = (0..NOTES).zip(of_kind(AccessKind::CopySource));
    copies.extend(sources.filter_map(|(slot, (source, from))| note(graph, slot, source, from)));
    Some(copies)
}

/// What a copy pass takes down of a source, wherever its targets go.
fn note(graph: &Graph, note: usize, source: usize, from: &Access) -> Option<Copy> {
    let Some((format, samples)) = format_of(graph, from.resource) else {
        let bytes = graph.resources()[from.resource.index()].desc.bytes(super::FRAME).min(NOTE_BYTES);
        return Some(Copy::NoteBuffer { note, from: source, bytes });
    };
    // Depth of 24 bits and samples cannot be copied into a buffer.
    let copied = |p: &Aspect| *p != Aspect::Depth || format != Format::Depth24PlusStencil8;
    let plane = planes_of(format, from.range.aspect).into_iter().find(copied).filter(|_| samples == 1)?;
    let from_spot = spots(graph, source, from).first().copied()?;
    let [width, height] = texels(graph, from.resource, from_spot.mip);
    let texel_bytes = if plane == Aspect::Stencil { 1 } else { format.texel_bytes(plane) };
    let pitch = (width * texel_bytes).next_multiple_of(PITCH);
    Some(Copy::Note { note, from: from_spot, plane, pitch, texels: [width, height.min(NOTE_BYTES as u32 / pitch)] })
}

/// How many sources are not taken down, or only a level, layer or plane of them.
pub fn unobserved(graph: &Graph, pass: PassId, copies: &[Copy]) -> usize {
    let sources = graph.accesses_of(pass).iter().enumerate().filter(|(_, a)| a.kind == AccessKind::CopySource);
    let noted = |source: usize| {
        copies.iter().any(|c| match c {
            Copy::Note { from, .. } => from.access == source,
            Copy::NoteBuffer { from, .. } => *from == source,
            _ => false,
        })
    };
    let planes = |row: &Access| format_of(graph, row.resource).map_or(1, |(f, _)| planes_of(f, row.range.aspect).len());
    let whole = |source: usize, row: &Access| spots(graph, source, row).len().max(1) * planes(row) == 1;
    sources.filter(|(source, row)| !noted(*source) || !whole(*source, row)).count()
}

fn format_of(graph: &Graph, resource: ResourceId) -> Option<(Format, u8)> {
    graph.resources()[resource.index()].desc.texture().map(|t| (t.format, t.samples))
}

/// The spots of an access, level by level.
fn spots(graph: &Graph, access: usize, row: &Access) -> Vec<Spot> {
    let layers = layers(graph, row);
    mips(graph, row).flat_map(|mip| layers.clone().map(move |layer| Spot { access, mip, layer })).collect()
}

fn whole(format: Format, aspect: Aspect) -> bool {
    aspect == Aspect::All || planes(format).len() == 1
}

fn fill(graph: &Graph, row: &Access, target: usize, copies: &mut Vec<Copy>) -> Option<()> {
    let Some((format, samples)) = format_of(graph, row.resource) else {
        let bytes = graph.resources()[row.resource.index()].desc.bytes(super::FRAME);
        copies.push(Copy::PatternBuffer { into: target, bytes });
        return Some(());
    };
    let stencil_alone = format.has_stencil() && (row.range.aspect == Aspect::Stencil || !format.has_depth());
    let plane = if stencil_alone { Aspect::Stencil } else { Aspect::All };
    for into in spots(graph, target, row) {
        if samples == 1 && (!format.is_depth_stencil() || stencil_alone) {
            copies.push(Copy::Pattern { into, plane });
        } else if whole(format, row.range.aspect) {
            copies.push(Copy::Zero { into });
        } else {
            return None;
        }
    }
    Some(())
}

/// Rows of a buffer in a copy begin at multiples of this.
const PITCH: u32 = 256;

fn over(graph: &Graph, (source, from): (usize, &Access), (target, into): (usize, &Access), copies: &mut Vec<Copy>) {
    match (format_of(graph, from.resource), format_of(graph, into.resource)) {
        (Some((format, samples)), Some(other)) => {
            let planes = whole(format, from.range.aspect) && whole(format, into.range.aspect);
            if other != (format, samples) || from.resource == into.resource || !planes {
                return;
            }
            for (from_spot, into_spot) in spots(graph, source, from).into_iter().zip(spots(graph, target, into)) {
                let a = texels(graph, from.resource, from_spot.mip);
                let b = texels(graph, into.resource, into_spot.mip);
                let texels = [a[0].min(b[0]), a[1].min(b[1])];
                // Depth and samples are copied whole or not at all.
                if (samples == 1 && !format.is_depth_stencil()) || a == b {
                    copies.push(Copy::Texture { from: from_spot, into: into_spot, texels });
                }
            }
        }
        (None, None) => {
            let bytes = |row: &Access| graph.resources()[row.resource.index()].desc.bytes(super::FRAME);
            if from.resource != into.resource {
                copies.push(Copy::Buffer { from: source, into: target, bytes: bytes(from).min(bytes(into)) });
            }
        }
        (Some((format, samples)), None) => {
            let Desc::Buffer(buffer) = graph.resources()[into.resource.index()].desc else { return };
            let Some(spot) = spots(graph, source, from).first().copied() else { return };
            let [width, height] = texels(graph, from.resource, spot.mip);
            let pitch = (width * format.block_bytes()).next_multiple_of(PITCH);
            let offset = u64::from(PITCH);
            let rows = buffer.bytes(super::FRAME).saturating_sub(offset) / u64::from(pitch);
            let rows = rows.min(u64::from(height)) as u32;
            if samples == 1 && !format.is_depth_stencil() && rows > 0 {
                copies.push(Copy::Rows { from: spot, into: target, offset, pitch, texels: [width, rows] });
            }
        }
        (None, Some(_)) => {}
    }
}
