//! Phase 1, first part: what each resource is in a frame of this size, and shapes that the frame or the device rules out.
//!
//! Relative extents, full chains of levels and bytes are worked out once, here; every later phase looks them up.

use super::error::{CompileError, CompileReason};
use crate::caps::Caps;
use crate::graph::Graph;
use crate::id::ResourceId;
use crate::resource::{Desc, Dimension, Kind, Resource, TextureDesc};

/// A resource in a frame of known size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Measured {
    /// Width and height of level 0 in texels; 0 for a buffer.
    pub(crate) extent: [u32; 2],
    /// Bytes without padding, in the declared format.
    pub(crate) bytes: u64,
    /// Levels; 1 for a buffer.
    pub(crate) mips: u32,
    /// Levels × layers × planes; 1 for a buffer.
    pub(crate) parts: u32,
}

/// The measures of all resources.
#[derive(Debug, Default)]
pub(crate) struct Measures {
    /// Parallel to [`Graph::resources`].
    pub(crate) rows: Vec<Measured>,
    /// The resources that are not transient, in the order of their ids.
    pub(crate) outside: Vec<ResourceId>,
}

/// Fills `measures` and appends to `errors` what nothing, or not this device, can make. What passes has few enough parts
/// to be numbered.
pub(crate) fn measure(
    graph: &Graph,
    caps: &Caps,
    frame: [u32; 2],
    measures: &mut Measures,
    errors: &mut Vec<CompileError>,
) {
    let Measures { rows, outside } = measures;
    outside.clear();
    rows.clear();
    rows.resize(graph.resources.len(), Measured::default());
    for (index, (row, measured)) in graph.resources.iter().zip(rows).enumerate() {
        if row.kind != Kind::Transient {
            outside.push(ResourceId::at(index));
        }
        match &row.desc {
            Desc::Texture(t) => {
                measured.extent = t.extent.resolve(frame);
                measured.mips = if t.mips == 1 { 1 } else { t.mip_count(frame) };
                let layers = t.tracked_layers().max(1);
                measured.parts = measured.mips.saturating_mul(layers * t.format.planes());
                measured.bytes = t.bytes(frame);
            }
            Desc::Buffer(b) => {
                (measured.mips, measured.parts, measured.bytes) = (1, 1, b.bytes);
            }
        }
        if !is_plain(row, measured, caps)
            && let Some((detail, hint)) = problem(row, caps, frame)
        {
            errors.push(CompileError {
                reason: CompileReason::Shape { detail, hint },
                pass: String::new(),
                resource: graph.resource_name(ResourceId::at(index)).to_owned(),
                location: None,
            });
        }
    }
}

/// A quick test that most resources pass: no device and no rule has anything against one that does.
#[inline]
fn is_plain(row: &Resource, measured: &Measured, caps: &Caps) -> bool {
    let within = |value: u32, most: u32| value != 0 && value <= most;
    match &row.desc {
        Desc::Texture(t) => {
            let [w, h] = measured.extent;
            (t.mips, t.samples) == (1, 1)
                && within(w, caps.max_texture_texels)
                && within(h, caps.max_texture_texels)
                && within(t.layers.into(), caps.max_texture_layers)
                && caps.max_samples != 0
        }
        Desc::Buffer(b) => b.bytes != 0 && b.bytes <= caps.max_buffer_bytes,
    }
}

#[cold]
#[inline(never)]
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
