//! Descriptions of resources, placements and sizes, shared by all text forms.

use crate::access::{ByteRange, Range};
use crate::format::Aspect;
use crate::id::{ResourceId, StepId};
use crate::plan::{Join, Placement, Plan, Role};
use crate::resolve::ResolveMode;
use crate::resource::{Desc, Dimension, Kind};

/// Returns the text that `write` writes.
pub(crate) fn written(write: impl FnOnce(&mut String) -> std::fmt::Result) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut out);
    out
}

/// Describes where a resource is placed.
pub(crate) fn place(placement: Placement) -> String {
    match placement {
        Placement::Slot(slot) => format!("slot {}", slot.index()),
        Placement::Heap { offset } => format!("heap {offset}"),
        Placement::External => "imported".into(),
        other => other.word().into(),
    }
}

/// Describes why a pass is part of its step; empty for the first one.
pub(crate) const fn joined(join: Join) -> &'static str {
    match join {
        Join::First => "",
        Join::Attachments => "merged: attachments",
        Join::SamePixel => "merged: same pixel",
        Join::Inlined => "inlined",
        Join::Resolve => "full-screen resolve",
    }
}

/// Returns `true` if a resource uses memory of the heap or pool, which may be shared.
pub(crate) const fn is_shared(placement: Placement) -> bool {
    matches!(placement, Placement::Slot(_) | Placement::Heap { .. })
}

/// Returns the first and last step in which a resource occupies shared memory; `None` if it has none. History images in
/// a heap occupy it during the whole frame.
pub(crate) fn held(plan: &Plan, resource: ResourceId) -> Option<(StepId, StepId)> {
    let row = &plan.resources()[resource.index()];
    if !is_shared(row.placement) {
        return None;
    }
    let kind = plan.graph().resources()[resource.index()].kind;
    if matches!(kind, Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. }) {
        let last = plan.steps().len().checked_sub(1)?;
        return Some((StepId::at(0), StepId::at(last)));
    }
    Some((row.first.some()?, row.last.some()?))
}

/// Returns the offset of each resource in bytes, in the heap or in the concatenated slots; `None` for resources without
/// shared memory.
pub(crate) fn offsets(plan: &Plan) -> Vec<Option<u64>> {
    let mut starts = Vec::with_capacity(plan.slots().len());
    let mut end = 0u64;
    for slot in plan.slots() {
        starts.push(end);
        end = end.saturating_add(slot.bytes);
    }
    let place = |row: &crate::plan::Planned| match row.placement {
        Placement::Slot(slot) => Some(starts[slot.index()]),
        Placement::Heap { offset } => Some(offset),
        _ => None,
    };
    plan.resources().iter().map(place).collect()
}

/// Describes a role.
pub(crate) fn role_words(role: Role) -> String {
    match role {
        Role::Color(slot) => format!("color {slot}"),
        Role::Depth => "depth".into(),
        Role::DepthReadOnly => "depth read_only".into(),
        Role::ResolveTarget(slot, mode) => format!("resolve{} of color {slot}", mode_words(mode)),
        Role::ResolveDepth(mode) => format!("resolve{} of depth", mode_words(mode)),
    }
}

/// Describes a resolve mode; empty for the average.
fn mode_words(mode: ResolveMode) -> String {
    if mode == ResolveMode::Average { String::new() } else { format!(" by {}", mode.word()) }
}

/// Describes a resource in one short line.
pub(crate) fn shape(plan: &Plan, desc: &Desc, format: Option<crate::format::Format>) -> String {
    match desc {
        Desc::Buffer(b) => format!("buffer {} B", b.bytes(plan.frame())),
        Desc::Texture(t) => {
            let [w, h] = t.extent.texels(plan.frame());
            let mut out = format!("{w}x{h}");
            match t.dimension {
                Dimension::D3 => out += &format!("x{}", t.layers),
                Dimension::D2 if t.layers != 1 => out += &format!(" layers {}", t.layers),
                Dimension::D2 => {}
            }
            if t.mip_count(plan.frame()) != 1 {
                out += &format!(" mips {}", t.mip_count(plan.frame()));
            }
            if t.samples != 1 {
                out += &format!(" samples {}", t.samples);
            }
            format!("{out} {:?}", format.unwrap_or(t.format))
        }
    }
}

/// Describes the levels, layers, planes, view format and bytes of an access; empty for the whole resource.
pub(crate) fn part(range: &Range, bytes: Option<ByteRange>) -> String {
    let all = Range::ALL;
    let span = |what: &str, first: u32, count: u32, every: bool| match (every, count) {
        (true, _) if first == 0 => String::new(),
        (true, _) => format!(" {what}s {first}.."),
        (false, 1) => format!(" {what} {first}"),
        (false, count) => format!(" {what}s {first}..{}", first + count),
    };
    let mips = span("mip", range.mip.into(), range.mips.into(), range.mips == all.mips);
    let layers = span("layer", range.layer.into(), range.layers.into(), range.layers == all.layers);
    let aspect = match range.aspect {
        Aspect::All => "",
        Aspect::Depth => " depth",
        Aspect::Stencil => " stencil",
    };
    let view = range.view.map(|view| format!(" as {view:?}")).unwrap_or_default();
    let bytes = bytes.map(|b| format!(" bytes {}..{}", b.offset, b.end())).unwrap_or_default();
    format!("{mips}{layers}{aspect}{view}{bytes}")
}

/// Formats a number of bytes with a binary unit, such as `17.9 MiB`.
pub fn bytes(count: u64) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let mut value = count as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{count} B") } else { format!("{value:.1} {}", UNITS[unit]) }
}

/// Joins the names of the usages.
pub(crate) fn uses(usage: crate::access::Usage) -> String {
    usage.names().collect::<Vec<_>>().join("+")
}
