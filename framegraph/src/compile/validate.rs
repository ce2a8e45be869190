//! Phase 1: everything that is wrong with the graph, all of it at once.
//!
//! What a single call can see was refused when it was made; this phase sees the whole: contents that nobody wrote and
//! attachments that do not fit each other. Shapes were judged when they were measured.

mod attachments;

use super::error::{CompileError, CompileReason};
use super::group::{NO_SHAPE, Shape, shape_of_pass};
use super::measure::Measures;
use super::need::Need;
use super::parts::Parts;
use crate::access::{Access, ClearValue, Mode, Range};
use crate::caps::Caps;
use crate::format::Format;
use crate::graph::{Graph, PassKind};
use crate::id::{PassId, ResourceId};
use crate::resource::{Exit, Kind};

/// Appends every error of `graph` to `errors`, and fills `shapes`: what the attachments of each raster pass share.
/// `defined` is scratch (one flag a part).
pub(crate) fn validate(
    graph: &Graph,
    caps: &Caps,
    parts: &Parts,
    measures: &Measures,
    defined: &mut Vec<bool>,
    shapes: &mut Vec<Shape>,
    errors: &mut Vec<CompileError>,
) {
    if graph.passes.len() > Need::MAX_PASSES {
        return errors.push(CompileError {
            reason: CompileReason::TooManyPasses,
            pass: String::new(),
            resource: String::new(),
            location: None,
        });
    }
    if graph.doubts {
        contents(graph, parts, measures, defined, errors);
    }
    shapes.clear();
    shapes.resize(graph.passes.len(), NO_SHAPE);
    let rows = graph.passes.iter().zip(&graph.sole_colors).zip(shapes);
    for (index, ((pass, sole), shape)) in rows.enumerate() {
        if let Some(sole) = sole.some() {
            let color = &graph.accesses[sole.index()];
            if is_plain(graph, caps, color) {
                shape.extent = measures.rows[color.resource.index()].extent;
                shape.layers = 1;
                shape.samples = samples(graph, color.resource);
                continue;
            }
        }
        if pass.kind == PassKind::Raster {
            *shape = shape_of_pass(graph, &measures.rows, pass.accesses.of(&graph.accesses));
            attachments::attachments(graph, caps, &measures.rows, PassId::at(index), *shape, errors);
        }
    }
    unreadable(graph, measures, defined, errors);
}

/// A forward sweep: what is used must have been written.
fn contents(
    graph: &Graph,
    parts: &Parts,
    measures: &Measures,
    defined: &mut Vec<bool>,
    errors: &mut Vec<CompileError>,
) {
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
                errors.push(unwritten(graph, access.kind.word(), PassId::at(index), access.resource, access.range));
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
            errors.push(unwritten(graph, "export", PassId::NONE, export.resource, Range::ALL));
        }
    }
}

/// Levels that exist in the declaration can be missing at this frame size, when the declaration asks for all of them.
fn out_of_range(graph: &Graph, parts: &Parts, pass: PassId, access: &Access, errors: &mut Vec<CompileError>) {
    let mut covered = 0;
    parts.runs(access.resource, access.range, |run| covered += run.len());
    if covered == 0 {
        let detail = format!("level {} is asked of a texture that has fewer at this frame size", access.range.mip);
        errors.push(error(graph, CompileReason::OutOfRange { detail }, pass, access.resource));
    }
}

#[cold]
fn unwritten(graph: &Graph, access: &'static str, pass: PassId, resource: ResourceId, range: Range) -> CompileError {
    let after = if pass.is_none() { graph.passes.len() } else { pass.index() + 1 };
    let format = graph.resources[resource.index()].desc.texture().map_or(Format::R8Unorm, |t| t.format);
    let writes = |a: &Access| a.resource == resource && a.mode.writes() && a.range.overlaps(&range, format);
    let later = graph.passes[after..].iter().position(|p| p.accesses.of(&graph.accesses).iter().any(writes));
    let later_writer = later.map(|i| graph.pass_name(PassId::at(after + i)).to_owned());
    error(graph, CompileReason::ReadUnwritten { access, later_writer }, pass, resource)
}

/// Writes into imports that are discarded on exit and that no pass reads; `read` is scratch (one flag a resource).
fn unreadable(graph: &Graph, measures: &Measures, read: &mut Vec<bool>, errors: &mut Vec<CompileError>) {
    let doomed = |r: &&ResourceId| {
        let exit = Exit::Discard;
        matches!(graph.resources[r.index()].kind, Kind::Imported { exit: e, .. } if e == exit)
    };
    if !measures.outside.iter().any(|r| doomed(&r)) {
        return;
    }
    read.clear();
    read.resize(graph.resources.len(), false);
    for export in &graph.exports {
        read[export.resource.index()] = true;
    }
    // Depth that is tested while it is written is read by that; only whole writes can go unread.
    for access in &graph.accesses {
        read[access.resource.index()] |= access.mode.needs_contents() || access.kind.is_depth();
    }
    for &resource in measures.outside.iter().filter(doomed) {
        if read[resource.index()] {
            continue;
        }
        let written = |a: &&Access| a.resource == resource && a.mode.writes();
        if let Some(access) = graph.accesses.iter().find(written) {
            let pass = graph.versions[access.version.index()].writer;
            let access = access.kind.word();
            let reason = CompileReason::WriteUnreadable { access };
            errors.push(error(graph, reason, pass, resource));
        }
    }
}

/// Whether the only attachment of a pass, the color attachment of a texture of one part, is without fault by a quick test.
#[inline]
fn is_plain(graph: &Graph, caps: &Caps, color: &Access) -> bool {
    let texture = graph.resources[color.resource.index()].desc.texture();
    let bytes = texture.map_or(u32::MAX, |t| t.format.tile_bytes());
    caps.max_color_attachments != 0
        && bytes <= caps.max_color_bytes_per_sample
        && (color.mode != Mode::Clear || matches!(graph.clears[color.clear as usize], ClearValue::Color(_)))
}

#[inline]
fn samples(graph: &Graph, resource: ResourceId) -> u8 {
    let texture = graph.resources[resource.index()].desc.texture();
    texture.map_or(1, |t| t.samples)
}

#[cold]
fn error(graph: &Graph, reason: CompileReason, pass: PassId, resource: ResourceId) -> CompileError {
    CompileError {
        reason,
        pass: pass.some().map(|p| graph.pass_name(p).to_owned()).unwrap_or_default(),
        resource: resource.some().map(|r| graph.resource_name(r).to_owned()).unwrap_or_default(),
        location: pass.some().map(|p| graph.passes[p.index()].location),
    }
}
