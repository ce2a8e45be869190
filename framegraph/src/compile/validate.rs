//! Phase 1: everything that is wrong with the graph, all of it at once.
//!
//! What a single call can see was refused when it was made; this phase sees the whole: contents that nobody wrote, shapes
//! that the frame size or the device rules out, attachments that do not fit each other.

mod attachments;

use super::error::{CompileError, CompileReason};
use super::need::Need;
use super::parts::Parts;
use crate::access::{Access, Range};
use crate::caps::Caps;
use crate::format::Format;
use crate::graph::{Graph, PassKind};
use crate::id::{PassId, ResourceId};
use crate::resource::{Entry, Exit, Kind, TextureDesc};

/// Appends every error of `graph` to `errors`; `defined` is scratch (one flag a part).
pub(crate) fn validate(
    graph: &Graph,
    caps: &Caps,
    frame: [u32; 2],
    parts: &Parts,
    defined: &mut Vec<bool>,
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
    contents(graph, parts, defined, errors);
    for (index, pass) in graph.passes.iter().enumerate() {
        if pass.kind == PassKind::Raster {
            attachments::attachments(graph, caps, frame, PassId::at(index), errors);
        }
    }
    unreadable(graph, errors);
}

/// Shapes that nothing can have, or not this device. Runs before parts are numbered, since it bounds their number.
pub(crate) fn shapes(graph: &Graph, caps: &Caps, frame: [u32; 2], errors: &mut Vec<CompileError>) {
    for (index, row) in graph.resources.iter().enumerate() {
        let problem = match &row.desc {
            crate::resource::Desc::Texture(t) => texture_problem(t, caps, frame, row.kind),
            crate::resource::Desc::Buffer(b) if b.bytes == 0 => {
                Some(("a buffer of 0 bytes".to_owned(), SIZE))
            }
            crate::resource::Desc::Buffer(b) if b.bytes > caps.max_buffer_bytes => Some((
                format!(
                    "{} bytes, the device allows {}",
                    b.bytes, caps.max_buffer_bytes
                ),
                LIMIT,
            )),
            crate::resource::Desc::Buffer(_) => None,
        };
        if let Some((detail, hint)) = problem {
            let reason = CompileReason::Shape { detail, hint };
            errors.push(error(graph, reason, PassId::NONE, ResourceId::at(index)));
        }
    }
}

const SIZE: &str = "give it at least one texel, layer and sample, or one byte";
const LIMIT: &str = "make it smaller, or choose another device";
const MULTISAMPLED: &str = "a multisampled texture has one level and two dimensions";

#[inline]
fn texture_problem(
    t: &TextureDesc,
    caps: &Caps,
    frame: [u32; 2],
    kind: Kind,
) -> Option<(String, &'static str)> {
    let [w, h] = t.extent.resolve(frame);
    let side = w.max(h);
    if w == 0 || h == 0 || t.layers == 0 || t.samples == 0 {
        return Some((
            format!("{w}x{h} texels, {} layers, {} samples", t.layers, t.samples),
            SIZE,
        ));
    }
    let imported = matches!(kind, Kind::Imported { .. });
    if side > caps.max_texture_texels && !imported {
        return Some((
            format!(
                "{w}x{h} texels, the device allows {0}x{0}",
                caps.max_texture_texels
            ),
            LIMIT,
        ));
    }
    let full = side.ilog2() + 1;
    if t.mip_count(frame) > full {
        return Some((
            format!("{} levels, {w}x{h} texels have {full}", t.mips),
            "ask for fewer levels, or for all of them",
        ));
    }
    if u32::from(t.layers) > caps.max_texture_layers && !imported {
        return Some((
            format!(
                "{} layers, the device allows {}",
                t.layers, caps.max_texture_layers
            ),
            LIMIT,
        ));
    }
    if !t.samples.is_power_of_two() || (t.samples > caps.max_samples && !imported) {
        return Some((
            format!(
                "{} samples, the device allows 1 to {}",
                t.samples, caps.max_samples
            ),
            LIMIT,
        ));
    }
    if t.samples > 1 && (t.mip_count(frame) > 1 || t.dimension != crate::resource::Dimension::D2) {
        return Some((
            format!("{} samples with {} levels", t.samples, t.mip_count(frame)),
            MULTISAMPLED,
        ));
    }
    None
}

/// A forward sweep: what is used must have been written.
fn contents(graph: &Graph, parts: &Parts, defined: &mut Vec<bool>, errors: &mut Vec<CompileError>) {
    defined.clear();
    defined.resize(parts.total(), false);
    for (index, row) in graph.resources.iter().enumerate() {
        if row.kind.defined_on_entry() {
            defined[parts.all(ResourceId::at(index))].fill(true);
        }
    }
    for (index, pass) in graph.passes.iter().enumerate() {
        let accesses = pass.accesses.of(&graph.accesses);
        for access in accesses {
            if access.mode.needs_contents()
                && parts.any(defined, access.resource, access.range, |d| !d)
            {
                errors.push(unwritten(
                    graph,
                    access.kind.word(),
                    PassId::at(index),
                    access.resource,
                    access.range,
                ));
            }
            if !access.range.is_all() {
                out_of_range(graph, parts, PassId::at(index), access, errors);
            }
        }
        for access in accesses.iter().filter(|a| a.mode.writes()) {
            parts.fill(defined, access.resource, access.range, true);
        }
    }
    for export in &graph.exports {
        if parts.any(defined, export.resource, Range::ALL, |d| !d) {
            errors.push(unwritten(
                graph,
                "export",
                PassId::NONE,
                export.resource,
                Range::ALL,
            ));
        }
    }
}

/// Levels that exist in the declaration can be missing at this frame size, when the declaration asks for all of them.
fn out_of_range(
    graph: &Graph,
    parts: &Parts,
    pass: PassId,
    access: &Access,
    errors: &mut Vec<CompileError>,
) {
    let mut covered = 0;
    parts.runs(access.resource, access.range, |run| covered += run.len());
    if covered == 0 {
        let detail = format!(
            "level {} is asked of a texture that has fewer at this frame size",
            access.range.mip
        );
        errors.push(error(
            graph,
            CompileReason::OutOfRange { detail },
            pass,
            access.resource,
        ));
    }
}

#[cold]
fn unwritten(
    graph: &Graph,
    access: &'static str,
    pass: PassId,
    resource: ResourceId,
    range: Range,
) -> CompileError {
    let after = if pass.is_none() {
        graph.passes.len()
    } else {
        pass.index() + 1
    };
    let format = graph.resources[resource.index()]
        .desc
        .texture()
        .map_or(Format::R8Unorm, |t| t.format);
    let writes =
        |a: &Access| a.resource == resource && a.mode.writes() && a.range.overlaps(&range, format);
    let later = graph.passes[after..]
        .iter()
        .position(|p| p.accesses.of(&graph.accesses).iter().any(writes));
    let later_writer = later.map(|i| graph.pass_name(PassId::at(after + i)).to_owned());
    error(
        graph,
        CompileReason::ReadUnwritten {
            access,
            later_writer,
        },
        pass,
        resource,
    )
}

/// Writes into imports that are discarded on exit and that no pass reads.
fn unreadable(graph: &Graph, errors: &mut Vec<CompileError>) {
    let doomed = Kind::Imported {
        entry: Entry::Undefined,
        exit: Exit::Discard,
    };
    let doomed_too = Kind::Imported {
        entry: Entry::Defined,
        exit: Exit::Discard,
    };
    for (index, row) in graph.resources.iter().enumerate() {
        if row.kind != doomed && row.kind != doomed_too {
            continue;
        }
        let resource = ResourceId::at(index);
        let exported = graph.exports.iter().any(|e| e.resource == resource);
        // Depth that is tested while it is written is read by that; only whole writes can go unread.
        let read = graph
            .accesses
            .iter()
            .any(|a| a.resource == resource && (a.mode.needs_contents() || a.kind.is_depth()));
        let written = graph
            .accesses
            .iter()
            .position(|a| a.resource == resource && a.mode.writes());
        if let (Some(at), false, false) = (written, read, exported) {
            let access = graph.accesses[at].kind.word();
            let pass = graph.versions[graph.accesses[at].version.index()].writer;
            errors.push(error(
                graph,
                CompileReason::WriteUnreadable { access },
                pass,
                resource,
            ));
        }
    }
}

#[cold]
fn error(graph: &Graph, reason: CompileReason, pass: PassId, resource: ResourceId) -> CompileError {
    CompileError {
        reason,
        pass: pass
            .some()
            .map(|p| graph.pass_name(p).to_owned())
            .unwrap_or_default(),
        resource: resource
            .some()
            .map(|r| graph.resource_name(r).to_owned())
            .unwrap_or_default(),
        location: pass.some().map(|p| graph.passes[p.index()].location),
    }
}
