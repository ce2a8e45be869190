//! One plan under examination: what all phases of the oracle look at.

use super::finding::{Findings, Rule};
use super::reference::{Read, Reference, Value};
use super::subresource::Subresources;
use crate::access::{Access, AccessKind, Range};
use crate::format::Format;
use crate::graph::{Graph, PassFlags, PassKind};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::{Attachment, Join, Placement, Plan, Planned, Role, Step, StepPass};
use crate::resource::{Kind, TextureDesc};

/// A plan, its graph's reference semantics, and what inlining put in whose place.
pub(super) struct Case<'p> {
    pub(super) plan: &'p Plan,
    pub(super) graph: &'p Graph,
    /// What was found against the plan so far.
    pub(super) report: Findings<'p>,
    pub(super) parts: Subresources,
    pub(super) reference: Reference,
    /// For each resource that an inlined pass reads at the same pixel: where that pass draws, and the pass.
    pub(super) replaced: Vec<Option<Replaced>>,
    /// The multisample resolves that running passes declare and the plan does not make, by access.
    pub(super) dropped: Vec<bool>,
    /// Passes in the order in which they run.
    pub(super) order: Vec<PassId>,
    /// The index of each pass in `order`; none for culled passes.
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
    pub(super) fn new(plan: &'p Plan) -> Self {
        let graph = plan.graph();
        let parts = Subresources::of_graph(graph, plan.frame());
        let reference = Reference::of_graph(graph, &parts);
        let order: Vec<_> = plan.step_passes().iter().map(|m| m.pass).collect();
        let mut position = vec![None; graph.passes().len()];
        for (at, pass) in order.iter().enumerate() {
            position[pass.index()] = Some(at);
        }
        let (users, dropped) = (vec![Vec::new(); graph.resources().len()], vec![false; graph.accesses().len()]);
        let mut exported = vec![false; graph.resources().len()];
        for export in graph.exports() {
            exported[export.resource.index()] = true;
        }
        let replaced = vec![None; graph.resources().len()];
        let report = Findings::new(graph);
        let mut case =
            Self { plan, graph, report, users, parts, reference, replaced, dropped, order, position, exported };
        case.replace();
        case.find_dropped();
        for pass in &case.order {
            for (_, access) in case.accesses_of(*pass).filter(|(id, _)| !case.dropped[*id]) {
                case.users[access.resource.index()].push((*pass, access));
            }
        }
        case.reference.settle(graph, &case.parts, &case.order, &case.dropped);
        case
    }

    /// Fills `dropped` from the attachments of the plan: the average is made for the last pass of the step that declares it.
    fn find_dropped(&mut self) {
        for step in self.plan.step_ids() {
            let mut made = Vec::new();
            for member in self.plan.passes_of(step).iter().rev() {
                for (id, access) in self.accesses_of(member.pass).filter(|(_, a)| a.kind == AccessKind::Resolve) {
                    let target = self.resolved_into(step, *member, access).filter(|at| !made.contains(at));
                    self.dropped[id] = target.is_none();
                    made.extend(target);
                }
            }
        }
    }

    /// The resolve target of a step that averages what a pass resolves so.
    fn resolved_into(&self, step: StepId, member: StepPass, resolve: &Access) -> Option<usize> {
        let spot = |a: &Access| self.effective(a.resource, a.range);
        let mut colors = self.graph.accesses_of(member.pass).iter().filter(|a| a.kind == AccessKind::Color);
        let (color, range) = spot(colors.find(|a| a.slot == resolve.slot)?);
        let (_, color) = self.attachment(step, AccessKind::Color, color, range)?;
        let (target, range) = spot(resolve);
        let (at, target) = self.attachment(step, AccessKind::Resolve, target, range)?;
        matches!((target.role, color.role), (Role::ResolveTarget(a), Role::Color(b)) if a == b).then_some(at)
    }

    /// Fills `replaced` from the inlined passes of the plan.
    fn replace(&mut self) {
        for step in self.plan.step_ids() {
            for member in self.plan.passes_of(step).iter().filter(|m| m.join == Join::Inlined) {
                let broken = |why: &str| self.report.violation(Rule::Inlining, (step, member.pass), why);
                let accesses = self.graph.accesses_of(member.pass);
                let input = only(accesses, |a| a.kind == AccessKind::SamePixel);
                let output = only(accesses, |a| a.mode.writes() || a.kind.is_attachment());
                let (Some(input), Some(output)) = (input, output) else {
                    broken("an inlined pass has one same-pixel input and one output");
                    continue;
                };
                let chain = self.effective(output.resource, output.range);
                if output.kind != AccessKind::Color || chain.0 == input.resource {
                    broken("an inlined pass draws into a color attachment that is not its input");
                } else if self.replaced[input.resource.index()].is_some() {
                    broken("two passes are inlined into the producer of one input");
                } else {
                    let replaced = Replaced { by: member.pass, target: output.resource, range: output.range };
                    self.replaced[input.resource.index()] = Some(replaced);
                }
            }
        }
    }

    /// What stands in the plan for a range of a resource: itself, or what replaced it, through any number of inlined
    /// passes. Replacements never form a circle, since none is added that would close one.
    pub(super) fn effective(&self, resource: ResourceId, range: Range) -> (ResourceId, Range) {
        let mut found = (resource, range);
        while let Some(next) = self.replaced[found.0.index()] {
            found = (next.target, next.range);
        }
        found
    }

    /// The accesses of a running pass with what they touch; none of those dropped.
    pub(super) fn touches(&self, member: StepPass) -> impl Iterator<Item = Touch<'p>> {
        self.accesses_of(member.pass).filter(|(id, _)| !self.dropped[*id]).map(move |(id, access)| {
            let (resource, range) = self.effective(access.resource, access.range);
            let drawn = matches!(access.kind, AccessKind::SamePixel | AccessKind::Color);
            Touch { access, id, resource, range, in_shader: member.join == Join::Inlined && drawn }
        })
    }

    /// What the passes of a step touch, epilogues left out: those run within the shader of another pass.
    pub(super) fn touched_by(&self, passes: &'p [StepPass]) -> impl Iterator<Item = (StepPass, Touch<'p>)> {
        let touches = passes.iter().flat_map(|m| self.touches(*m).map(|t| (*m, t)));
        touches.filter(|(_, t)| !t.in_shader)
    }

    /// The accesses of a pass with their indices in the graph.
    pub(super) fn accesses_of(&self, pass: PassId) -> impl Iterator<Item = (usize, &'p Access)> + use<'p> {
        self.graph.passes()[pass.index()].accesses.range().zip(self.graph.accesses_of(pass))
    }

    /// What an access reads, part by part, in the reference semantics.
    pub(super) fn reads(&self, access: usize) -> &[Read] {
        &self.reference.reads[self.reference.of_access[access].clone()]
    }

    /// The attachments of a step, with their indices in the plan.
    pub(super) fn attachments(&self, step: StepId) -> impl Iterator<Item = (usize, &'p Attachment)> + use<'p> {
        self.step(step).attachments.range().zip(self.plan.attachments_of(step))
    }

    /// The attachment of a step that a range of a resource is attached as, in the role that `kind` asks for.
    pub(super) fn attachment(
        &self,
        step: StepId,
        kind: AccessKind,
        resource: ResourceId,
        range: Range,
    ) -> Option<(usize, &'p Attachment)> {
        let layers = range.layer_range(self.parts.counts(resource).1);
        self.attachments(step).find(|(_, a)| {
            let role = match kind {
                AccessKind::Color => matches!(a.role, Role::Color(_)),
                AccessKind::Depth => a.role == Role::Depth,
                AccessKind::DepthReadOnly => matches!(a.role, Role::Depth | Role::DepthReadOnly),
                AccessKind::Resolve => matches!(a.role, Role::ResolveTarget(_)),
                _ => !matches!(a.role, Role::ResolveTarget(_)),
            };
            let seen = (a.resource, a.mip, a.view) == (resource, range.mip, range.view);
            role && seen && layers_of(a) == layers
        })
    }

    /// The color attachment that a resolve of a pass averages: the one of its own that has the resolve's slot.
    pub(super) fn averaged(&self, member: StepPass, resolve: &Touch<'_>) -> Option<Touch<'p>> {
        let slot = resolve.access.slot;
        self.touches(member).find(|t| t.access.kind == AccessKind::Color && t.access.slot == slot)
    }

    /// Whether a same-pixel read of a pass finds its texels in the tile: earlier passes of the step attached all of its
    /// planes, and the pass came in for that.
    pub(super) fn in_tile(&self, step: StepId, member: StepPass, touch: &Touch<'_>) -> bool {
        touch.access.kind == AccessKind::SamePixel
            && member.join == Join::SamePixel
            && self.shown_by(self.before(step, member.pass), touch.resource, touch.range)
    }

    /// The passes of a step that run before one of them.
    pub(super) fn before(&self, step: StepId, pass: PassId) -> &'p [StepPass] {
        let members = self.plan.passes_of(step);
        &members[..members.iter().position(|m| m.pass == pass).unwrap_or(0)]
    }

    /// Whether some passes have each part of a range of a resource as color or depth attachment, by accesses of that spot.
    pub(super) fn shown_by(&self, passes: &[StepPass], resource: ResourceId, range: Range) -> bool {
        self.parts.covered(resource, range).all(|part| {
            let shows = |t: Touch<'p>| self.parts.covered(t.resource, t.range).any(|p| p == part);
            let attaches = |m: &StepPass| self.attached_accesses(*m, resource, range).any(shows);
            passes.iter().any(attaches)
        })
    }

    /// Whether one of some passes has a range of a resource as color or depth attachment.
    pub(super) fn attached_by(&self, passes: &[StepPass], resource: ResourceId, range: Range) -> bool {
        passes.iter().any(|m| self.attached_accesses(*m, resource, range).next().is_some())
    }

    /// The accesses by which a pass has the level and layers of a range as color or depth attachment, whichever the planes.
    fn attached_accesses(
        &self,
        member: StepPass,
        resource: ResourceId,
        range: Range,
    ) -> impl Iterator<Item = Touch<'p>> {
        let (_, count) = self.parts.counts(resource);
        let same =
            move |r: Range| (r.mip, r.view, r.layer_range(count)) == (range.mip, range.view, range.layer_range(count));
        self.touches(member).filter(move |t| {
            let attached = t.access.kind.is_attachment() && t.access.kind != AccessKind::Resolve;
            attached && t.resource == resource && same(t.range)
        })
    }

    /// The numbers of the subresources that an attachment covers, all planes.
    pub(super) fn attached(&self, attachment: &Attachment) -> impl Iterator<Item = usize> + use<> {
        let Attachment { mip, layer, layers, .. } = *attachment;
        self.parts.covered(attachment.resource, Range { mip, mips: 1, layer, layers, ..Range::ALL })
    }

    /// The numbers of the subresources that an access covers.
    pub(super) fn covered(&self, access: &Access) -> impl Iterator<Item = usize> + use<> {
        self.parts.covered(access.resource, access.range)
    }

    /// The format with which a texture is made.
    pub(super) fn format(&self, resource: ResourceId) -> Option<Format> {
        let declared = self.texture(resource)?;
        Some(self.planned(resource).format.unwrap_or(declared.format))
    }

    /// The declared shape of a texture; none for a buffer.
    pub(super) fn texture(&self, resource: ResourceId) -> Option<&'p TextureDesc> {
        self.graph.resources()[resource.index()].desc.texture()
    }

    /// Where a resource comes from.
    pub(super) fn kind(&self, resource: ResourceId) -> Kind {
        self.graph.resources()[resource.index()].kind
    }

    /// Whether a resource is of this frame alone.
    pub(super) fn is_transient(&self, resource: ResourceId) -> bool {
        self.kind(resource) == Kind::Transient && !self.exported[resource.index()]
    }

    /// What the plan says of a resource.
    pub(super) fn planned(&self, resource: ResourceId) -> &'p Planned {
        &self.plan.resources()[resource.index()]
    }

    /// Where the plan puts a resource.
    pub(super) fn placement(&self, resource: ResourceId) -> Placement {
        self.planned(resource).placement
    }

    /// What two uses of a part have in common that exclude each other within a step: the part, its level and layer where
    /// the device cannot use planes apart, or all of a buffer.
    pub(super) fn spot(&self, resource: ResourceId, part: usize) -> usize {
        if self.texture(resource).is_none() {
            return self.parts.all(resource).start;
        }
        let caps = self.plan.caps();
        let apart = caps.separate_planes && caps.sample_read_only_depth;
        if apart { part } else { part - self.parts.name(resource, part).plane as usize }
    }

    /// Whether a running pass reads what `writer` left in a part, or it must survive.
    pub(super) fn is_needed(&self, writer: PassId, part: usize) -> bool {
        let reference = &self.reference;
        let survives = reference.exit[part] == Value::Written(writer) && reference.wanted[part].is_some();
        survives || reference.readers(writer, part).any(|reader| self.position[reader.index()].is_some())
    }

    /// A row of the plan's steps.
    pub(super) fn step(&self, step: StepId) -> &'p Step {
        &self.plan.steps()[step.index()]
    }

    /// Whether a step draws.
    pub(super) fn is_raster(&self, step: StepId) -> bool {
        self.step(step).kind == PassKind::Raster
    }

    /// Whether a pass says that of itself.
    pub(super) fn flag(&self, pass: PassId, flag: PassFlags) -> bool {
        self.graph.passes()[pass.index()].flags.has(flag)
    }
}

/// The layers that an attachment covers.
pub(super) fn layers_of(attachment: &Attachment) -> std::ops::Range<u32> {
    let first = u32::from(attachment.layer);
    first..first + u32::from(attachment.layers)
}

/// The one element of which `holds` is true, if there is exactly one.
pub(super) fn only<T>(rows: &[T], holds: impl Fn(&T) -> bool) -> Option<&T> {
    let mut found = rows.iter().filter(|r| holds(r));
    found.next().filter(|_| found.next().is_none())
}
