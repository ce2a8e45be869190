//! One plan under examination: what all phases of the oracle look at.

use super::finding::{Findings, Place, Rule};
use super::reference::{Read, Reference};
use super::subresource::Subresources;
use crate::access::{Access, AccessKind, Range};
use crate::format::Format;
use crate::graph::{Graph, PassKind};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::{Attachment, Join, Plan, Role, StepPass};

/// A plan, its graph's reference semantics, and what inlining put in whose place.
pub(super) struct Case<'p> {
    pub(super) plan: &'p Plan,
    pub(super) graph: &'p Graph,
    pub(super) parts: Subresources,
    pub(super) reference: Reference,
    /// For each resource that an inlined pass reads at the same pixel: where that pass draws, and the pass.
    pub(super) replaced: Vec<Option<Replaced>>,
    /// Passes in the order in which they run.
    pub(super) order: Vec<PassId>,
    /// The place of each pass in `order`; none for culled passes.
    pub(super) position: Vec<Option<usize>>,
    /// Whether each resource is exported.
    pub(super) exported: Vec<bool>,
    /// The accesses that running passes make to each resource, in the order in which the passes run.
    pub(super) users: Vec<Vec<(PassId, &'p Access)>>,
}

/// What an inlined pass made of its input: its producers draw here instead.
#[derive(Clone, Copy, Debug)]
pub(super) struct Replaced {
    /// The inlined pass.
    pub(super) by: PassId,
    /// What it draws into.
    pub(super) target: ResourceId,
    /// Which part of it.
    pub(super) range: Range,
}

/// What one access of a running pass touches.
#[derive(Clone, Copy)]
pub(super) struct Touch<'p> {
    pub(super) access: &'p Access,
    /// Index of the access in the graph.
    pub(super) id: usize,
    /// What it touches in the plan: its own resource, or what replaced it.
    pub(super) resource: ResourceId,
    pub(super) range: Range,
    /// The access belongs to an inlined pass and is made by its producer's shader.
    pub(super) in_shader: bool,
}

impl<'p> Case<'p> {
    /// Takes a plan whose arrays fit each other apart.
    pub(super) fn new(plan: &'p Plan, findings: &mut Findings<'_>) -> Self {
        let graph = plan.graph();
        let parts = Subresources::of_graph(graph, plan.frame());
        let mut reference = Reference::of_graph(graph, &parts);
        let order: Vec<_> = plan.step_passes().iter().map(|m| m.pass).collect();
        let mut position = vec![None; graph.passes().len()];
        for (at, pass) in order.iter().enumerate() {
            position[pass.index()] = Some(at);
        }
        reference.settle(graph, &order);
        let mut exported = vec![false; graph.resources().len()];
        for export in graph.exports() {
            exported[export.resource.index()] = true;
        }
        let mut users = vec![Vec::new(); graph.resources().len()];
        for pass in &order {
            for access in graph.accesses_of(*pass) {
                users[access.resource.index()].push((*pass, access));
            }
        }
        let mut case = Self {
            plan,
            graph,
            users,
            parts,
            reference,
            replaced: vec![None; graph.resources().len()],
            order,
            position,
            exported,
        };
        case.replace(findings);
        case
    }

    /// Fills `replaced` from the inlined passes of the plan.
    fn replace(&mut self, findings: &mut Findings<'_>) {
        for step in self.plan.step_ids() {
            let inlined = |m: &&StepPass| m.join == Join::Inlined;
            for member in self.plan.passes_of(step).iter().filter(inlined) {
                let place = Place::step(step).and_pass(member.pass);
                let accesses = self.graph.accesses_of(member.pass);
                let input = only(accesses, |a| a.kind == AccessKind::SamePixel);
                let output = only(accesses, |a| a.mode.writes() || a.kind.is_attachment());
                let (Some(input), Some(output)) = (input, output) else {
                    let why = "an inlined pass has one same-pixel input and one output";
                    findings.violation(Rule::Inlining, place, why);
                    continue;
                };
                let chain = self.effective(output.resource, output.range);
                if output.kind != AccessKind::Color || chain.0 == input.resource {
                    let why = "an inlined pass draws into a color attachment that is not its input";
                    findings.violation(Rule::Inlining, place, why);
                    continue;
                }
                let row = &mut self.replaced[input.resource.index()];
                if row.is_some() {
                    let why = "two passes are inlined into the producer of one input";
                    findings.violation(Rule::Inlining, place, why);
                    continue;
                }
                *row = Some(Replaced { by: member.pass, target: output.resource, range: output.range });
            }
        }
    }

    /// What stands in the plan for a range of a resource: itself, or what replaced it, through any number of inlined
    /// passes. Replacements never form a circle, since none is added that would close one.
    pub(super) fn effective(&self, resource: ResourceId, range: Range) -> (ResourceId, Range) {
        let mut spot = (resource, range);
        while let Some(next) = self.replaced[spot.0.index()] {
            spot = (next.target, next.range);
        }
        spot
    }

    /// The accesses of a running pass with what they touch.
    pub(super) fn touches(&self, member: StepPass) -> impl Iterator<Item = Touch<'p>> {
        let ids = self.graph.passes()[member.pass.index()].accesses.range();
        let graph = self.graph;
        ids.map(move |id| {
            let access = &graph.accesses()[id];
            let (resource, range) = self.effective(access.resource, access.range);
            let drawn = matches!(access.kind, AccessKind::SamePixel | AccessKind::Color);
            Touch { access, id, resource, range, in_shader: member.join == Join::Inlined && drawn }
        })
    }

    /// The accesses of a pass with their indices in the graph.
    pub(super) fn accesses_of(&self, pass: PassId) -> impl Iterator<Item = (usize, &'p Access)> + use<'p> {
        self.graph.passes()[pass.index()].accesses.range().zip(self.graph.accesses_of(pass))
    }

    /// What an access reads, part by part, in the reference semantics.
    pub(super) fn reads(&self, access: usize) -> &[Read] {
        &self.reference.reads[self.reference.of_access[access].clone()]
    }

    /// The attachment of a step that shows a spot in the role that `kind` asks for.
    pub(super) fn attachment(
        &self,
        step: StepId,
        kind: AccessKind,
        resource: ResourceId,
        range: Range,
    ) -> Option<(usize, &'p Attachment)> {
        let (_, count) = self.parts.counts(resource);
        let layers = range.layer_range(count);
        let start = self.plan.steps()[step.index()].attachments.start as usize;
        let rows = self.plan.attachments_of(step).iter().enumerate();
        let mut found = rows.filter(|(_, a)| {
            let role = match kind {
                AccessKind::Color => matches!(a.role, Role::Color(_)),
                AccessKind::Depth => a.role == Role::Depth,
                AccessKind::DepthReadOnly => matches!(a.role, Role::Depth | Role::DepthReadOnly),
                AccessKind::Resolve => matches!(a.role, Role::Resolve(_)),
                _ => !matches!(a.role, Role::Resolve(_)),
            };
            role && a.resource == resource
                && a.mip == range.mip
                && u32::from(a.layer) == layers.start
                && u32::from(a.layers) == layers.end - layers.start
        });
        found.next().map(|(at, a)| (start + at, a))
    }

    /// Whether a same-pixel read of a pass finds its texels in the tile: an earlier pass of the step attached them, and
    /// the pass came in for that.
    pub(super) fn in_tile(&self, step: StepId, member: StepPass, touch: &Touch<'_>) -> bool {
        let members = self.plan.passes_of(step);
        let earlier = members.iter().position(|m| m.pass == member.pass);
        touch.access.kind == AccessKind::SamePixel
            && member.join == Join::SamePixel
            && self.shown_by(&members[..earlier.unwrap_or(0)], touch.resource, touch.range)
    }

    /// Whether one of some passes has a spot as color or depth attachment.
    pub(super) fn shown_by(&self, passes: &[StepPass], resource: ResourceId, range: Range) -> bool {
        let (_, count) = self.parts.counts(resource);
        let spot = |r: Range| (r.mip, r.layer_range(count));
        passes.iter().flat_map(|m| self.touches(*m)).any(|t| {
            t.access.kind.is_attachment()
                && t.access.kind != AccessKind::Resolve
                && t.resource == resource
                && spot(t.range) == spot(range)
        })
    }

    /// The numbers of the subresources that an attachment shows, all planes.
    pub(super) fn shown(&self, attachment: &Attachment) -> impl Iterator<Item = usize> + use<> {
        let range =
            Range { mip: attachment.mip, mips: 1, layer: attachment.layer, layers: attachment.layers, ..Range::ALL };
        self.parts.covered(attachment.resource, range)
    }

    /// The format with which a texture is made.
    pub(super) fn format(&self, resource: ResourceId) -> Option<Format> {
        let declared = self.graph.resources()[resource.index()].desc.texture()?;
        let made = self.plan.resources()[resource.index()].format;
        Some(made.unwrap_or(declared.format))
    }

    /// Whether a step draws.
    pub(super) fn is_raster(&self, step: StepId) -> bool {
        self.plan.steps()[step.index()].kind == PassKind::Raster
    }
}

/// The one element of which `holds` is true, if there is exactly one.
pub(super) fn only<T>(rows: &[T], holds: impl Fn(&T) -> bool) -> Option<&T> {
    let mut found = rows.iter().filter(|r| holds(r));
    found.next().filter(|_| found.next().is_none())
}
