//! The plan under examination, as input of all phases of the oracle.

use super::finding::{Findings, Rule};
use super::reference::{Read, Reference, Value};
use super::resolves::{FullScreen, is_target};
use super::subresource::Subresources;
use framegraph::access::{Access, AccessKind, Range};
use framegraph::format::Format;
use framegraph::graph::{Graph, PassFlags, PassKind};
use framegraph::id::{PassId, ResourceId, StepId};
use framegraph::options::Alias;
use framegraph::plan::{Attachment, Join, Placement, Plan, Planned, Role, Step, StepPass};
use framegraph::resource::{Kind, TextureDesc};

/// A plan, the reference semantics of its graph, and derived tables.
pub(super) struct RuleInput<'p> {
    pub(super) plan: &'p Plan,
    pub(super) graph: &'p Graph,
    /// Findings so far.
    pub(super) report: Findings<'p>,
    pub(super) parts: Subresources,
    pub(super) reference: Reference,
    /// For each resource that an inlined pass reads at the same pixel: the pass and its target.
    pub(super) replaced: Vec<Option<Replaced>>,
    /// By access: multisample resolves that running passes declare and the plan does not perform.
    pub(super) dropped: Vec<bool>,
    /// Resolves that the plan performs with full-screen passes.
    pub(super) full_screen: Vec<FullScreen>,
    /// Passes in execution order, without full-screen resolves.
    pub(super) running: Vec<StepPass>,
    /// Ids of the passes in execution order.
    pub(super) order: Vec<PassId>,
    /// Index of each pass in `order`; `None` for culled passes.
    pub(super) position: Vec<Option<usize>>,
    /// Export flag of each resource.
    pub(super) exported: Vec<bool>,
    /// Accesses of running passes to each resource, in execution order.
    pub(super) users: Vec<Vec<(PassId, &'p Access)>>,
}

/// The attachment that replaces the input of an inlined pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Replaced {
    /// The inlined pass.
    pub(super) by: PassId,
    /// Its target.
    pub(super) target: ResourceId,
    /// The range of the target.
    pub(super) range: Range,
}

/// An access of a running pass, and the resource it refers to in the plan.
#[derive(Clone, Copy)]
pub(super) struct PlannedAccess {
    pub(super) access: Access,
    /// Index of the access in the graph. Both accesses of a full-screen resolve have that of the resolve.
    pub(super) id: usize,
    /// The resource in the plan: its own, or the replacement after inlining.
    pub(super) resource: ResourceId,
    pub(super) range: Range,
    /// The access belongs to an inlined pass and is performed by its producer's shader.
    pub(super) in_shader: bool,
}

impl<'p> RuleInput<'p> {
    /// Builds the tables of a plan with consistent arrays.
    pub(super) fn new(plan: &'p Plan) -> Self {
        let graph = plan.graph();
        let parts = Subresources::of_graph(graph, plan.frame());
        let reference = Reference::of_graph(graph, &parts);
        let running: Vec<_> = plan.step_passes().iter().copied().filter(|m| m.join != Join::Resolve).collect();
        let order: Vec<_> = running.iter().map(|m| m.pass).collect();
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
        let mut ctx = Self {
            plan,
            graph,
            report,
            users,
            parts,
            reference,
            replaced,
            dropped,
            full_screen: Vec::new(),
            running,
            order,
            position,
            exported,
        };
        ctx.replace();
        ctx.find_dropped();
        for pass in &ctx.order {
            for (_, access) in ctx.accesses_of(*pass).filter(|(id, _)| !ctx.dropped[*id]) {
                ctx.users[access.resource.index()].push((*pass, access));
            }
        }
        ctx.reference.settle(graph, &ctx.parts, &ctx.order, &ctx.dropped);
        ctx
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

    /// Returns the resource and range that a declared range refers to in the plan, after any number of replacements.
    /// Replacements are free of cycles, because none is added that would close one.
    pub(super) fn effective(&self, resource: ResourceId, range: Range) -> (ResourceId, Range) {
        let mut found = (resource, range);
        while let Some(next) = self.replaced[found.0.index()] {
            found = (next.target, next.range);
        }
        found
    }

    /// Returns the accesses of a running pass in its step, without dropped ones.
    pub(super) fn planned_accesses(&self, member: StepPass) -> impl Iterator<Item = PlannedAccess> {
        let full_screen = member.join == Join::Resolve;
        let of_full_screen = move |m: &&FullScreen| full_screen && m.pass == member.pass;
        let resolves =
            self.full_screen.iter().filter(of_full_screen).flat_map(|m| [(m.id, m.samples), (m.id, m.target)]);
        let planned = move |(id, access): (usize, Access)| {
            let (resource, range) = self.effective(access.resource, access.range);
            PlannedAccess { access, id, resource, range, in_shader: false }
        };
        let here = move |t: &PlannedAccess| !full_screen && self.full_screen.iter().all(|m| m.id != t.id);
        self.declared_accesses(member).filter(here).chain(resolves.map(planned))
    }

    /// Returns the accesses of a running pass as declared, including resolves performed by full-screen passes.
    pub(super) fn declared_accesses(&self, member: StepPass) -> impl Iterator<Item = PlannedAccess> {
        self.accesses_of(member.pass).filter(|(id, _)| !self.dropped[*id]).map(move |(id, access)| {
            let (resource, range) = self.effective(access.resource, access.range);
            let drawn = matches!(access.kind, AccessKind::SamePixel | AccessKind::Color);
            PlannedAccess { access: *access, id, resource, range, in_shader: member.join == Join::Inlined && drawn }
        })
    }

    /// Returns a running pass with its join.
    pub(super) fn member(&self, pass: PassId) -> Option<StepPass> {
        self.position[pass.index()].map(|at| self.running[at])
    }

    /// Returns the accesses of the passes of a step, without those performed inside of another pass's shader.
    pub(super) fn accesses_by(&self, passes: &'p [StepPass]) -> impl Iterator<Item = (StepPass, PlannedAccess)> {
        let uses = passes.iter().flat_map(|m| self.planned_accesses(*m).map(|t| (*m, t)));
        uses.filter(|(_, t)| !t.in_shader)
    }

    /// Returns the accesses of a pass with their indices in the graph.
    pub(super) fn accesses_of(&self, pass: PassId) -> impl Iterator<Item = (usize, &'p Access)> + use<'p> {
        self.graph.passes()[pass.index()].accesses.range().zip(self.graph.accesses_of(pass))
    }

    /// Returns the values that an access reads in the reference semantics, one for each part.
    pub(super) fn reads(&self, access: usize) -> &[Read] {
        let full_screen = self.full_screen.iter().find(|m| m.id == access);
        full_screen.map_or(&self.reference.reads[self.reference.of_access[access].clone()], |m| &m.reads)
    }

    /// Returns the attachments of a step with their indices in the plan.
    pub(super) fn attachments(&self, step: StepId) -> impl Iterator<Item = (usize, &'p Attachment)> + use<'p> {
        self.step(step).attachments.range().zip(self.plan.attachments_of(step))
    }

    /// Returns the attachment of a step for an access of this kind to a range of a resource.
    pub(super) fn attachment(
        &self,
        step: StepId,
        kind: AccessKind,
        resource: ResourceId,
        range: Range,
    ) -> Option<(usize, &'p Attachment)> {
        let layers = range.layer_range(self.parts.counts(resource)[1]);
        self.attachments(step).find(|(_, a)| {
            let role = match kind {
                AccessKind::Color => matches!(a.role, Role::Color(_)),
                AccessKind::Depth => a.role == Role::Depth,
                AccessKind::DepthReadOnly => matches!(a.role, Role::Depth | Role::DepthReadOnly),
                AccessKind::Resolve => is_target(a.role),
                _ => !is_target(a.role),
            };
            let seen = (a.resource, a.mip, a.view) == (resource, range.mip, range.view);
            role && seen && layers_of(a) == layers
        })
    }

    /// Returns `true` if a same-pixel read finds its texels in the tile. Earlier passes of the step must have attached
    /// all its planes, and the pass must have joined because of it.
    pub(super) fn in_tile(&self, step: StepId, member: StepPass, planned: &PlannedAccess) -> bool {
        planned.access.kind == AccessKind::SamePixel
            && member.join == Join::SamePixel
            && self.shown_by(self.before(step, member.pass), planned.resource, planned.range)
    }

    /// Returns the passes of a step that run before one of them.
    pub(super) fn before(&self, step: StepId, pass: PassId) -> &'p [StepPass] {
        let members = self.plan.passes_of(step);
        &members[..members.iter().position(|m| m.pass == pass).unwrap_or(0)]
    }

    /// Returns `true` if the given passes attach every part of the range as color or depth, with the same level and
    /// layers.
    pub(super) fn shown_by(&self, passes: &[StepPass], resource: ResourceId, range: Range) -> bool {
        self.parts.covered(resource, range).all(|part| {
            let shows = |t: PlannedAccess| self.parts.covered(t.resource, t.range).any(|p| p == part);
            let attaches = |m: &StepPass| self.attached_accesses(*m, resource, range).any(shows);
            passes.iter().any(attaches)
        })
    }

    /// Returns `true` if one of the given passes attaches the range as color or depth.
    pub(super) fn attached_by(&self, passes: &[StepPass], resource: ResourceId, range: Range) -> bool {
        passes.iter().any(|m| self.attached_accesses(*m, resource, range).next().is_some())
    }

    /// Returns the accesses that attach the level and layers of a range as color or depth, in any plane.
    fn attached_accesses(
        &self,
        member: StepPass,
        resource: ResourceId,
        range: Range,
    ) -> impl Iterator<Item = PlannedAccess> {
        let [_, count, _] = self.parts.counts(resource);
        let same =
            move |r: Range| (r.mip, r.view, r.layer_range(count)) == (range.mip, range.view, range.layer_range(count));
        self.planned_accesses(member).filter(move |t| {
            let attached = t.access.kind.is_attachment() && t.access.kind != AccessKind::Resolve;
            attached && t.resource == resource && same(t.range)
        })
    }

    /// Returns the parts that an attachment covers, in all planes.
    pub(super) fn attached(&self, attachment: &Attachment) -> impl Iterator<Item = usize> + use<> {
        let Attachment { mip, layer, layers, .. } = *attachment;
        self.parts.covered(attachment.resource, Range { mip, mips: 1, layer, layers, ..Range::ALL })
    }

    /// Returns the parts that an access covers.
    pub(super) fn covered(&self, access: &Access) -> impl Iterator<Item = usize> + use<> {
        self.parts.covered(access.resource, access.range)
    }

    /// Returns the format of the physical texture.
    pub(super) fn format(&self, resource: ResourceId) -> Option<Format> {
        let declared = self.texture(resource)?;
        Some(self.planned(resource).format.unwrap_or(declared.format))
    }

    /// Returns the declared descriptor of a texture; `None` for a buffer.
    pub(super) fn texture(&self, resource: ResourceId) -> Option<&'p TextureDesc> {
        self.graph.resources()[resource.index()].desc.texture()
    }

    /// Returns the origin of a resource.
    pub(super) fn kind(&self, resource: ResourceId) -> Kind {
        self.graph.resources()[resource.index()].kind
    }

    /// Returns `true` if a resource lives only in this frame.
    pub(super) fn is_transient(&self, resource: ResourceId) -> bool {
        self.kind(resource) == Kind::Transient && !self.exported[resource.index()]
    }

    /// Returns the plan's row of a resource.
    pub(super) fn planned(&self, resource: ResourceId) -> &'p Planned {
        &self.plan.resources()[resource.index()]
    }

    /// Returns `true` if memoryless attachments save memory. Otherwise they are placed in a heap, if there is one.
    pub(super) fn memoryless_saves(&self) -> bool {
        let heap = self.plan.caps().placed && self.plan.options().alias == Alias::Heap;
        self.plan.caps().memoryless_saves || !heap
    }

    /// Returns the placement of a resource.
    pub(super) fn placement(&self, resource: ResourceId) -> Placement {
        self.planned(resource).placement
    }

    /// Returns the number under which hazards within a step are tracked: the part, its level and layer if the device
    /// cannot use planes separately, or the whole buffer.
    pub(super) fn spot(&self, resource: ResourceId, part: usize) -> usize {
        if self.texture(resource).is_none() {
            return self.parts.all(resource).start;
        }
        let caps = self.plan.caps();
        let apart = caps.separate_planes && caps.sample_read_only_depth;
        if apart { part } else { part - self.parts.name(resource, part).plane as usize }
    }

    /// Returns `true` if the output of `writer` in a part is read by a running pass or must survive.
    pub(super) fn is_needed(&self, writer: PassId, part: usize) -> bool {
        let reference = &self.reference;
        let survives = reference.exit[part] == Value::Written(writer) && reference.wanted[part].is_some();
        survives || reference.readers(writer, part).any(|reader| self.position[reader.index()].is_some())
    }

    /// Returns a row of the plan's steps.
    pub(super) fn step(&self, step: StepId) -> &'p Step {
        &self.plan.steps()[step.index()]
    }

    /// Returns `true` for a raster step.
    pub(super) fn is_raster(&self, step: StepId) -> bool {
        self.step(step).kind == PassKind::Raster
    }

    /// Returns `true` if a pass has a flag.
    pub(super) fn flag(&self, pass: PassId, flag: PassFlags) -> bool {
        self.graph.passes()[pass.index()].flags.has(flag)
    }
}

/// Returns the layers that an attachment covers.
pub(super) fn layers_of(attachment: &Attachment) -> std::ops::Range<u32> {
    let first = u32::from(attachment.layer);
    first..first + u32::from(attachment.layers)
}

/// Returns the only element for which `holds` is true; `None` if there are several.
pub(super) fn only<T>(rows: &[T], holds: impl Fn(&T) -> bool) -> Option<&T> {
    let mut found = rows.iter().filter(|r| holds(r));
    found.next().filter(|_| found.next().is_none())
}
