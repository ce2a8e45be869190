//! Phases 5 and 7: from which step to which each resource is in use, and with which uses.
//!
//! Lifetimes are counted in steps, not passes: what two merged passes touch is live through their common step. An inlined
//! pass touches neither its same-pixel input nor its target; its producer draws into the target in its stead.

use super::cull::Seen;
use super::group::in_tile;
use super::inline::{InlinedInto, effective};
use super::measure::Measures;
use crate::access::{AccessKind, Usage};
use crate::graph::{ExportKind, Tables};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::{Join, Placement, Planned, Step, StepPass};
use crate::resource::Kind;

/// Fills one row a resource: first and last step, uses, format and bytes. Exported transients are placed in memory of their
/// own, all other placements are decided later.
#[inline(never)]
pub(crate) fn lifetimes(
    graph: &Tables,
    measures: &Measures,
    frame: [u32; 2],
    steps: &[Step],
    step_passes: &[StepPass],
    inlined_into: &InlinedInto,
    format_of: &[ResourceId],
    resources: &mut Vec<Planned>,
) {
    resources.clear();
    resources.extend(measures.rows.iter().map(|measured| Planned { bytes: measured.bytes, ..UNUSED }));
    for (index, step) in steps.iter().enumerate() {
        let step_id = StepId::at(index);
        let members = step.passes.of(step_passes);
        for (index, member) in members.iter().enumerate() {
            let earlier = &members[..index];
            let inlined = member.join == Join::Inlined;
            for access in graph.accesses_of(member.pass) {
                if inlined && matches!(access.kind, AccessKind::SamePixel | AccessKind::Color) {
                    continue;
                }
                let row = &mut resources[effective(graph, inlined_into, access).0.index()];
                if row.first.is_none() {
                    row.first = step_id;
                }
                row.last = step_id;
                let inside = || in_tile(graph, earlier, member.join, access, inlined_into);
                let usage = match access.kind {
                    AccessKind::SamePixel if !inside() => Usage::SAMPLED,
                    kind => kind.usage(),
                };
                row.usage = row.usage.union(usage);
            }
        }
    }
    for (index, like) in format_of.iter().enumerate().filter(|(_, r)| !r.is_none()) {
        let texture = |r: usize| graph.resources[r].desc.texture();
        let row = &mut resources[index];
        row.format = texture(like.index()).map(|t| t.format);
        if let (Some(format), Some(texture)) = (row.format, texture(index)) {
            row.bytes = texture.format(format).bytes(frame);
        }
    }
    outlive(graph, resources);
}

/// The same, from what culling found: where passes run as declared, nothing is inlined and nothing is read in the tile.
#[inline(never)]
pub(crate) fn lifetimes_as_declared(
    graph: &Tables,
    measures: &Measures,
    seen: &[Seen],
    pass_steps: &[StepId],
    resources: &mut Vec<Planned>,
) {
    let step_of = |pass: PassId| pass_steps.get(pass.index()).copied().unwrap_or(StepId::NONE);
    resources.clear();
    resources.extend(measures.rows.iter().zip(seen).map(|(measured, seen)| Planned {
        first: step_of(seen.first),
        last: step_of(seen.last),
        usage: seen.usage,
        bytes: measured.bytes,
        ..UNUSED
    }));
    outlive(graph, resources);
}

/// What exports say of lifetimes and uses.
fn outlive(graph: &Tables, resources: &mut [Planned]) {
    for export in &graph.exports {
        let row = &mut resources[export.resource.index()];
        if export.kind == ExportKind::Readback {
            row.usage = row.usage.union(Usage::COPY_SOURCE);
        }
        if graph.resources[export.resource.index()].kind == Kind::Transient {
            row.placement = Placement::Own;
        }
    }
}

const UNUSED: Planned = Planned {
    first: StepId::NONE,
    last: StepId::NONE,
    usage: Usage::NONE,
    format: None,
    bytes: 0,
    placement: Placement::Unused,
};
