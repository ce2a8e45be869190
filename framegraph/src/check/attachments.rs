//! The attachments of a step against what its passes declare: spots, roles, slots, order, one shape, no overlap, limits.

use super::case::Case;
use super::finding::{Findings, Place, Rule};
use crate::access::{Access, AccessKind};
use crate::format::Format;
use crate::graph::PassKind;
use crate::id::{ResourceId, StepId};
use crate::plan::{Attachment, Join, Role};

/// Examines the attachments of every step.
pub(super) fn attachments(case: &Case<'_>, findings: &mut Findings<'_>) {
    for step in case.plan.step_ids() {
        if case.is_raster(step) {
            declared(case, step, findings);
            pairs(case, step, findings);
            resolves(case, step, findings);
            limits(case, step, findings);
        } else {
            let none = case.plan.attachments_of(step).is_empty();
            findings
                .require(none, Rule::Attachments, Place::step(step), || "it draws nothing, and has attachments".into());
        }
        shape(case, step, findings);
    }
}

/// Each attachment access has its attachment in its slot, each attachment its access, and depth is read-only exactly
/// when no pass writes it.
fn declared(case: &Case<'_>, step: StepId, findings: &mut Findings<'_>) {
    let rows = case.plan.attachments_of(step);
    let start = case.plan.steps()[step.index()].attachments.start as usize;
    let mut used = vec![false; rows.len()];
    let mut written = vec![false; rows.len()];
    let mut slots: Vec<(usize, u8)> = Vec::new();
    for &member in case.plan.passes_of(step) {
        if member.join == Join::Inlined {
            continue;
        }
        for touch in case.touches(member).filter(|t| t.access.kind.is_attachment()) {
            let place = Place::step(step).and_pass(member.pass);
            let place = place.and_resource(touch.resource);
            let kind = touch.access.kind;
            let found = case.attachment(step, kind, touch.resource, touch.range);
            let Some((at, attachment)) = found else {
                let sentence = format!("declared as `{}`, and not attached so", kind.word());
                findings.violation(Rule::Attachments, place, sentence);
                continue;
            };
            used[at - start] = true;
            written[at - start] |= touch.access.mode.writes();
            if let Role::Color(slot) = attachment.role {
                let expected = place_color(case, &mut slots, at, touch.access.slot);
                findings.equal(Some(slot), expected, Rule::Attachments, place, "its slot");
            }
        }
    }
    for (index, attachment) in rows.iter().enumerate() {
        let place = Place::step(step).and_resource(attachment.resource);
        findings.require(used[index], Rule::Attachments, place, || "attached, and no pass declares it".into());
        let read_only = attachment.role == Role::DepthReadOnly;
        findings.require(read_only != written[index], Rule::Attachments, place, || {
            "attached read-only exactly when no pass writes it".into()
        });
    }
}

/// The slot of a color attachment: the one that its first pass asks for; where that is taken and shaders can be given
/// other slots (same-pixel reads stay in the tile), the lowest free one. None when a pass would find it elsewhere.
fn place_color(case: &Case<'_>, slots: &mut Vec<(usize, u8)>, attachment: usize, wanted: u8) -> Option<u8> {
    let remaps = case.plan.caps().same_pixel;
    if let Some((_, slot)) = slots.iter().find(|(at, _)| *at == attachment) {
        return Some(*slot).filter(|s| remaps || *s == wanted);
    }
    let taken = |slot: u8| slots.iter().any(|(_, s)| *s == slot);
    let slot = if taken(wanted) { (0..u8::MAX).find(|s| !taken(*s)).filter(|_| remaps)? } else { wanted };
    slots.push((attachment, slot));
    Some(slot)
}

/// No two attachments in one place or of one spot; colors by slot, then depth, then resolve targets.
fn pairs(case: &Case<'_>, step: StepId, findings: &mut Findings<'_>) {
    let rows = case.plan.attachments_of(step);
    for pair in rows.windows(2) {
        let ordered = rank(pair[0].role) < rank(pair[1].role);
        findings.require(ordered, Rule::Attachments, Place::step(step), || {
            format!("{:?} stands before {:?}", pair[0].role, pair[1].role)
        });
    }
    for (index, a) in rows.iter().enumerate() {
        for b in &rows[..index] {
            let layers = |x: &Attachment| (u32::from(x.layer), u32::from(x.layer) + u32::from(x.layers));
            let ((a0, a1), (b0, b1)) = (layers(a), layers(b));
            let apart = a.resource != b.resource || a.mip != b.mip || a1 <= b0 || b1 <= a0;
            let place = Place::step(step).and_resource(a.resource);
            findings.require(apart, Rule::Attachments, place, || {
                format!("attached twice, as {:?} and {:?}", a.role, b.role)
            });
        }
    }
}

const fn rank(role: Role) -> (u8, u8) {
    match role {
        Role::Color(slot) => (0, slot),
        Role::Depth | Role::DepthReadOnly => (1, 0),
        Role::Resolve(slot) => (2, slot),
    }
}

/// Each resolve target averages the multisampled attachment that its pass declares, in one format.
fn resolves(case: &Case<'_>, step: StepId, findings: &mut Findings<'_>) {
    for &member in case.plan.passes_of(step) {
        for touch in case.touches(member).filter(|t| t.access.kind == AccessKind::Resolve) {
            let place = Place::step(step).and_pass(member.pass);
            let place = place.and_resource(touch.resource);
            let target = case.attachment(step, AccessKind::Resolve, touch.resource, touch.range);
            let from = |a: &Access| a.kind == AccessKind::Color && a.slot == touch.access.slot;
            let averaged = case.touches(member).find(|t| from(t.access));
            let color = averaged.and_then(|t| case.attachment(step, AccessKind::Color, t.resource, t.range));
            let (Some((_, target)), Some((_, color))) = (target, color) else {
                findings.violation(Rule::Resolve, place, "it averages nothing that is attached");
                continue;
            };
            let same_slot = matches!((target.role, color.role), (Role::Resolve(a), Role::Color(b)) if a == b);
            findings.require(same_slot, Rule::Resolve, place, || {
                format!("{:?} does not average {:?}", target.role, color.role)
            });
            let formats = (case.format(target.resource), case.format(color.resource));
            findings.equal(formats.0, formats.1, Rule::Resolve, place, "its format");
        }
    }
}

/// Width and height, layers, samples.
type Shape = ([u32; 2], u32, u8);

/// The shape of an attachment.
fn shape_of(case: &Case<'_>, resource: ResourceId, mip: u8, layers: u32) -> Shape {
    let texture = case.graph.resources()[resource.index()].desc.texture();
    texture.map_or(([0; 2], 0, 1), |t| {
        let extent = t.mip_extent(case.plan.frame(), u32::from(mip));
        (extent, layers, t.samples)
    })
}

/// All attachments have the shape of the step; a resolve target has one sample.
fn shape(case: &Case<'_>, step: StepId, findings: &mut Findings<'_>) {
    let row = &case.plan.steps()[step.index()];
    let own: Shape = (row.extent, row.layers, row.samples);
    let rows = case.plan.attachments_of(step);
    let place = Place::step(step);
    if rows.is_empty() {
        let none = ([0; 2], 0, 1);
        findings.equal(own, none, Rule::Attachments, place, "its shape without attachments");
    }
    for attachment in rows {
        let resource = attachment.resource;
        let mut found = shape_of(case, resource, attachment.mip, attachment.layers.into());
        if let Role::Resolve(_) = attachment.role {
            findings.require(found.2 == 1 && own.2 > 1, Rule::Resolve, place, || {
                format!("a resolve from {} to {} samples", own.2, found.2)
            });
            found.2 = own.2;
        }
        let place = place.and_resource(resource);
        findings.equal(found, own, Rule::Attachments, place, "its extent, layers, samples");
        let format = case.format(resource);
        let drawable = format.is_some_and(|f| match attachment.role {
            Role::Color(_) => f.is_color_renderable(),
            Role::Depth | Role::DepthReadOnly => f.is_depth_stencil(),
            Role::Resolve(_) => f.is_resolvable(),
        });
        findings.require(drawable, Rule::Attachments, place, || format!("{format:?} cannot be {:?}", attachment.role));
        let one_plane = !format.is_some_and(|f| f.has_depth() && f.has_stencil());
        if one_plane {
            let stencil = (attachment.stencil_load, attachment.stencil_store);
            let expected = (attachment.load, attachment.store);
            let what = "the stencil ops of a format with one plane";
            findings.equal(stencil, expected, Rule::Attachments, place, what);
        }
    }
}

/// How many color attachments, and how many bytes a sample they take in the tile.
pub(super) fn weight(formats: impl Iterator<Item = Format>) -> (u32, u32) {
    formats.fold((0, 0), |(count, bytes), format| (count + 1, bytes + format.tile_bytes()))
}

/// The device's limits on color attachments and tile memory. Where same-pixel reads stay in the tile, each pass has the
/// number of attachments to itself, and all share the tile. A pass that alone takes more than the tile has cannot be
/// helped.
fn limits(case: &Case<'_>, step: StepId, findings: &mut Findings<'_>) {
    let caps = case.plan.caps();
    let row = &case.plan.steps()[step.index()];
    if row.kind != PassKind::Raster {
        return;
    }
    let place = Place::step(step);
    let colors = case.plan.attachments_of(step).iter().filter(|a| matches!(a.role, Role::Color(_)));
    let (count, bytes) = weight(colors.filter_map(|a| case.format(a.resource)));
    let fits = |(count, bytes): (u32, u32)| {
        count <= u32::from(caps.max_color_attachments) && bytes <= caps.max_color_bytes_per_sample
    };
    let mut alone = 0;
    for &member in case.plan.passes_of(step) {
        let drawn = case.touches(member).filter(|t| t.access.kind == AccessKind::Color && !t.in_shader);
        let formats = drawn.filter_map(|t| case.format(t.resource));
        let own = weight(formats);
        alone = own.1.max(alone);
        findings.require(fits(own), Rule::Limits, place.and_pass(member.pass), || {
            format!("{} color attachments of {} bytes a sample", own.0, own.1)
        });
    }
    findings.require(caps.same_pixel || fits((count, bytes)), Rule::Limits, place, || {
        format!("{count} color attachments of {bytes} bytes a sample")
    });
    let tile = caps.tile_bytes_per_pixel;
    let needed = bytes * u32::from(row.samples);
    findings.require(tile == 0 || needed <= tile || bytes <= alone, Rule::Limits, place, || {
        format!("{needed} bytes a pixel in the tile, the device has {tile}")
    });
}
