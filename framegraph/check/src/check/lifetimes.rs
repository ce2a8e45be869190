//! Recomputes lifetime, usage, format, size and placement of each resource from the steps.

use super::finding::{Place, Rule, WasteKind};
use super::memory::{alignment, reserved_bytes};
use super::resolves::is_target;
use super::rule_input::RuleInput;
use framegraph::access::{AccessKind, Usage};
use framegraph::format::Format;
use framegraph::graph::ExportKind;
use framegraph::id::{ResourceId, StepId};
use framegraph::options::Alias;
use framegraph::plan::{LoadOp, Placement, Planned, StoreOp};
use framegraph::resource::{Desc, Dimension, Extent, Kind};

/// Examines every row of the plan's resources.
pub(super) fn lifetimes(ctx: &RuleInput<'_>) {
    let expected = rows(ctx);
    for (resource, expected) in ctx.graph.resource_ids().zip(&expected) {
        let found = ctx.planned(resource);
        let (life, expected_life) = ((found.first, found.last), (expected.first, expected.last));
        ctx.report.equal(life, expected_life, Rule::Lifetime, resource, "its life");
        ctx.report.equal(found.format, expected.format, Rule::Lifetime, resource, "its format");
        let views = (found.srgb_views, expected.srgb_views);
        ctx.report.equal(views.0, views.1, Rule::Lifetime, resource, "its sRGB views");
        ctx.report.equal(found.bytes, padded(ctx, resource, expected), Rule::Lifetime, resource, "its bytes");
        uses(ctx, found.usage, expected.usage, resource.into());
        placement(ctx, resource, expected);
    }
}

/// Reports missing flags as violations and superfluous ones as waste.
pub(super) fn uses(ctx: &RuleInput<'_>, found: Usage, expected: Usage, place: Place) {
    let names = |u: Usage| u.names().collect::<Vec<_>>().join(", ");
    let (missing, extra) = (expected.without(found), found.without(expected));
    if !missing.is_empty() {
        let why = format_args!("it is used as {}, but the flags are missing", names(missing));
        ctx.report.violation(Rule::Usage, place, why);
    }
    if !extra.is_empty() {
        ctx.report.waste(WasteKind::Usage, place, format_args!("no pass uses it as {}", names(extra)));
    }
}

/// Returns the rows that follow from the steps, without placements.
fn rows(ctx: &RuleInput<'_>) -> Vec<Planned> {
    let resources = ctx.graph.resources().iter().zip(replaced_formats(ctx));
    let unused = |(resource, format): (&framegraph::resource::Resource, _)| Planned {
        first: StepId::NONE,
        last: StepId::NONE,
        usage: Usage::NONE,
        format,
        srgb_views: false,
        bytes: bytes(ctx, &resource.desc, format),
        placement: Placement::Unused,
    };
    let mut rows: Vec<Planned> = resources.map(unused).collect();
    for step in ctx.plan.step_ids() {
        for (member, access) in ctx.accesses_by(ctx.plan.passes_of(step)) {
            let row = &mut rows[access.resource.index()];
            row.first = row.first.some().unwrap_or(step);
            row.last = step;
            let sampled = access.access.kind == AccessKind::SamePixel && !ctx.in_tile(step, member, &access);
            let usage = if sampled { Usage::SAMPLED } else { access.access.kind.usage() };
            row.usage = row.usage.union(usage);
            row.srgb_views |= access.access.range.view.is_some();
        }
    }
    for export in ctx.graph.exports().iter().filter(|e| e.kind == ExportKind::Readback) {
        let row = &mut rows[export.resource.index()];
        row.usage = row.usage.union(Usage::COPY_SOURCE);
    }
    rows
}

/// Returns the formats of multisampled attachments whose resolve targets were replaced by inlining.
fn replaced_formats(ctx: &RuleInput<'_>) -> Vec<Option<Format>> {
    let mut formats = vec![None; ctx.graph.resources().len()];
    for &member in ctx.plan.step_passes() {
        let accesses = ctx.graph.accesses_of(member.pass);
        let resolves =
            ctx.accesses_of(member.pass).filter(|(id, a)| a.kind == AccessKind::Resolve && !ctx.dropped[*id]);
        for (_, into) in resolves {
            let averaged = accesses.iter().find(|a| a.kind == AccessKind::Color && a.slot == into.slot);
            if let (Some(color), true) = (averaged, ctx.replaced[into.resource.index()].is_some()) {
                let (target, _) = ctx.effective(into.resource, into.range);
                formats[color.resource.index()] = ctx.texture(target).map(|t| t.format);
            }
        }
    }
    formats
}

/// Returns the size of a resource in its placement; in a heap, including padding by the driver.
fn padded(ctx: &RuleInput<'_>, resource: ResourceId, expected: &Planned) -> u64 {
    let desc = ctx.graph.resources()[resource.index()].desc.texture();
    let shared = ctx.kind(resource) == Kind::Transient && matches!(ctx.placement(resource), Placement::Heap { .. });
    let extent = |e: Extent| e.texels(ctx.plan.frame());
    let padding = desc.filter(|_| shared).and_then(|desc| {
        let own = desc.format(expected.format.unwrap_or(desc.format));
        let mut rows = ctx.plan.caps().padded.iter();
        rows.find(|(d, _)| d.extent(own.extent) == own && extent(d.extent) == extent(own.extent))
    });
    padding.map_or(expected.bytes, |(_, bytes)| expected.bytes.max(*bytes))
}

/// Returns the size of all subresources, without padding.
fn bytes(ctx: &RuleInput<'_>, desc: &Desc, format: Option<Format>) -> u64 {
    let texture = match desc {
        Desc::Buffer(buffer) => return buffer.bytes(ctx.plan.frame()),
        Desc::Texture(texture) => texture,
    };
    let format = format.unwrap_or(texture.format);
    let (bw, bh) = format.block_texels();
    let frame = ctx.plan.frame();
    let mut sum = 0u128;
    for mip in 0..texture.mip_count(frame) {
        let [w, h] = texture.mip_extent(frame, mip);
        let blocks = u128::from(w.div_ceil(bw)) * u128::from(h.div_ceil(bh));
        let depth = match texture.dimension {
            Dimension::D2 => u128::from(texture.layers),
            // Huge extents have more levels than the depth has bits.
            Dimension::D3 => u128::from(u64::from(texture.layers) >> mip).max(1),
        };
        sum += blocks * depth * u128::from(texture.samples) * u128::from(format.block_bytes());
    }
    u64::try_from(sum).unwrap_or(u64::MAX)
}

/// Returns the placement of the history image of this age: behind the current one, ordered by age.
fn image(ctx: &RuleInput<'_>, current: ResourceId, age: u8) -> Placement {
    match ctx.placement(current) {
        Placement::Heap { offset } => {
            let images = reserved_bytes(ctx.plan, current).saturating_mul(age.into());
            Placement::Heap { offset: offset.saturating_add(images) }
        }
        other => other,
    }
}

/// Checks the placement of a resource.
fn placement(ctx: &RuleInput<'_>, resource: ResourceId, expected: &Planned) {
    let (caps, options) = (ctx.plan.caps(), ctx.plan.options());
    let found = ctx.placement(resource);
    let heap = options.alias == Alias::Heap && caps.placed;
    let used = !expected.first.is_none();
    let replaced = ctx.replaced[resource.index()].is_some();
    let allowed = match ctx.kind(resource) {
        Kind::Imported { .. } => found == Placement::External,
        Kind::HistoryCurrent { .. } if heap && caps.placed_histories && used => {
            matches!(found, Placement::Heap { .. })
        }
        Kind::HistoryCurrent { .. } => found == Placement::Own,
        Kind::HistoryPrevious { current, age } => found == image(ctx, current, age),
        Kind::Transient if ctx.exported[resource.index()] => found == Placement::Own,
        Kind::Transient => match found {
            Placement::Unused => !used && !replaced,
            Placement::Inlined => replaced,
            Placement::Memoryless => used && caps.memoryless && options.memoryless && ctx.memoryless_saves(),
            Placement::Slot(_) => used && !heap,
            Placement::Heap { .. } => used && heap,
            Placement::External | Placement::Own => false,
        },
    };
    let why = format_args!("its placement {found:?} contradicts its kind, its uses or the options");
    ctx.report.require(allowed, Rule::Placement, resource, why);
    if let Placement::Heap { offset } = found {
        let rest = offset % alignment(ctx.plan, resource);
        ctx.report.equal(rest, 0, Rule::Placement, resource, "its misalignment");
    }
    if found != Placement::Memoryless && could_be_memoryless(ctx, resource, expected) {
        ctx.report.waste(
            WasteKind::Memory,
            resource,
            format_args!("it never leaves the tile, but its placement is {found:?}"),
        );
    }
}

/// Returns `true` if a resource is only an attachment of a single step, without load and store.
fn could_be_memoryless(ctx: &RuleInput<'_>, resource: ResourceId, expected: &Planned) -> bool {
    let inside = Usage::ATTACHMENT.union(Usage::INPUT_ATTACHMENT);
    let layers = |t: &framegraph::TextureDesc| t.layers == 1 || ctx.plan.caps().memoryless_layers;
    let one_part = |t: &framegraph::TextureDesc| t.mips == 1 && layers(t) && t.dimension == Dimension::D2;
    let dropped = |load: LoadOp, store: StoreOp| {
        load != LoadOp::Load && store == StoreOp::Discard || (load, store) == (LoadOp::DontCare, StoreOp::None)
    };
    ctx.plan.caps().memoryless
        && ctx.plan.options().memoryless
        && ctx.memoryless_saves()
        && ctx.texture(resource).is_some_and(one_part)
        && ctx.is_transient(resource)
        && !expected.first.is_none()
        && expected.first == expected.last
        && expected.usage.without(inside).is_empty()
        && (!expected.srgb_views || ctx.plan.caps().memoryless_views)
        && ctx.plan.attachments_of(expected.first).iter().filter(|a| a.resource == resource).all(|a| {
            let planes = dropped(a.load, a.store) && dropped(a.stencil_load, a.stencil_store);
            planes && !is_target(a.role)
        })
}
