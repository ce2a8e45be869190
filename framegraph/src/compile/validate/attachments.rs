//! Validation of the attachments of a pass.

use crate::MAX_COLORS;
use crate::access::{Access, AccessKind, Range};
use crate::caps::Caps;
use crate::compile::error::{CompileError, CompileErrors, CompileReason};
use crate::compile::framebuffer::{Framebuffer, framebuffer_of};
use crate::compile::measure::Measured;
use crate::format::{Aspect, Format};
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use crate::resource::TextureDesc;

/// Checks the size, layers, samples, resolves and device limits of the attachments of a pass.
pub(super) fn attachments(
    graph: &Tables,
    caps: &Caps,
    measures: &[Measured],
    pass: PassId,
    framebuffer: Framebuffer,
    errors: &mut CompileErrors,
) {
    let accesses = graph.accesses_of(pass);
    let mut colors = [None; MAX_COLORS as usize];
    if framebuffer.layers() == 0 && !caps.empty_raster {
        return errors.push(|| CompileError::new(graph, CompileReason::NoAttachment, pass, ResourceId::NONE));
    }
    for access in accesses.iter().filter(|a| a.kind.is_attachment()) {
        let resource = access.resource;
        let Some(texture) = graph.resources[resource.index()].desc.texture() else {
            continue;
        };
        let own = framebuffer_of(graph, measures, access);
        if (own.extent(), own.layers()) != (framebuffer.extent(), framebuffer.layers()) {
            let flat = |s: Framebuffer| [s.extent()[0], s.extent()[1], s.layers()];
            let reason = CompileReason::Extent { expected: flat(framebuffer), found: flat(own) };
            errors.push(|| CompileError::new(graph, reason, pass, resource));
        }
        let expected = if access.kind == AccessKind::Resolve { 1 } else { framebuffer.samples() };
        if own.samples() != expected {
            let reason = CompileReason::Samples { expected, found: own.samples() };
            errors.push(|| CompileError::new(graph, reason, pass, resource));
        }
        if access.kind.is_depth() && !(caps.sample_read_only_depth && caps.separate_planes) {
            sampled_depth(graph, caps, pass, access, errors);
        }
        if access.kind == AccessKind::Color {
            colors[usize::from(access.slot)] = Some(texture.format);
        }
        if access.kind == AccessKind::Resolve {
            resolve(graph, accesses, pass, access, texture, errors);
        }
    }
    same_pixel(graph, measures, pass, framebuffer, errors);
    let formats = colors.iter().flatten().copied();
    // Slots that no attachment uses count too: WebGPU limits the highest slot.
    let slots = colors.iter().rposition(Option::is_some).map_or(0, |last| last as u32 + 1);
    let bytes = Format::tile_sum(formats);
    if slots > u32::from(caps.max_color_attachments) || bytes > caps.max_color_bytes_per_sample {
        let (max_colors, max_bytes) = (caps.max_color_attachments, caps.max_color_bytes_per_sample);
        let reason = CompileReason::Attachments { colors: slots, bytes, max_colors, max_bytes };
        errors.push(|| CompileError::new(graph, reason, pass, ResourceId::NONE));
    }
    if framebuffer.layers() > caps.max_attached_layers {
        let reason = CompileReason::AttachedLayers { layers: framebuffer.layers(), max: caps.max_attached_layers };
        let first = accesses.iter().find(|a| a.kind.is_attachment()).map_or(ResourceId::NONE, |a| a.resource);
        errors.push(|| CompileError::new(graph, reason, pass, first));
    }
}

fn resolve(
    graph: &Tables,
    accesses: &[Access],
    pass: PassId,
    access: &Access,
    into: &TextureDesc,
    errors: &mut CompileErrors,
) {
    let from = accesses.iter().find(|a| a.is_resolved_by(access));
    let texture = |a: &Access| graph.resources[a.resource.index()].desc.texture();
    let Some((samples, from)) = from.and_then(|a| Some((a, texture(a)?))) else {
        return;
    };
    if from.samples <= 1 {
        let reason = CompileReason::Samples { expected: 0, found: from.samples };
        errors.push(|| CompileError::new(graph, reason, pass, access.resource));
    }
    let expected = samples.range.view.unwrap_or(from.format).depth_alone();
    let found = access.range.view.unwrap_or(into.format);
    if expected != found {
        let reason = CompileReason::Format { expected, found };
        errors.push(|| CompileError::new(graph, reason, pass, access.resource));
    }
}

/// Reports a depth attachment that the pass also samples, for devices that do not support it. Planes that the device
/// cannot use separately count as one.
fn sampled_depth(graph: &Tables, caps: &Caps, pass: PassId, depth: &Access, errors: &mut CompileErrors) {
    let read_only = depth.kind == AccessKind::DepthReadOnly;
    if read_only && caps.sample_read_only_depth {
        return;
    }
    let Some(texture) = graph.resources[depth.resource.index()].desc.texture() else {
        return;
    };
    let planes = |range: Range| Range { aspect: Aspect::All, ..range };
    let own = planes(depth.range);
    let sampled = graph.accesses_of(pass).iter().find(|a| {
        !a.kind.is_attachment() && a.resource == depth.resource && own.overlaps(&planes(a.range), texture.format)
    });
    if let Some(sampled) = sampled {
        let reason = match read_only {
            true => CompileReason::SampledDepth { access: sampled.kind },
            false => CompileReason::Planes { access: sampled.kind },
        };
        errors.push(|| CompileError::new(graph, reason, pass, depth.resource));
    }
}

/// Reports same-pixel reads whose size differs from that of the attachments.
fn same_pixel(
    graph: &Tables,
    measures: &[Measured],
    pass: PassId,
    framebuffer: Framebuffer,
    errors: &mut CompileErrors,
) {
    let reads = graph.accesses_of(pass).iter();
    for access in reads.filter(|a| a.kind == AccessKind::SamePixel && framebuffer.layers() != 0) {
        let own = framebuffer_of(graph, measures, access);
        if own.extent() != framebuffer.extent() {
            let flat = |s: Framebuffer| [s.extent()[0], s.extent()[1], own.layers()];
            let reason = CompileReason::Extent { expected: flat(framebuffer), found: flat(own) };
            errors.push(|| CompileError::new(graph, reason, pass, access.resource));
        }
    }
}
