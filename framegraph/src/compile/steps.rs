//! Views of steps and their passes, for all phases after merging.

use crate::access::{Access, AccessKind, Range};
use crate::format::Aspect;
use crate::graph::Tables;
use crate::id::{AccessId, ResourceId};
use crate::plan::{Join, Step, StepPass};

/// One level and some layers of one resource.
pub(crate) type ResourceRange = (ResourceId, Range);

/// For each resource, the color access that replaces it because its reader was inlined; otherwise none. Empty if
/// nothing was inlined.
pub(crate) type InlinedInto = [AccessId];

/// The passes of all steps.
#[derive(Clone, Copy)]
pub(crate) struct StepView<'a> {
    pub(crate) graph: &'a Tables,
    /// The passes of all steps; each step owns a span.
    pub(crate) step_passes: &'a [StepPass],
    pub(crate) inlined_into: &'a InlinedInto,
}

/// The passes of one step.
#[derive(Clone, Copy)]
pub(crate) struct Members<'a> {
    pub(crate) graph: &'a Tables,
    /// In execution order.
    pub(crate) passes: &'a [StepPass],
    pub(crate) inlined_into: &'a InlinedInto,
}

impl<'a> StepView<'a> {
    /// Returns the passes of `step`.
    #[inline]
    pub(crate) fn of(self, step: &Step) -> Members<'a> {
        let Self { graph, step_passes, inlined_into } = self;
        Members { graph, passes: step.passes.of(step_passes), inlined_into }
    }
}

impl<'a> Members<'a> {
    /// The accesses that the pass at `at` makes itself. An inlined pass makes no same-pixel read and draws nothing; its
    /// producer draws into its target.
    #[inline(always)]
    pub(crate) fn accesses(self, at: usize) -> impl Iterator<Item = &'a Access> {
        let member = self.passes[at];
        self.graph.accesses_of(member.pass).iter().filter(move |a| !self.replaces(member, a))
    }

    /// Returns `true` if inlining replaces this access of a pass.
    #[inline]
    pub(crate) const fn replaces(self, member: StepPass, access: &Access) -> bool {
        matches!(member.join, Join::Inlined) && matches!(access.kind, AccessKind::SamePixel | AccessKind::Color)
    }

    /// Returns the resource and range that an access refers to in the plan.
    #[inline]
    pub(crate) fn resource_range(self, access: &Access) -> ResourceRange {
        range_in_plan(self.graph, self.inlined_into, access)
    }

    /// Returns `true` if an access of the pass at `at` is a same-pixel read from the tile. Earlier passes of the step
    /// must have attached its planes, and the pass must have joined because of it.
    #[inline]
    pub(crate) fn in_tile(self, at: usize, access: &Access) -> bool {
        access.kind == AccessKind::SamePixel
            && self.passes[at].join == Join::SamePixel
            && self.attached_before(at, access)
    }

    #[inline(never)]
    fn attached_before(self, at: usize, access: &Access) -> bool {
        let spot = self.resource_range(access);
        let shows = |plane: Aspect| {
            let attaches = |a: &Access| {
                a.kind.is_attachment()
                    && a.kind != AccessKind::Resolve
                    && (a.range.aspect == Aspect::All || a.range.aspect == plane)
                    && same_range(self.resource_range(a), spot)
            };
            self.passes[..at].iter().any(|m| self.graph.accesses_of(m.pass).iter().any(attaches))
        };
        match spot.1.aspect {
            Aspect::All => shows(Aspect::Depth) && shows(Aspect::Stencil),
            plane => shows(plane),
        }
    }
}

/// Returns the resource and range that an access refers to in the plan, after inlining.
#[inline]
pub(crate) fn range_in_plan(graph: &Tables, inlined_into: &InlinedInto, access: &Access) -> ResourceRange {
    let mut spot = (access.resource, access.range);
    if inlined_into.is_empty() {
        return spot;
    }
    while let Some(next) = inlined_into[spot.0.index()].some() {
        let next = &graph.accesses[next.index()];
        spot = (next.resource, next.range);
    }
    spot
}

/// Returns `true` if the resource does not exist because its reader was inlined.
#[inline]
pub(crate) fn is_inlined(inlined_into: &InlinedInto, resource: ResourceId) -> bool {
    !inlined_into.is_empty() && !inlined_into[resource.index()].is_none()
}

/// Returns `true` for the same resource, level, layers and view format. Planes may differ, because they are attached
/// together.
#[inline]
pub(crate) fn same_range(a: ResourceRange, b: ResourceRange) -> bool {
    let layers = |r: Range| (r.layer, r.layers);
    a.0 == b.0 && a.1.mip == b.1.mip && layers(a.1) == layers(b.1) && a.1.view == b.1.view
}

/// Returns `true` if both ranges share a layer of one level of one resource.
#[inline]
pub(crate) fn overlapping(a: ResourceRange, b: ResourceRange) -> bool {
    let end = |r: Range| u32::from(r.layer) + u32::from(r.layers);
    let apart = |a: Range, b: Range| u32::from(b.layer) >= end(a);
    a.0 == b.0 && a.1.mip == b.1.mip && !apart(a.1, b.1) && !apart(b.1, a.1)
}
