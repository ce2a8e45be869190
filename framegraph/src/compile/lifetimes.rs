//! Phases 5 and 7: from which step to which each resource is in use, and with which uses.
//!
//! Lifetimes are counted in steps, not passes: what two merged passes touch is live through their common step. An inlined
//! pass touches neither its same-pixel input nor its target; its producer draws into the target in its stead.

use super::group::in_tile;
use super::inline::{InlinedInto, effective};
use super::measure::Measures;
use crate::access::{AccessKind, Usage};
use crate::graph::{ExportKind, Tables};
use crate::id::{ResourceId, StepId};
use crate::plan::{Join, Placement, Planned, Step, StepPass};
use crate::resource::Kind;

/// Fills one row a resource: first and last step, uses, format and bytes. Exported transients are placed in memory of their
/// own, all other placements are decided later.
pub(crate) fn lifetimes(
    graph: &Tables,
    measures: &Measures,
    frame: [u32; 2],
    steps: &[Step],
    step_passes: &[StepPass],
    pass_steps: &[StepId],
    inlined_into: &InlinedInto,
    format_of: &[ResourceId],
    resources: &mut Vec<Planned>,
) {
    resources.clear();
    resources.extend(measures.rows.iter().map(|measured| Planned { bytes: measured.bytes, ..UNUSED }));
    for (at, member) in step_passes.iter().enumerate() {
        let step = pass_steps[member.pass.index()];
        let inlined = member.join == Join::Inlined;
        for access in graph.accesses_of(member.pass) {
            let usage = match access.kind {
                AccessKind::SamePixel | AccessKind::Color if inlined => continue,
                AccessKind::SamePixel => {
                    let earlier = &step_passes[steps[step.index()].passes.start as usize..at];
                    let inside = in_tile(graph, earlier, member.join, access, inlined_into);
                    if inside { Usage::INPUT_ATTACHMENT } else { Usage::SAMPLED }
                }
                kind => kind.usage(),
            };
            let row = &mut resources[effective(graph, inlined_into, access).0.index()];
            if row.first.is_none() {
                row.first = step;
            }
            row.last = step;
            row.usage = row.usage.union(usage);
        }
    }
    for export in &graph.exports {
        let row = &mut resources[export.resource.index()];
        if export.kind == ExportKind::Readback {
            row.usage = row.usage.union(Usage::COPY_SOURCE);
        }
        if graph.resources[export.resource.index()].kind == Kind::Transient {
            row.placement = Placement::Own;
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
}

const UNUSED: Planned = Planned {
    first: StepId::NONE,
    last: StepId::NONE,
    usage: Usage::NONE,
    format: None,
    bytes: 0,
    placement: Placement::Unused,
};
