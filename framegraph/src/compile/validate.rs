//! Phase 1: validation of the whole graph. Reports all errors at once.
//!
//! Errors of single calls were reported by the calls, and errors of descriptors by the measuring phase. This phase
//! checks reads of undefined contents and combinations of attachments.

mod attachments;
mod clears;
mod device;

pub(crate) use device::Allowed;

use super::error::{CompileError, CompileErrors, CompileReason};
use super::framebuffer::framebuffer_of_pass;
use super::measure::Measures;
use super::parts::Parts;
use crate::access::{Access, AccessKind, Range};
use crate::caps::Caps;
use crate::format::Format;
use crate::graph::{PassFlags, PassKind, Tables};
use crate::id::{PassId, ResourceId};

/// Appends every error of `graph` to `errors`; `defined` is scratch memory with one flag per part, and `allowed` holds the
/// checks of the last device.
#[inline(never)]
pub(crate) fn validate(
    graph: &Tables,
    caps: &Caps,
    parts: &Parts,
    measures: &Measures,
    defined: &mut Vec<bool>,
    allowed: &mut Allowed,
    errors: &mut CompileErrors,
) {
    if graph.passes.len() >= PassId::NONE.index() {
        let reason = CompileReason::TooManyPasses;
        return errors.push(|| CompileError::new(graph, reason, PassId::NONE, ResourceId::NONE));
    }
    let mut textures = graph.aliases.iter().filter(|(a, _)| graph.resources[a.index()].desc.texture().is_some());
    if let (Some((import, _)), true) = (textures.next(), caps.explicit_barriers) {
        errors.push(|| CompileError::new(graph, CompileReason::Aliased, PassId::NONE, *import));
    }
    if graph.contents_uncertain {
        contents(graph, parts, measures, defined, errors);
    }
    let roomy = caps.max_color_attachments != 0 && caps.max_color_bytes_per_sample >= MAX_TILE_BYTES;
    allowed.prepare(caps);
    for (index, pass) in graph.passes.iter().enumerate() {
        if !allowed.clearly(graph, &measures.rows, pass) {
            device::accesses(graph, caps, &measures.rows, PassId::at(index), errors);
        }
        // Fast path: a pass with one color attachment with one part can only have a wrong clear value.
        let plain = roomy && !pass.sole_color.is_none();
        if !plain && pass.kind == PassKind::Raster {
            let framebuffer = framebuffer_of_pass(graph, &measures.rows, pass);
            attachments::attachments(graph, caps, &measures.rows, PassId::at(index), framebuffer, errors);
        }
        if pass.flags.has(PassFlags::CLEARS) {
            clears::clears(graph, caps, PassId::at(index), errors);
        }
    }
}

/// Maximum size in the tile over all formats, in bytes per sample.
const MAX_TILE_BYTES: u32 = {
    let (mut most, mut at) = (0, 0);
    while at < Format::ALL.len() {
        let bytes = Format::ALL[at].tile_bytes();
        most = if bytes > most { bytes } else { most };
        at += 1;
    }
    most
};

/// Forward sweep: reports uses of contents that no earlier pass wrote.
fn contents(graph: &Tables, parts: &Parts, measures: &Measures, defined: &mut Vec<bool>, errors: &mut CompileErrors) {
    defined.clear();
    defined.resize(parts.total(), false);
    for &resource in &measures.outside {
        if graph.resources[resource.index()].kind.defined_on_entry() {
            parts.fill(defined, resource, Range::ALL, true);
        }
    }
    for (index, pass) in graph.passes.iter().enumerate() {
        let accesses = pass.accesses.of(&graph.accesses);
        // Accesses of one pass do not conflict, so their order does not matter.
        for access in accesses {
            // A slice of a three-dimensional texture may be the first one that is written.
            if access.mode.needs_contents() && parts.any(defined, access.resource, access.range, |d| !d) {
                errors.push(|| unwritten(graph, Some(access.kind), PassId::at(index), access.resource, access.range));
            }
            if access.mode.writes() {
                parts.fill(defined, access.resource, access.range, true);
            }
            if !access.range.is_all() {
                out_of_range(graph, parts, PassId::at(index), access, errors);
            }
        }
    }
    for export in &graph.exports {
        if parts.any(defined, export.resource, Range::ALL, |d| !d) {
            errors.push(|| unwritten(graph, None, PassId::NONE, export.resource, Range::ALL));
        }
    }
}

/// Reports levels that do not exist at this frame size, for textures with a full mip chain.
fn out_of_range(graph: &Tables, parts: &Parts, pass: PassId, access: &Access, errors: &mut CompileErrors) {
    let mut covered = 0;
    parts.runs(access.resource, access.range, |run| covered += run.len());
    if covered == 0 {
        let reason = CompileReason::OutOfRange { mip: access.range.mip };
        errors.push(|| CompileError::new(graph, reason, pass, access.resource));
    }
}

#[cold]
fn unwritten(
    graph: &Tables,
    access: Option<AccessKind>,
    pass: PassId,
    resource: ResourceId,
    range: Range,
) -> CompileError {
    let after = if pass.is_none() { graph.passes.len() } else { pass.index() + 1 };
    // Suggest only writers that do not need contents themselves.
    let fills = |a: &Access| a.mode.writes() && !a.mode.needs_contents();
    let writes = |a: &Access| a.resource == resource && fills(a) && graph.overlap(resource, &a.range, &range);
    let later = graph.passes[after..].iter().position(|p| p.accesses.of(&graph.accesses).iter().any(writes));
    let later_writer = later.map(|i| graph.pass_name(PassId::at(after + i)).to_owned());
    CompileError::new(graph, CompileReason::ReadUnwritten { access, later_writer }, pass, resource)
}
