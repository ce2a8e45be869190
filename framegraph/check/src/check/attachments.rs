//! Compares the attachments of a step with its passes: ranges, roles, slots, order, size, overlap and limits.

use super::finding::Rule;
use super::resolves;
use super::rule_input::{RuleInput, layers_of};
use framegraph::access::AccessKind;
use framegraph::caps::Caps;
use framegraph::format::Format;
use framegraph::id::StepId;
use framegraph::plan::{Join, Role};
use framegraph::resolve::ResolveMode;
use framegraph::resource::Dimension;

/// Examines the attachments of every step.
pub(super) fn attachments(ctx: &RuleInput<'_>) {
    for step in ctx.plan.step_ids() {
        if ctx.is_raster(step) {
            declared(ctx, step);
            pairs(ctx, step);
            resolves::resolves(ctx, step);
            limits(ctx, step);
        } else {
            let none = ctx.plan.attachments_of(step).is_empty();
            ctx.report.require(none, Rule::Attachments, step, "it has attachments, but draws nothing");
        }
        sizes(ctx, step);
    }
}

/// Checks that each attachment access has an attachment in its slot, and each attachment an access. Depth must be
/// read-only if and only if no pass writes it.
fn declared(ctx: &RuleInput<'_>, step: StepId) {
    let start = ctx.step(step).attachments.start as usize;
    let rows = ctx.plan.attachments_of(step);
    let (mut used, mut written) = (vec![false; rows.len()], vec![false; rows.len()]);
    let mut slots: Vec<(usize, u8)> = Vec::new();
    let running = ctx.plan.passes_of(step).iter().filter(|m| m.join != Join::Inlined);
    for (member, touch) in running.flat_map(|m| ctx.planned_accesses(*m).map(move |t| (m, t))) {
        let kind = touch.access.kind;
        if !kind.is_attachment() {
            continue;
        }
        let place = (step, member.pass, touch.resource);
        let Some((at, attachment)) = ctx.attachment(step, kind, touch.resource, touch.range) else {
            let why = format_args!("declared as `{}`, but not attached as such", kind.word());
            ctx.report.violation(Rule::Attachments, place, why);
            continue;
        };
        let slices = ctx.texture(touch.resource).filter(|t| t.dimension == Dimension::D3);
        let flat = touch.range.slice || slices.is_none_or(|t| t.slices(attachment.mip.into()) == 1);
        ctx.report.require(flat, Rule::Attachments, place, "an attachment has several slices, but only one is drawn");
        used[at - start] = true;
        written[at - start] |= touch.access.mode.writes();
        if let Role::Color(slot) = attachment.role {
            let expected = place_color(ctx, &mut slots, at, touch.access.slot);
            ctx.report.equal(Some(slot), expected, Rule::Attachments, place, "its slot");
        }
    }
    for (index, attachment) in rows.iter().enumerate() {
        let place = (step, attachment.resource);
        ctx.report.require(used[index], Rule::Attachments, place, "attached, but no pass declares it");
        let right = (attachment.role == Role::DepthReadOnly) != written[index];
        ctx.report.require(
            right,
            Rule::Attachments,
            place,
            "it must be attached read-only if and only if no pass writes it",
        );
    }
}

/// Returns the slot of a color attachment: the one its first pass requests, or the lowest free one if that is in use
/// and the device maps slots. `None` if a pass would find it in another slot.
fn place_color(ctx: &RuleInput<'_>, slots: &mut Vec<(usize, u8)>, attachment: usize, wanted: u8) -> Option<u8> {
    let remaps = ctx.plan.caps().slot_mapping;
    if let Some((_, slot)) = slots.iter().find(|(at, _)| *at == attachment) {
        return Some(*slot).filter(|s| remaps || *s == wanted);
    }
    let taken = |slot: u8| slots.iter().any(|(_, s)| *s == slot);
    let slot = if taken(wanted) { (0..u8::MAX).find(|s| !taken(*s)).filter(|_| remaps)? } else { wanted };
    slots.push((attachment, slot));
    Some(slot)
}

/// Checks that attachments have different slots and ranges, and are ordered: colors by slot, depth, resolve targets.
fn pairs(ctx: &RuleInput<'_>, step: StepId) {
    let rows = ctx.plan.attachments_of(step);
    for pair in rows.windows(2) {
        let (a, b) = (pair[0].role, pair[1].role);
        ctx.report.require(rank(a) < rank(b), Rule::Attachments, step, format_args!("{a:?} is listed before {b:?}"));
    }
    for (index, a) in rows.iter().enumerate() {
        for b in &rows[..index] {
            let (x, y) = (layers_of(a), layers_of(b));
            let apart = a.resource != b.resource || a.mip != b.mip || x.end <= y.start || y.end <= x.start;
            let why = format_args!("attached twice, as {:?} and {:?}", a.role, b.role);
            ctx.report.require(apart, Rule::Attachments, (step, a.resource), why);
        }
    }
}

const fn rank(role: Role) -> (u8, u8) {
    match role {
        Role::Color(slot) => (0, slot),
        Role::Depth | Role::DepthReadOnly => (1, 0),
        Role::ResolveTarget(slot, _) => (2, slot),
        Role::ResolveDepth(_) => (3, 0),
    }
}

/// Checks that all attachments have the extent, layers and samples of the step. A resolve target has one sample.
fn sizes(ctx: &RuleInput<'_>, step: StepId) {
    let row = ctx.step(step);
    let own = (row.extent, row.layers, row.samples);
    let rows = ctx.plan.attachments_of(step);
    if rows.is_empty() {
        ctx.report.equal(own, ([0; 2], 0, 1), Rule::Attachments, step, "its shape without attachments");
    }
    for attachment in rows {
        let resource = attachment.resource;
        let mut found = ctx.texture(resource).map_or(([0; 2], 0, 1), |t| {
            (t.mip_extent(ctx.plan.frame(), attachment.mip.into()), attachment.layers.into(), t.samples)
        });
        if resolves::is_target(attachment.role) {
            let why = format_args!("a resolve from {} to {} samples", own.2, found.2);
            ctx.report.require(found.2 == 1 && own.2 > 1, Rule::Resolve, step, why);
            found.2 = own.2;
        }
        let place = (step, resource);
        ctx.report.equal(found, own, Rule::Attachments, place, "its extent, layers, samples");
        let format = ctx.format(resource);
        let drawable = format.is_some_and(|f| match attachment.role {
            Role::Color(_) => f.is_color_renderable(),
            Role::Depth | Role::DepthReadOnly => f.is_depth_stencil(),
            Role::ResolveTarget(_, ResolveMode::Average) => f.is_resolvable(),
            Role::ResolveTarget(..) => f.is_color_renderable(),
            Role::ResolveDepth(mode) => mode != ResolveMode::Average && f.has_depth() && !f.has_stencil(),
        });
        let why = format_args!("{format:?} cannot be {:?}", attachment.role);
        ctx.report.require(drawable, Rule::Attachments, place, why);
        if format.is_none_or(|f| f.planes() == 1) {
            let stencil = (attachment.stencil_load, attachment.stencil_store);
            let expected = (attachment.load, attachment.store);
            let what = "the stencil ops of a format with one plane";
            ctx.report.equal(stencil, expected, Rule::Attachments, place, what);
        }
    }
}

/// Number and size of color attachments.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Weight {
    pub count: u32,
    /// Bytes per sample in the tile.
    pub bytes: u32,
    /// Bytes per sample where each attachment starts at a multiple of its component, as WebGPU counts them.
    pub aligned: u32,
}

impl Weight {
    /// Adds up color attachments, ordered by slot.
    pub fn of(formats: impl Iterator<Item = Format>) -> Self {
        let mut sum = Self::default();
        for format in formats {
            let component = format.tile_component_bytes();
            sum.aligned = sum.aligned.div_ceil(component) * component + format.tile_bytes();
            (sum.count, sum.bytes) = (sum.count + 1, sum.bytes + format.tile_bytes());
        }
        sum
    }

    /// Returns `true` if the attachments fit the device's limits on color attachments.
    pub fn fits(self, caps: &Caps) -> bool {
        self.count <= u32::from(caps.max_color_attachments) && self.aligned <= caps.max_color_bytes_per_sample
    }
}

/// Checks the limits on color attachments and tile memory.
///
/// If same-pixel reads stay in the tile, the attachment limit applies to each pass, and the tile is shared. A single
/// pass may exceed the tile memory, because it cannot be split.
fn limits(ctx: &RuleInput<'_>, step: StepId) {
    let caps = ctx.plan.caps();
    let colors = ctx.plan.attachments_of(step).iter().filter(|a| matches!(a.role, Role::Color(_)));
    let all = Weight::of(colors.filter_map(|a| ctx.format(a.resource)));
    let mut alone = 0;
    for &member in ctx.plan.passes_of(step) {
        let drawn = ctx.planned_accesses(member).filter(|t| t.access.kind == AccessKind::Color && !t.in_shader);
        let mut drawn: Vec<_> = drawn.map(|t| (t.access.slot, t.resource)).collect();
        drawn.sort_by_key(|(slot, _)| *slot);
        let own = Weight::of(drawn.into_iter().filter_map(|(_, resource)| ctx.format(resource)));
        alone = own.bytes.max(alone);
        let why = format_args!("{} color attachments of {} bytes per sample", own.count, own.aligned);
        ctx.report.require(own.fits(caps), Rule::Limits, (step, member.pass), why);
    }
    let Weight { count, bytes, aligned } = all;
    let why = format_args!("{count} color attachments of {aligned} bytes per sample");
    ctx.report.require(caps.same_pixel || all.fits(caps), Rule::Limits, step, why);
    let tile = caps.tile_bytes_per_pixel;
    let needed = bytes * u32::from(ctx.step(step).samples);
    let why = format_args!("{needed} bytes per pixel in the tile, the device has {tile}");
    ctx.report.require(tile == 0 || needed <= tile || bytes <= alone, Rule::Limits, step, why);
}
