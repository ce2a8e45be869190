//! Phases 5 and 7: lifetime and usage of each resource.
//!
//! Lifetimes are counted in steps: a resource accessed by a merged pass lives during the whole step. An inlined pass
//! accesses neither its same-pixel input nor its target; its producer draws into the target instead.

use super::measure::Measures;
use super::steps::StepView;
use crate::access::{Access, AccessKind, Usage};
use crate::graph::ExportKind;
use crate::id::{ResourceId, StepId};
use crate::plan::{Placement, Planned, Step, StepPass};
use crate::resource::Kind;

/// Fills one row per resource: first and last step, usage, format and size. Places exported transient resources in
/// memory of their own; other placements follow later.
#[inline(never)]
pub(crate) fn lifetimes(
    view: StepView<'_>,
    steps: &[Step],
    measures: &Measures,
    frame: [u32; 2],
    format_of: &[ResourceId],
    resources: &mut Vec<Planned>,
) {
    let (graph, as_declared) = (view.graph, view.inlined_into.is_empty());
    resources.clear();
    resources.extend(measures.rows.iter().map(|measured| Planned { bytes: measured.bytes, ..UNUSED }));
    let (rows, passes, accesses) = (&mut resources[..], graph.passes(), graph.accesses());
    for (index, step) in steps.iter().enumerate() {
        let step_id = StepId::unchecked(index);
        for member in step.passes.of(view.step_passes) {
            for access in passes[member.pass.index()].accesses.of(accesses) {
                if as_declared && access.kind != AccessKind::SamePixel && access.range.view.is_none() {
                    rows[access.resource.index()].touch(step_id, access.kind.usage());
                } else {
                    touch_unusual(view, (step_id, step), *member, access, rows);
                }
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

/// Records an access with a special case: inlining, same-pixel reads or a view in another format.
#[inline(never)]
fn touch_unusual(
    view: StepView<'_>,
    (step_id, step): (StepId, &Step),
    member: StepPass,
    access: &Access,
    rows: &mut [Planned],
) {
    let members = view.of(step);
    if members.replaces(member, access) {
        return;
    }
    let in_tile = || members.passes.iter().position(|m| *m == member).is_some_and(|at| members.in_tile(at, access));
    let sampled = access.kind == AccessKind::SamePixel && !in_tile();
    let usage = if sampled { Usage::SAMPLED } else { access.kind.usage() };
    let row = &mut rows[members.resource_range(access).0.index()];
    row.touch(step_id, usage);
    row.srgb_views |= access.range.view.is_some();
}

impl Planned {
    /// Records an access of the latest step so far.
    #[inline(always)]
    fn touch(&mut self, step: StepId, usage: Usage) {
        self.first = self.first.min(step); // `NONE` is the largest id
        self.last = step;
        self.usage = self.usage.union(usage);
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
