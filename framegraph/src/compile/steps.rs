//! What every phase after merging looks at: the passes of each step, and what inlining put in the place of what.

use crate::access::{Access, AccessKind, Range};
use crate::format::Aspect;
use crate::graph::Tables;
use crate::id::{AccessId, ResourceId};
use crate::plan::{Join, Step, StepPass};

/// One level and some layers of one resource.
pub(crate) type Spot = (ResourceId, Range);

/// For each resource, the color access that draws in its stead since its reader was inlined; none for most, and empty
/// when nothing was inlined.
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
    /// In the order in which they run.
    pub(crate) passes: &'a [StepPass],
    pub(crate) inlined_into: &'a InlinedInto,
}

impl<'a> StepView<'a> {
    /// The passes of `step`.
    #[inline]
    pub(crate) fn of(self, step: &Step) -> Members<'a> {
        let Self { graph, step_passes, inlined_into } = self;
        Members { graph, passes: step.passes.of(step_passes), inlined_into }
    }
}

impl<'a> Members<'a> {
    /// The accesses that the pass at `at` makes itself. An inlined pass reads no texel at the same pixel and draws
    /// nothing: its producer draws into its target.
    #[inline(always)]
    pub(crate) fn accesses(self, at: usize) -> impl Iterator<Item = &'a Access> {
        let member = self.passes[at];
        self.graph.accesses_of(member.pass).iter().filter(move |a| !self.replaces(member, a))
    }

    /// Whether a pass of the step does not make that access of its own.
    #[inline]
    pub(crate) const fn replaces(self, member: StepPass, access: &Access) -> bool {
        matches!(member.join, Join::Inlined) && matches!(access.kind, AccessKind::SamePixel | AccessKind::Color)
    }

    /// What an access touches in the plan.
    #[inline]
    pub(crate) fn touched(self, access: &Access) -> Spot {
        touched(self.graph, self.inlined_into, access)
    }

    /// Whether an access of the pass at `at` is a same-pixel read that finds its texel in the tile: earlier passes of
    /// the step attached its planes, and the pass came in for that.
    #[inline]
    pub(crate) fn in_tile(self, at: usize, access: &Access) -> bool {
        access.kind == AccessKind::SamePixel
            && self.passes[at].join == Join::SamePixel
            && self.attached_before(at, access)
    }

    #[inline(never)]
    fn attached_before(self, at: usize, access: &Access) -> bool {
        let spot = self.touched(access);
        let shows = |plane: Aspect| {
            let attaches = |a: &Access| {
                a.kind.is_attachment()
                    && a.kind != AccessKind::Resolve
                    && (a.range.aspect == Aspect::All || a.range.aspect == plane)
                    && same_spot(self.touched(a), spot)
            };
            self.passes[..at].iter().any(|m| self.graph.accesses_of(m.pass).iter().any(attaches))
        };
        match spot.1.aspect {
            Aspect::All => shows(Aspect::Depth) && shows(Aspect::Stencil),
            plane => shows(plane),
        }
    }
}

/// What an access touches in the plan: what it names, or what replaced that.
#[inline]
pub(crate) fn touched(graph: &Tables, inlined_into: &InlinedInto, access: &Access) -> Spot {
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

/// Whether the resource vanished because its reader was inlined.
#[inline]
pub(crate) fn is_inlined(inlined_into: &InlinedInto, resource: ResourceId) -> bool {
    !inlined_into.is_empty() && !inlined_into[resource.index()].is_none()
}

/// Two spots of one resource at one level and layer, seen through one format; planes may differ, since they are attached
/// together.
#[inline]
pub(crate) fn same_spot(a: Spot, b: Spot) -> bool {
    let layers = |r: Range| (r.layer, r.layers);
    a.0 == b.0 && a.1.mip == b.1.mip && layers(a.1) == layers(b.1) && a.1.view == b.1.view
}

/// Whether two spots of one resource at one level share a layer.
#[inline]
pub(crate) fn overlapping(a: Spot, b: Spot) -> bool {
    let end = |r: Range| u32::from(r.layer) + u32::from(r.layers);
    let apart = |a: Range, b: Range| u32::from(b.layer) >= end(a);
    a.0 == b.0 && a.1.mip == b.1.mip && !apart(a.1, b.1) && !apart(b.1, a.1)
}
