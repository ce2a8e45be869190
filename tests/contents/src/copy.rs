//! The work of a copy pass, as a list of copies that the recorder and the oracle both follow.
//!
//! Targets without older contents are filled first: color and stencil with a pattern, depth with zeros, since buffers
//! cannot be copied to depth. Then each source that fits is copied to the target's corner. A part of each source is
//! also copied to a buffer of the test (a note).

use super::code::planes;
use super::spec::{layers, mips, planes_of, texels};
use framegraph::{Access, AccessKind, Aspect, Desc, Format, Graph, Mode, PassId, ResourceId};

/// A level and layer of a texture. `access` is the row in the pass's accesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spot {
    pub access: usize,
    pub mip: u8,
    pub layer: u16,
}

/// One copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copy {
    /// Copies a pattern to one plane.
    Pattern { into: Spot, plane: Aspect },
    /// Clears all planes to zero.
    Zero { into: Spot },
    /// Copies a corner of all planes to a corner.
    Texture { from: Spot, into: Spot, texels: [u32; 2] },
    /// Copies a pattern to the first bytes of a buffer.
    PatternBuffer { into: usize, bytes: u64 },
    /// Copies the first bytes of a buffer to another.
    Buffer { from: usize, into: usize, bytes: u64 },
    /// Copies rows of a color texture to a buffer at `offset`, with a distance of `pitch` bytes.
    Rows { from: Spot, into: usize, offset: u64, pitch: u32, texels: [u32; 2] },
    /// Copies the first rows of a plane to a note of the pass.
    Note { note: usize, from: Spot, plane: Aspect, pitch: u32, texels: [u32; 2] },
    /// Copies the first bytes of a buffer to a note of the pass.
    NoteBuffer { note: usize, from: usize, bytes: u64 },
}

/// Maximum number of notes of a copy pass.
pub const NOTES: usize = 2;

/// Size of a note in bytes: the largest depth plane, which can only be copied as a whole.
pub const NOTE_BYTES: u64 = 8192;

/// Number of bytes at the start of every buffer that are valid indirect arguments.
const ARGUMENTS_BYTES: u64 = 16;

/// Returns the copies of a pass; `None` if WebGPU does not support one of them.
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

/// Returns the copy of a source to a note.
fn note(graph: &Graph, note: usize, source: usize, from: &Access) -> Option<Copy> {
    let Some((format, samples)) = format_of(graph, from.resource) else {
        let bytes = graph.resources()[from.resource.index()].desc.bytes(super::FRAME).min(NOTE_BYTES);
        return Some(Copy::NoteBuffer { note, from: source, bytes });
    };
    // 24-bit depth and multisampled textures cannot be copied to buffers.
    let copied = |p: &Aspect| *p != Aspect::Depth || format != Format::Depth24PlusStencil8;
    let plane = planes_of(format, from.range.aspect).into_iter().find(copied).filter(|_| samples == 1)?;
    let from_spot = spots(graph, source, from).first().copied()?;
    let [width, height] = texels(graph, from.resource, from_spot.mip);
    let texel_bytes = if plane == Aspect::Stencil { 1 } else { format.texel_bytes(plane) };
    let pitch = (width * texel_bytes).next_multiple_of(PITCH);
    Some(Copy::Note { note, from: from_spot, plane, pitch, texels: [width, height.min(NOTE_BYTES as u32 / pitch)] })
}

/// Returns the number of sources without a note, or with a note of only one level, layer or plane.
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

/// Returns the levels and layers of an access.
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

/// Alignment of rows in buffers, in bytes.
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
                // Depth and multisampled textures can only be copied as a whole.
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
