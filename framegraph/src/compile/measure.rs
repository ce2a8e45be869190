//! Phase 1, first part: what each resource is in a frame of this size, and shapes that the frame or the device rules out.
//!
//! Relative extents, full chains of levels and bytes are worked out once, here; every later phase looks them up.

use super::error::{CompileError, CompileReason};
use super::layout::Layout;
use crate::caps::Caps;
use crate::format::Format;
use crate::graph::Tables;
use crate::id::ResourceId;
use crate::resource::{Desc, Dimension, Extent, Kind, Resource, TextureDesc};

/// A resource in a frame of known size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Measured {
    /// Width and height of level 0 in texels; 0 for a buffer.
    pub(crate) extent: [u32; 2],
    /// Bytes without padding, in the declared format.
    pub(crate) bytes: u64,
    /// Levels, layers, samples, format.
    pub(crate) layout: Layout,
}

/// The measures of all resources.
#[derive(Debug, Default)]
pub(crate) struct Measures {
    /// Parallel to [`Graph::resources`](crate::graph::Tables::resources).
    pub(crate) rows: Vec<Measured>,
    /// The resources that are not transient, in the order of their ids.
    pub(crate) outside: Vec<ResourceId>,
    /// Some resource may have several levels, layers or planes: none has if this is false.
    pub(crate) several: bool,
}

/// Fills `measures` and appends to `errors` what nothing, or not this device, can make. What passes has few enough parts
/// to be numbered.
#[inline(never)]
pub(crate) fn measure(
    graph: &Tables,
    caps: &Caps,
    frame: [u32; 2],
    measures: &mut Measures,
    errors: &mut Vec<CompileError>,
) {
    let Measures { rows, outside, several } = measures;
    *several = false;
    outside.clear();
    let most_texels = if caps.max_texture_layers == 0 || caps.max_samples == 0 { 0 } else { caps.max_texture_texels };
    // Every row is written, so those of the last time are not cleared.
    rows.resize(graph.resources.len(), Measured::default());
    for (index, (row, measured)) in graph.resources.iter().zip(rows).enumerate() {
        if row.kind != Kind::Transient {
            outside.push(ResourceId::at(index));
        }
        let plain = match &row.desc {
            Desc::Texture(t) => plain_texture(t, frame, most_texels),
            Desc::Buffer(b) if b.bytes != 0 && b.bytes <= caps.max_buffer_bytes => {
                Some(Measured { extent: [0; 2], bytes: b.bytes, layout: Layout::BUFFER })
            }
            Desc::Buffer(_) => None,
        };
        // Written in either case by itself, so that the row goes from registers into the array.
        if let Some(plain) = plain {
            *measured = plain;
        } else {
            *several = true;
            *measured = measure_and_judge(graph, ResourceId::at(index), caps, frame, errors);
        }
    }
    if *several {
        limit_parts(graph, frame, errors);
    }
}

/// The most levels, layers and planes of all resources together: what follows contents keeps a value for each.
const MOST_PARTS: u64 = 1 << 24;

/// Reports the first resource with which there are too many parts to follow.
fn limit_parts(graph: &Tables, frame: [u32; 2], errors: &mut Vec<CompileError>) {
    let mut parts = 0u64;
    let beyond = graph.resources.iter().position(|row| {
        parts += u64::from(row.desc.subresources(frame));
        parts > MOST_PARTS
    });
    if let Some(index) = beyond {
        let detail =
            format!("with it, all resources have {parts} levels, layers and planes; {MOST_PARTS} can be followed");
        let reason = CompileReason::Shape { detail, hint: "give the textures fewer levels or layers" };
        let resource = graph.resource_name(ResourceId::at(index)).to_owned();
        errors.push(CompileError { reason, pass: String::new(), resource, location: None });
    }
}

/// The measure of a texture of one level, layer, plane and sample, of at most `most_texels` a side: most are that, and
/// nothing is wrong with one.
#[inline]
fn plain_texture(t: &TextureDesc, frame: [u32; 2], most_texels: u32) -> Option<Measured> {
    let &TextureDesc { extent, format, mips: 1, samples: 1, layers: 1, dimension: Dimension::D2 } = t else {
        return None;
    };
    let [width, height] = match extent {
        Extent::Absolute { width, height } => [width, height],
        Extent::Relative { .. } => follow(extent, frame),
    };
    let within = |side: u32| side != 0 && side <= most_texels;
    let texel_bytes = TEXEL_BYTES[format as usize];
    if texel_bytes == 0 || !within(width) || !within(height) {
        return None;
    }
    let bytes = (u64::from(width) * u64::from(height)).saturating_mul(texel_bytes.into());
    Some(Measured { extent: [width, height], bytes, layout: Layout::flat(format) })
}

#[inline(never)]
fn follow(extent: Extent, frame: [u32; 2]) -> [u32; 2] {
    extent.resolve(frame)
}

/// Bytes of a texel of the formats with one plane that is not compressed; 0 of the others.
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

/// Measures any resource, and says what is wrong with it.
#[inline(never)]
fn measure_and_judge(
    graph: &Tables,
    resource: ResourceId,
    caps: &Caps,
    frame: [u32; 2],
    errors: &mut Vec<CompileError>,
) -> Measured {
    let row = &graph.resources[resource.index()];
    if let Some((detail, hint)) = problem(row, caps, frame) {
        let reason = CompileReason::Shape { detail, hint };
        let resource = graph.resource_name(resource).to_owned();
        errors.push(CompileError { reason, pass: String::new(), resource, location: None });
    }
    match &row.desc {
        Desc::Texture(t) => Measured {
            extent: t.extent.resolve(frame),
            bytes: t.bytes(frame),
            layout: Layout::of_texture(t, t.mip_count(frame) as u8),
        },
        Desc::Buffer(b) => Measured { extent: [0; 2], bytes: b.bytes, layout: Layout::BUFFER },
    }
}

fn problem(row: &Resource, caps: &Caps, frame: [u32; 2]) -> Option<(String, &'static str)> {
    match &row.desc {
        Desc::Texture(t) => texture_problem(t, caps, frame, row.kind),
        Desc::Buffer(b) if b.bytes == 0 => Some(("a buffer of 0 bytes".to_owned(), SIZE)),
        Desc::Buffer(b) if b.bytes > caps.max_buffer_bytes => {
            Some((format!("{} bytes, the device allows {}", b.bytes, caps.max_buffer_bytes), LIMIT))
        }
        Desc::Buffer(_) => None,
    }
}

const SIZE: &str = "give it at least one texel, layer and sample, or one byte";
const LIMIT: &str = "make it smaller, or choose another device";
const MULTISAMPLED: &str = "a multisampled texture has one level and two dimensions";

fn texture_problem(t: &TextureDesc, caps: &Caps, frame: [u32; 2], kind: Kind) -> Option<(String, &'static str)> {
    let [w, h] = t.extent.resolve(frame);
    let side = w.max(h);
    if w == 0 || h == 0 || t.layers == 0 || t.samples == 0 {
        return Some((format!("{w}x{h} texels, {} layers, {} samples", t.layers, t.samples), SIZE));
    }
    let imported = matches!(kind, Kind::Imported { .. });
    if side > caps.max_texture_texels && !imported {
        return Some((format!("{w}x{h} texels, the device allows {0}x{0}", caps.max_texture_texels), LIMIT));
    }
    let full = side.ilog2() + 1;
    if t.mip_count(frame) > full {
        return Some((
            format!("{} levels, {w}x{h} texels have {full}", t.mips),
            "ask for fewer levels, or for all of them",
        ));
    }
    if u32::from(t.layers) > caps.max_texture_layers && !imported {
        return Some((format!("{} layers, the device allows {}", t.layers, caps.max_texture_layers), LIMIT));
    }
    if !t.samples.is_power_of_two() || (t.samples > caps.max_samples && !imported) {
        return Some((format!("{} samples, the device allows 1 to {}", t.samples, caps.max_samples), LIMIT));
    }
    if t.samples > 1 && (t.mip_count(frame) > 1 || t.dimension != Dimension::D2) {
        return Some((format!("{} samples with {} levels", t.samples, t.mip_count(frame)), MULTISAMPLED));
    }
    None
}
