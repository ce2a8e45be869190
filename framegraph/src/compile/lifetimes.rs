//! Phases 5 and 7: from which step to which each resource is in use, and with which uses.
//!
//! Lifetimes are counted in steps, not passes: what two merged passes touch is live through their common step. An inlined
//! pass touches neither its same-pixel input nor its target; its producer draws into the target in its stead.

use super::measure::Measures;
use super::steps::StepView;
use crate::access::{AccessKind, Usage};
use crate::graph::ExportKind;
use crate::id::{ResourceId, StepId};
use crate::plan::{Placement, Planned, Step};
use crate::resource::Kind;

/// Fills one row a resource: first and last step, uses, format and bytes. Exported transients are placed in memory of their
/// own, all other placements are decided later.
#[inline(never)]
pub(crate) fn lifetimes(
    view: StepView<'_>,
    steps: &[Step],
    measures: &Measures,
    frame: [u32; 2],
    format_of: &[ResourceId],
    resources: &mut Vec<Planned>,
) {
    let graph = view.graph;
    resources.clear();
    resources.extend(measures.rows.iter().map(|measured| Planned { bytes: measured.bytes, ..UNUSED }));
    for (index, step) in steps.iter().enumerate() {
        let (step, members) = (StepId::unchecked(index), view.of(step));
        for at in 0..members.passes.len() {
            for access in members.accesses(at) {
                let row = &mut resources[members.touched(access).0.index()];
                row.first = row.first.min(step); // none is the largest
                row.last = step;
                let sampled = access.kind == AccessKind::SamePixel && !members.in_tile(at, access);
                let usage = if sampled { Usage::SAMPLED } else { access.kind.usage() };
                row.usage = row.usage.union(usage);
                row.srgb_views |= access.range.view.is_some();
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
    srgb_views: false,
    bytes: 0,
    placement: Placement::Unused,
};
