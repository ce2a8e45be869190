//! Phase 1, first part: size of each resource at the current frame size, and validation of descriptors.
//!
//! Computes relative extents, full mip chains and byte sizes once for all phases.

use super::error::{CompileError, CompileErrors, CompileReason, ShapeReason};
use super::layout::Layout;
use crate::access::Access;
use crate::caps::{Caps, FormatCaps};
use crate::format::Format;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use crate::resource::{BufferDesc, BufferSize, Desc, Dimension, Extent, Kind, Resource, TextureDesc};

/// A resource at a known frame size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Measured {
    /// Width and height of level 0 in texels. For a buffer, lower and upper half of its size in bytes. Resources that
    /// differ in it cannot share a slot.
    pub(crate) extent: [u32; 2],
    /// Size in bytes in the declared format, without padding.
    pub(crate) bytes: u64,
    /// Levels, layers, samples and format.
    pub(crate) layout: Layout,
}

impl Measured {
    #[inline]
    const fn buffer(bytes: u64) -> Self {
        Self { extent: [bytes as u32, (bytes >> 32) as u32], bytes, layout: Layout::BUFFER }
    }
}

/// The measures of all resources.
#[derive(Debug, Default)]
pub(crate) struct Measures {
    /// Parallel to [`Graph::resources`](crate::graph::Tables::resources).
    pub(crate) rows: Vec<Measured>,
    /// Resources that are not transient, ordered by id.
    pub(crate) outside: Vec<ResourceId>,
    /// Set if a resource may have several subresources.
    pub(crate) several: bool,
}

/// Fills `measures` and appends an error for each invalid or unsupported descriptor. Without errors, the number of
/// subresources is within the limit.
#[inline(never)]
pub(crate) fn measure(
    graph: &Tables,
    caps: &Caps,
    frame: [u32; 2],
    measures: &mut Measures,
    errors: &mut CompileErrors,
) {
    let Measures { rows, outside, several } = &mut *measures;
    *several = !graph.byte_ranges.is_empty();
    outside.clear();
    let max_texels = if caps.max_texture_layers == 0 || caps.max_samples == 0 { 0 } else { caps.max_texture_texels };
    // Every row is overwritten, so old rows are not cleared.
    rows.resize(graph.resources.len(), Measured::default());
    for (index, (row, measured)) in graph.resources.iter().zip(rows).enumerate() {
        if row.kind != Kind::Transient {
            outside.push(ResourceId::at(index));
        }
        let plain = match &row.desc {
            Desc::Texture(t) => plain_texture(t, frame, max_texels),
            Desc::Buffer(BufferDesc { size: BufferSize::Bytes(bytes) })
                if *bytes != 0 && *bytes <= caps.max_buffer_bytes =>
            {
                Some(Measured::buffer(*bytes))
            }
            Desc::Buffer(_) => None,
        };
        // Written in both branches, so that the row goes from registers into the array.
        if let Some(plain) = plain {
            *measured = plain;
        } else {
            *several = true;
            *measured = measure_and_judge(graph, ResourceId::at(index), caps, frame, errors);
        }
    }
    if *several {
        limit_parts(graph, frame, errors);
        inside(graph, &measures.rows, errors);
    }
}

/// Maximum number of subresources of all resources together. Phases keep one value for each.
const MAX_SUBRESOURCES: u64 = 1 << 24;

/// Reports the resource that exceeds the maximum number of subresources.
fn limit_parts(graph: &Tables, frame: [u32; 2], errors: &mut CompileErrors) {
    // Each byte range splits its buffer in at most two places.
    let mut parts = 2 * graph.byte_ranges.len() as u64;
    let beyond = graph.resources.iter().position(|row| {
        parts += u64::from(row.desc.subresources(frame));
        parts > MAX_SUBRESOURCES
    });
    if let Some(index) = beyond {
        let reason = CompileReason::Shape(ShapeReason::TooManySubresources { parts, max: MAX_SUBRESOURCES });
        errors.push(|| CompileError::new(graph, reason, PassId::NONE, ResourceId::at(index)));
    }
}

/// Reports byte ranges that exceed a buffer with a relative size.
fn inside(graph: &Tables, rows: &[Measured], errors: &mut CompileErrors) {
    for (index, range) in graph.byte_ranges.iter().enumerate() {
        let size = rows[range.resource.index()].bytes;
        if range.end() > size {
            let names = |a: &Access| a.range.bytes.index() == index;
            let access = graph.accesses.iter().position(names).unwrap_or_default() as u32;
            let pass = graph.passes.iter().position(|p| p.accesses.range().contains(&(access as usize)));
            let reason = CompileReason::NoSuchBytes { offset: range.offset, bytes: range.bytes, size };
            let pass = pass.map_or(PassId::NONE, PassId::at);
            errors.push(|| CompileError::new(graph, reason, pass, range.resource));
        }
    }
}

/// Fast path: measures a texture with one level, layer, plane and sample and a side of at most `max_texels`. Returns
/// `None` for others.
#[inline]
fn plain_texture(t: &TextureDesc, frame: [u32; 2], max_texels: u32) -> Option<Measured> {
    let &TextureDesc { extent, format, mips: 1, samples: 1, layers: 1, dimension: Dimension::D2 } = t else {
        return None;
    };
    let [width, height] = match extent {
        Extent::Absolute { width, height } => [width, height],
        Extent::Relative { .. } => follow(extent, frame),
    };
    let within = |side: u32| side != 0 && side <= max_texels;
    let texel_bytes = TEXEL_BYTES[format as usize];
    if texel_bytes == 0 || !within(width) || !within(height) {
        return None;
    }
    let bytes = (u64::from(width) * u64::from(height)).saturating_mul(texel_bytes.into());
    Some(Measured { extent: [width, height], bytes, layout: Layout::flat(format) })
}

#[inline(never)]
fn follow(extent: Extent, frame: [u32; 2]) -> [u32; 2] {
    extent.texels(frame)
}

/// Bytes per texel of uncompressed formats with one plane; 0 for others.
const TEXEL_BYTES: [u8; Format::ALL.len()] = {
    let mut table = [0; Format::ALL.len()];
    let mut at = 0;
    while at < table.len() {
        let format = Format::ALL[at];
        if format.planes() == 1 && !format.is_compressed() {
            table[at] = format.block_bytes() as u8;
        }
        at += 1;
    }
    table
};

/// Measures any resource and reports errors of its descriptor.
#[inline(never)]
fn measure_and_judge(
    graph: &Tables,
    resource: ResourceId,
    caps: &Caps,
    frame: [u32; 2],
    errors: &mut CompileErrors,
) -> Measured {
    let row = &graph.resources[resource.index()];
    if let Some(fault) = fault(row, caps, frame) {
        errors.push(|| CompileError::new(graph, CompileReason::Shape(fault), PassId::NONE, resource));
    }
    match &row.desc {
        Desc::Texture(t) => Measured {
            extent: t.extent.texels(frame),
            bytes: t.bytes(frame),
            layout: Layout::of_texture(t, t.mip_count(frame) as u8),
        },
        Desc::Buffer(b) => Measured::buffer(b.bytes(frame)),
    }
}

fn fault(row: &Resource, caps: &Caps, frame: [u32; 2]) -> Option<ShapeReason> {
    let max = caps.max_buffer_bytes;
    match row.desc {
        Desc::Texture(ref t) => texture_fault(t, caps, frame),
        Desc::Buffer(buffer) => match buffer.bytes(frame) {
            0 => Some(ShapeReason::EmptyBuffer),
            bytes => (bytes > max).then_some(ShapeReason::LargeBuffer { bytes, max }),
        },
    }
}

fn texture_fault(t: &TextureDesc, caps: &Caps, frame: [u32; 2]) -> Option<ShapeReason> {
    let TextureDesc { layers, samples, .. } = *t;
    let extent = t.extent.texels(frame);
    let (side, mips) = (extent[0].max(extent[1]), t.mip_count(frame));
    if extent.contains(&0) || layers == 0 || samples == 0 {
        return Some(ShapeReason::Empty { extent, layers, samples });
    }
    let (volume, format) = (t.dimension == Dimension::D3, t.format);
    let depth = if volume { u32::from(layers) } else { 1 };
    // The full chain of a volume also halves its depth.
    let full = side.max(depth).ilog2() + 1;
    let (block_width, block_height) = format.block_texels();
    let cut = !extent[0].is_multiple_of(block_width) || !extent[1].is_multiple_of(block_height);
    let uses = caps.formats.get(format);
    let counted = FormatCaps::of_samples(samples).is_some_and(|bit| uses.contains(bit));
    if volume && side.max(depth) > caps.max_volume_texels {
        Some(ShapeReason::LargeVolume { extent: [extent[0], extent[1], depth], max: caps.max_volume_texels })
    } else if side > caps.max_texture_texels {
        Some(ShapeReason::Large { extent, max: caps.max_texture_texels })
    } else if mips > full {
        Some(ShapeReason::Levels { mips: t.mips, extent, full })
    } else if !volume && u32::from(layers) > caps.max_texture_layers {
        Some(ShapeReason::Layers { layers, max: caps.max_texture_layers })
    } else if cut && !caps.partial_blocks {
        Some(ShapeReason::PartialBlocks { extent, format, block: [block_width, block_height] })
    } else if samples > 1 && (mips > 1 || volume) {
        Some(ShapeReason::Multisampled { samples, mips })
    } else if !counted || samples > caps.max_samples {
        Some(ShapeReason::Samples { samples, format, uses, max: caps.max_samples })
    } else if samples > 1 && layers > 1 && !caps.multisampled_arrays {
        Some(ShapeReason::MultisampledLayers { samples, layers })
    } else if volume && (format.is_depth_stencil() || !uses.contains(FormatCaps::VOLUME)) {
        Some(ShapeReason::Volume { format })
    } else {
        None
    }
}
