//! First and last step, uses, format, bytes and place of each resource, worked out anew from the steps.

use super::case::Case;
use super::finding::{Findings, Place, Rule, WasteKind};
use super::memory::reserved_bytes;
use crate::access::{AccessKind, Usage};
use crate::format::Format;
use crate::graph::ExportKind;
use crate::id::{ResourceId, StepId};
use crate::options::Alias;
use crate::plan::{LoadOp, Placement, Planned, StoreOp};
use crate::resource::{Desc, Dimension, Kind};

/// Examines every row of the plan's resources.
pub(super) fn lifetimes(case: &Case<'_>, findings: &mut Findings<'_>) {
    let expected = rows(case);
    for (resource, expected) in case.graph.resource_ids().zip(&expected) {
        let found = &case.plan.resources()[resource.index()];
        let place = Place::resource(resource);
        let life = (found.first, found.last);
        let expected_life = (expected.first, expected.last);
        findings.equal(life, expected_life, Rule::Lifetime, place, "its life");
        findings.equal(found.format, expected.format, Rule::Lifetime, place, "its format");
        findings.equal(found.bytes, expected.bytes, Rule::Lifetime, place, "its bytes");
        uses(found.usage, expected.usage, place, findings);
        placement(case, resource, expected, findings);
    }
}

/// Too few flags are wrong, too many are waste.
pub(super) fn uses(found: Usage, expected: Usage, place: Place, findings: &mut Findings<'_>) {
    let names = |u: Usage| u.names().collect::<Vec<_>>().join(", ");
    let missing = expected.without(found);
    findings.require(missing.is_empty(), Rule::Usage, place, || {
        format!("it is used as {}, and no flag says so", names(missing))
    });
    let extra = found.without(expected);
    if !extra.is_empty() {
        let sentence = format!("nobody uses it as {}", names(extra));
        findings.waste(WasteKind::Usage, place, sentence);
    }
}

/// The rows as the steps make them, placement aside.
fn rows(case: &Case<'_>) -> Vec<Planned> {
    let graph = case.graph;
    let mut rows: Vec<Planned> = graph
        .resource_ids()
        .zip(overrides(case))
        .map(|(resource, format)| Planned {
            first: StepId::NONE,
            last: StepId::NONE,
            usage: Usage::NONE,
            format,
            bytes: bytes(case, &graph.resources()[resource.index()].desc, format),
            placement: Placement::Unused,
        })
        .collect();
    for step in case.plan.step_ids() {
        for &member in case.plan.passes_of(step) {
            for touch in case.touches(member).filter(|t| !t.in_shader) {
                let row = &mut rows[touch.resource.index()];
                row.first = row.first.some().unwrap_or(step);
                row.last = step;
                let sampled = touch.access.kind == AccessKind::SamePixel && !case.in_tile(step, member, &touch);
                let usage = if sampled { Usage::SAMPLED } else { touch.access.kind.usage() };
                row.usage = row.usage.union(usage);
            }
        }
    }
    for export in graph.exports() {
        if export.kind == ExportKind::Readback {
            let row = &mut rows[export.resource.index()];
            row.usage = row.usage.union(Usage::COPY_SOURCE);
        }
    }
    rows
}

/// The formats that inlined epilogues give to the samples that are resolved into their targets.
fn overrides(case: &Case<'_>) -> Vec<Option<Format>> {
    let mut formats = vec![None; case.graph.resources().len()];
    for &member in case.plan.step_passes() {
        let accesses = case.graph.accesses_of(member.pass);
        for into in accesses.iter().filter(|a| a.kind == AccessKind::Resolve) {
            if case.replaced[into.resource.index()].is_none() {
                continue;
            }
            let (target, _) = case.effective(into.resource, into.range);
            let texture = case.graph.resources()[target.index()].desc.texture();
            let averaged = accesses.iter().find(|a| a.kind == AccessKind::Color && a.slot == into.slot);
            if let Some(color) = averaged {
                formats[color.resource.index()] = texture.map(|t| t.format);
            }
        }
    }
    formats
}

/// Bytes of all subresources, without padding.
fn bytes(case: &Case<'_>, desc: &Desc, format: Option<Format>) -> u64 {
    let texture = match desc {
        Desc::Buffer(buffer) => return buffer.bytes,
        Desc::Texture(texture) => texture,
    };
    let format = format.unwrap_or(texture.format);
    let (bw, bh) = format.block_texels();
    let frame = case.plan.frame();
    let mut sum = 0u128;
    for mip in 0..texture.mip_count(frame) {
        let [w, h] = texture.mip_extent(frame, mip);
        let blocks = u128::from(w.div_ceil(bw)) * u128::from(h.div_ceil(bh));
        let depth = match texture.dimension {
            Dimension::D2 => u128::from(texture.layers),
            // Huge sides have more levels than a depth has bits.
            Dimension::D3 => u128::from(u64::from(texture.layers) >> mip).max(1),
        };
        let samples = u128::from(texture.samples);
        sum += blocks * depth * samples * u128::from(format.block_bytes());
    }
    u64::try_from(sum).unwrap_or(u64::MAX)
}

/// Where the image of a history is that is `age` frames old: behind the current one, in the order of age.
fn image(case: &Case<'_>, current: ResourceId, age: u8) -> Placement {
    match case.plan.resources()[current.index()].placement {
        Placement::Heap { offset } => {
            let images = reserved_bytes(case.plan, current).saturating_mul(age.into());
            let offset = offset.saturating_add(images);
            Placement::Heap { offset }
        }
        other => other,
    }
}

/// Whether a resource may live where it does.
fn placement(case: &Case<'_>, resource: ResourceId, expected: &Planned, findings: &mut Findings<'_>) {
    let (caps, options) = (case.plan.caps(), case.plan.options());
    let found = case.plan.resources()[resource.index()].placement;
    let heap = options.alias == Alias::Heap && caps.placed;
    let touched = !expected.first.is_none();
    let replaced = case.replaced[resource.index()].is_some();
    let allowed = match case.graph.resources()[resource.index()].kind {
        Kind::Imported { .. } => found == Placement::External,
        Kind::HistoryCurrent { .. } if heap && touched => {
            matches!(found, Placement::Heap { .. })
        }
        Kind::HistoryCurrent { .. } => found == Placement::Own,
        Kind::HistoryPrevious { current, age } => found == image(case, current, age),
        Kind::Transient if case.exported[resource.index()] => found == Placement::Own,
        Kind::Transient => match found {
            Placement::Unused => !touched && !replaced,
            Placement::Inlined => replaced,
            Placement::Memoryless => touched && caps.memoryless && options.memoryless,
            Placement::Slot(_) => touched && !heap,
            Placement::Heap { .. } => touched && heap,
            Placement::External | Placement::Own => false,
        },
    };
    let place = Place::resource(resource);
    findings.require(allowed, Rule::Placement, place, || {
        format!("it is {found:?}, which its kind, its uses or the options rule out")
    });
    if let Placement::Heap { offset } = found {
        let texture = case.graph.resources()[resource.index()].desc.texture().is_some();
        let alignment = if texture { caps.texture_alignment_bytes } else { caps.buffer_alignment_bytes };
        findings.equal(offset % alignment.max(1), 0, Rule::Placement, place, "its misalignment");
    }
    if !matches!(found, Placement::Memoryless) && could_be_memoryless(case, resource, expected) {
        let sentence = format!("it never leaves the tile, and is {found:?}");
        findings.waste(WasteKind::Memory, place, sentence);
    }
}

/// Whether a resource is nothing but an attachment of one step that starts and ends there.
fn could_be_memoryless(case: &Case<'_>, resource: ResourceId, expected: &Planned) -> bool {
    let (caps, options) = (case.plan.caps(), case.plan.options());
    let row = &case.graph.resources()[resource.index()];
    let Some(texture) = row.desc.texture() else {
        return false;
    };
    let inside = Usage::ATTACHMENT.union(Usage::INPUT_ATTACHMENT);
    let one_part = texture.mips == 1 && texture.layers == 1 && texture.dimension == Dimension::D2;
    if !caps.memoryless
        || !options.memoryless
        || row.kind != Kind::Transient
        || case.exported[resource.index()]
        || expected.first.is_none()
        || expected.first != expected.last
        || !expected.usage.without(inside).is_empty()
        || !one_part
    {
        return false;
    }
    let rows = case.plan.attachments_of(expected.first);
    rows.iter().filter(|a| a.resource == resource).all(|a| {
        let plane = |load: LoadOp, store: StoreOp| {
            let dropped = load != LoadOp::Load && store == StoreOp::Discard;
            dropped || (load, store) == (LoadOp::DontCare, StoreOp::None)
        };
        plane(a.load, a.store)
            && plane(a.stencil_load, a.stencil_store)
            && !matches!(a.role, crate::plan::Role::Resolve(_))
    })
}
