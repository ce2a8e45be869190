//! Phase 1: everything that is wrong with the graph, all of it at once.
//!
//! What a single call can see was refused when it was made; this phase sees the whole: contents that no pass wrote and
//! attachments that do not fit each other. Shapes were judged when they were measured.

mod attachments;
mod clears;

use super::error::{CompileError, CompileErrors, CompileReason};
use super::framebuffer::framebuffer_of_pass;
use super::measure::Measures;
use super::parts::Parts;
use crate::access::{Access, AccessKind, Range};
use crate::caps::Caps;
use crate::format::Format;
use crate::graph::{PassFlags, PassKind, Tables};
use crate::id::{PassId, ResourceId};

/// Appends every error of `graph` to `errors`; `defined` is scratch (one flag a part).
#[inline(never)]
pub(crate) fn validate(
    graph: &Tables,
    caps: &Caps,
    parts: &Parts,
    measures: &Measures,
    defined: &mut Vec<bool>,
    errors: &mut CompileErrors,
) {
    if graph.passes.len() >= PassId::NONE.index() {
        let reason = CompileReason::TooManyPasses;
        return errors.push(|| CompileError::new(graph, reason, PassId::NONE, ResourceId::NONE));
    }
    if graph.contents_uncertain {
        contents(graph, parts, measures, defined, errors);
    }
    let roomy = caps.max_color_attachments != 0 && caps.max_color_bytes_per_sample >= MOST_TILE_BYTES;
    for (index, pass) in graph.passes.iter().enumerate() {
        // Of a pass with one color attachment, of a texture of one part, only the clear value can be wrong where it has room.
        let plain = roomy && !pass.sole_color.is_none();
        if !plain && pass.kind == PassKind::Raster {
            let framebuffer = framebuffer_of_pass(graph, &measures.rows, pass);
            attachments::attachments(graph, caps, &measures.rows, PassId::at(index), framebuffer, errors);
        }
        if pass.flags.has(PassFlags::CLEARS) {
            clears::clears(graph, PassId::at(index), errors);
        }
    }
}

/// What no format exceeds in a tile, in bytes per sample.
const MOST_TILE_BYTES: u32 = {
    let (mut most, mut at) = (0, 0);
    while at < Format::ALL.len() {
        let bytes = Format::ALL[at].tile_bytes();
        most = if bytes > most { bytes } else { most };
        at += 1;
    }
    most
};

/// A forward sweep: what is used must have been written.
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
        // No two accesses of one pass exclude each other, so reads and writes need no order.
        for access in accesses {
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

/// Levels that exist in the declaration can be missing at this frame size, when the declaration asks for all of them.
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
    // One that needs contents itself would be refused too.
    let fills = |a: &Access| a.mode.writes() && !a.mode.needs_contents();
    let writes = |a: &Access| a.resource == resource && fills(a) && graph.overlap(resource, &a.range, &range);
    let later = graph.passes[after..].iter().position(|p| p.accesses.of(&graph.accesses).iter().any(writes));
    let later_writer = later.map(|i| graph.pass_name(PassId::at(after + i)).to_owned());
    CompileError::new(graph, CompileReason::ReadUnwritten { access, later_writer }, pass, resource)
}
