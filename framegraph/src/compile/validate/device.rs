//! Validation of accesses against the device: formats, bindings and buffer ranges.

use crate::access::{Access, AccessKind};
use crate::caps::{Caps, FormatCaps, FormatTable};
use crate::compile::bindings::{class, limits};
use crate::compile::error::{CompileError, CompileErrors, CompileReason};
use crate::compile::measure::Measured;
use crate::format::Format;
use crate::graph::{Declared, PassKind, Tables};
use crate::id::{PassId, ResourceId};

/// Limits of a device, prepared for one look per access. Kept between compilations.
#[derive(Debug)]
pub(crate) struct Allowed {
    /// The formats that `kinds` was made from.
    formats: Option<FormatTable>,
    /// By format; the last entry is for buffers. Kinds of access that need no further check, one bit each.
    kinds: [u16; 256],
    /// Number of accesses of a pass below which no limit of bindings can be exceeded.
    few: u32,
    /// Raster passes may write storage.
    raster_storage: bool,
}

/// Kinds of access to a buffer that the device does not limit.
const FREE: u16 = {
    use AccessKind::*;
    1 << CopySource as u16 | 1 << CopyTarget as u16
};

impl Default for Allowed {
    fn default() -> Self {
        Self { formats: None, kinds: [FREE; 256], few: 0, raster_storage: false }
    }
}

impl Allowed {
    /// Prepares the checks of a device.
    pub(super) fn prepare(&mut self, caps: &Caps) {
        if self.formats.as_ref() != Some(&caps.formats) {
            for format in Format::ALL {
                self.kinds[format as usize] = allowed(caps.formats.get(format));
            }
            self.formats = Some(caps.formats);
        }
        self.few = limits(caps).into_iter().map(|(_, max)| max).min().unwrap_or(0);
        self.raster_storage = caps.raster_storage;
    }

    /// Returns `true` if the device supports every access of a pass, as far as a look at each decides.
    #[inline]
    pub(super) fn clearly(&self, graph: &Tables, measures: &[Measured], pass: &Declared) -> bool {
        let accesses = pass.accesses.of(&graph.accesses);
        let storage = self.raster_storage || pass.kind != PassKind::Raster;
        accesses.len() <= self.few as usize
            && accesses.iter().all(|access| {
                let layout = measures[access.resource.index()].layout;
                let kind = self.kinds[usize::from(layout.format())] >> access.kind as u16 & 1;
                // Samples limit storage, and views have another format.
                kind != 0
                    && (storage || access.kind != AccessKind::StorageWrite)
                    && (layout.samples() == 1 || access.kind.is_attachment())
                    && access.range.view.is_none()
            })
    }
}

/// Returns the kinds of access that a format supports, one bit each.
const fn allowed(uses: FormatCaps) -> u16 {
    let (mut kinds, mut at) = (0, 0);
    while at < TEXTURE_KINDS.len() {
        if uses.contains(required(TEXTURE_KINDS[at])) {
            kinds |= 1 << TEXTURE_KINDS[at] as u16;
        }
        at += 1;
    }
    kinds
}

const TEXTURE_KINDS: [AccessKind; 10] = {
    use AccessKind::*;
    [Color, Depth, DepthReadOnly, Resolve, SamePixel, Sampled, StorageRead, StorageWrite, CopySource, CopyTarget]
};

/// Returns the use of a format that an access requires.
const fn required(kind: AccessKind) -> FormatCaps {
    match kind {
        AccessKind::Color | AccessKind::Depth | AccessKind::DepthReadOnly | AccessKind::Resolve => {
            FormatCaps::RENDERABLE
        }
        AccessKind::SamePixel | AccessKind::Sampled => FormatCaps::SAMPLED,
        AccessKind::StorageRead => FormatCaps::STORAGE_READ,
        AccessKind::StorageWrite => FormatCaps::STORAGE_WRITE,
        AccessKind::CopySource => FormatCaps::COPY_SOURCE,
        AccessKind::CopyTarget => FormatCaps::COPY_TARGET,
        AccessKind::Uniform | AccessKind::Vertex | AccessKind::Index | AccessKind::Indirect => FormatCaps::NONE,
    }
}

/// Reports every access of a pass that the device does not support.
#[inline(never)]
pub(super) fn accesses(graph: &Tables, caps: &Caps, measures: &[Measured], pass: PassId, errors: &mut CompileErrors) {
    let row = &graph.passes[pass.index()];
    let own = row.accesses.of(&graph.accesses);
    for access in own {
        let found = match graph.resources[access.resource.index()].desc.texture() {
            Some(texture) => texture_fault(caps, access, texture.format, texture.samples),
            None => buffer_fault(graph, caps, access, measures[access.resource.index()].bytes),
        };
        let raster_storage = access.kind == AccessKind::StorageWrite && row.kind == PassKind::Raster;
        let raster_storage = raster_storage && !caps.raster_storage;
        let found = found.or(raster_storage.then_some(CompileReason::RasterStorage { access: access.kind }));
        if let Some(reason) = found {
            errors.push(|| CompileError::new(graph, reason, pass, access.resource));
        }
    }
    bindings(graph, caps, row.kind, own, pass, errors);
}

fn texture_fault(caps: &Caps, access: &Access, format: Format, samples: u8) -> Option<CompileReason> {
    let (kind, needed) = (access.kind, required(access.kind));
    let used = [Some(format), access.range.view].into_iter().flatten();
    if let Some(format) = used.into_iter().find(|f| !caps.formats.get(*f).contains(needed)) {
        let (uses, instead) = (caps.formats.get(format), caps.similar_format(format, needed));
        return Some(CompileReason::FormatUse { access: kind, format, uses, instead });
    }
    let storage = matches!(kind, AccessKind::StorageRead | AccessKind::StorageWrite);
    if samples > 1 && storage && !caps.multisampled_storage {
        return Some(CompileReason::MultisampledStorage { access: kind, samples });
    }
    let view = access.range.view.filter(|_| !caps.srgb_views);
    view.map(|view| CompileReason::SrgbView { view })
}

/// Alignment of ranges of vertices, indices and indirect arguments, and of storage sizes, in bytes. Vulkan, Metal and WebGPU
/// agree in it.
const WORD: u64 = 4;

fn buffer_fault(graph: &Tables, caps: &Caps, access: &Access, size: u64) -> Option<CompileReason> {
    let kind = access.kind;
    let (offset, bytes) = graph.bytes_of(access).map_or((0, size), |range| (range.offset, range.bytes));
    let storage = matches!(kind, AccessKind::StorageRead | AccessKind::StorageWrite);
    let (alignment, max) = match kind {
        AccessKind::Uniform => (caps.uniform_alignment_bytes, caps.max_uniform_bytes),
        AccessKind::StorageRead | AccessKind::StorageWrite => (caps.storage_alignment_bytes, caps.max_storage_bytes),
        // Indices may have 4 bytes.
        AccessKind::Vertex | AccessKind::Index | AccessKind::Indirect => (WORD, u64::MAX),
        _ => return None,
    };
    if !offset.is_multiple_of(alignment.max(1)) {
        Some(CompileReason::BindingOffset { access: kind, offset, alignment })
    } else if bytes > max {
        Some(CompileReason::BindingBytes { access: kind, bytes, max })
    } else if storage && !bytes.is_multiple_of(WORD) {
        Some(CompileReason::BindingSize { access: kind, bytes, alignment: WORD })
    } else {
        None
    }
}

/// Reports passes that use more resources than their shader stages can bind. Raster passes have two stages. Only
/// fragment shaders can write storage on every device that has raster storage.
fn bindings(graph: &Tables, caps: &Caps, stages: PassKind, own: &[Access], pass: PassId, errors: &mut CompileErrors) {
    let stages = if stages == PassKind::Raster { 2 } else { 1 };
    for (kind, max) in limits(caps) {
        let is = |a: &Access, written: bool| class(graph, caps, a) == Some(kind) && (!written || a.mode.writes());
        let exceeded = [(false, max.saturating_mul(stages)), (true, max)].into_iter().find_map(|(written, max)| {
            let count = own.iter().filter(|a| is(a, written)).count() as u32;
            (count > max).then_some((written, count, max))
        });
        let Some((written, count, max)) = exceeded else { continue };
        let reason = CompileReason::Bindings { kind, count, max, written };
        // The first resource beyond the limit.
        let beyond = own.iter().filter(|a| is(a, written)).nth(max as usize).map_or(ResourceId::NONE, |a| a.resource);
        errors.push(|| CompileError::new(graph, reason, pass, beyond));
    }
}
