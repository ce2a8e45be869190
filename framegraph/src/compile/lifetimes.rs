//! Phases 5 and 7: from which step to which each resource is in use, and with which uses.
//!
//! Lifetimes are counted in steps, not passes: what two merged passes touch is live through their common step. An inlined
//! pass touches neither its same-pixel input nor its target; its producer draws into the target in its stead.

use super::group::in_tile;
use super::inline::{InlinedInto, effective};
use crate::access::{AccessKind, Usage};
use crate::graph::{ExportKind, Graph};
use crate::id::{ResourceId, StepId};
use crate::plan::{Join, Placement, Planned, Step, StepPass};

/// Fills one row a resource: first and last step, uses, format and bytes; placements are decided later.
pub(crate) fn lifetimes(
    graph: &Graph,
    frame: [u32; 2],
    steps: &[Step],
    step_passes: &[StepPass],
    inlined_into: &InlinedInto,
    format_of: &[ResourceId],
    resources: &mut Vec<Planned>,
) {
    resources.clear();
    resources.resize(graph.resources.len(), UNUSED);
    for (index, step) in steps.iter().enumerate() {
        let step_id = StepId::at(index);
        let members = step.passes.of(step_passes);
        for (index, member) in members.iter().enumerate() {
            let earlier = &members[..index];
            for access in graph.accesses_of(member.pass) {
                let vanishes = member.join == Join::Inlined
                    && matches!(access.kind, AccessKind::SamePixel | AccessKind::Color);
                if vanishes {
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
    for export in graph
        .exports
        .iter()
        .filter(|e| e.kind == ExportKind::Readback)
    {
        let row = &mut resources[export.resource.index()];
        row.usage = row.usage.union(Usage::COPY_SOURCE);
    }
    for (index, row) in resources.iter_mut().enumerate() {
        let desc = &graph.resources[index].desc;
        row.format = format_of[index]
            .some()
            .and_then(|r| graph.resources[r.index()].desc.texture())
            .map(|t| t.format);
        row.bytes = match (row.format, desc.texture()) {
            (Some(format), Some(texture)) => texture.format(format).bytes(frame),
            _ => desc.bytes(frame),
        };
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
