//! Phase 4, inlining: point-wise passes as epilogues of their producer's shaders.
//!
//! Applying color grading in the lighting shader, for example, avoids the intermediate texture on devices without
//! framebuffer fetch. Inlining is valid if every fragment written to the intermediate is final when it is shaded.
//! Nothing may blend, no other pass may read the intermediate, and both targets must be cleared or overwritten. With
//! multisampling, the epilogue runs for each sample before the resolve.

use super::attachment_set::AttachmentSet;
use super::bindings::fits_shader;
use super::join::Candidate;
use super::steps::{InlinedInto, ResourceRange, is_inlined, range_in_plan};
use crate::access::{Access, AccessKind, Mode};
use crate::decision::Refusal;
use crate::graph::{PassFlags, Tables};
use crate::id::{AccessId, PassId, ResourceId};
use crate::plan::{Join, StepPass};
use crate::resolve::ResolveMode;
use crate::resource::{Dimension, Kind};

/// Number of accesses to each resource by kept passes, and its export flag.
#[derive(Debug, Default)]
pub(crate) struct Uses {
    access_counts: Vec<u32>,
    exported: Vec<bool>,
}

impl Uses {
    /// Counts the accesses of the passes in `order`.
    pub(crate) fn count(&mut self, graph: &Tables, order: &[PassId]) {
        self.access_counts.clear();
        self.access_counts.resize(graph.resources.len(), 0);
        self.exported.clear();
        self.exported.resize(graph.resources.len(), false);
        for pass in order {
            for access in graph.accesses_of(*pass) {
                self.access_counts[access.resource.index()] += 1;
            }
        }
        for export in &graph.exports {
            self.exported[export.resource.index()] = true;
        }
    }
}

/// A pass that can be inlined, and the attachment that its epilogue replaces.
pub(crate) struct Inlining {
    /// The last pass that writes the intermediate.
    pub(crate) producer: PassId,
    slot: u8,
    pub(crate) intermediate: ResourceId,
    target: AccessId,
    /// The multisampled attachment that is resolved into the intermediate, if any.
    pub(crate) samples: Option<ResourceId>,
}

/// Previous use of a range by the current step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PriorAccess {
    No,
    Read,
    Written,
}

/// Checks if a pass can become an epilogue of the passes that write its same-pixel input in the current step.
pub(crate) fn inlinable(
    candidate: &Candidate<'_>,
    attached: &AttachmentSet,
    members: &[StepPass],
    uses: &Uses,
    inlined_into: &InlinedInto,
    prior_access: impl Fn(&Access) -> PriorAccess,
) -> Result<Inlining, Refusal> {
    let Candidate { graph, options, accesses, .. } = *candidate;
    let flags = |pass: PassId| graph.passes[pass.index()].flags;
    let alone = |pass| flags(pass).has(PassFlags::NEVER_MERGE);
    if alone(candidate.pass) || members.iter().any(|m| alone(m.pass)) {
        return Err(Refusal::NeverMerge);
    }
    if flags(candidate.pass).has(PassFlags::SIDE_EFFECT) {
        return Err(Refusal::SideEffect);
    }
    let mut inputs = accesses.iter().filter(|a| a.kind == AccessKind::SamePixel);
    let (Some(input), None) = (inputs.next(), inputs.next()) else {
        return Err(Refusal::NotPointwise);
    };
    let mut writes = accesses.iter().filter(|a| a.mode.writes() || a.kind.is_attachment());
    let (Some(output), None) = (writes.next(), writes.next()) else {
        return Err(Refusal::NotPointwise);
    };
    if output.kind != AccessKind::Color {
        return Err(Refusal::NotPointwise);
    }
    if output.mode == Mode::Modify || flags(candidate.pass).has(PassFlags::BLENDS) {
        return Err(Refusal::BuildsOnContents);
    }
    let intermediate = input.resource;
    let texture = |r: ResourceId| graph.resources[r.index()].desc.texture().copied();
    let (Some(from), Some(to)) = (texture(intermediate), texture(output.resource)) else {
        return Err(Refusal::NotPointwise);
    };
    let is_input = |(_, (r, _)): &(u8, ResourceRange)| *r == intermediate;
    let color = attached.colors().find(is_input).map(|(slot, _)| slot);
    let resolve = attached.resolves().find(is_input).map(|(slot, _)| slot);
    let Some(slot) = color.or(resolve) else {
        return Err(Refusal::DrawnElsewhere);
    };
    let resolves = |a: &Access| a.kind == AccessKind::Resolve && a.resource == intermediate;
    let mut resolves = members.iter().flat_map(|m| graph.accesses_of(m.pass)).filter(|a| resolves(a));
    let stored = |a: &Access| [from, to].iter().all(|t| candidate.caps.resolves_in_store(a, Some(t.format)));
    let averaged = |a: &Access| a.resolve == ResolveMode::Average && stored(a);
    if !resolves.all(averaged) {
        return Err(Refusal::ResolveMode);
    }
    let drawn = || attached.colors().find(|(s, _)| *s == slot).map(|(_, (r, _))| r);
    let samples = if color.is_none() { drawn() } else { None };
    if graph.resources[intermediate.index()].kind != Kind::Transient || uses.exported[intermediate.index()] {
        return Err(Refusal::NeededAsTexture);
    }
    let same_size = to.mip_extent(options.frame, output.range.mip.into()) == from.extent.texels(options.frame);
    // A layer of the target for each layer of the intermediate: two eyes of a stereo view, for example.
    let layers = output.range.layer_range(to.tracked_layers()).len();
    let read = input.range.layer_range(from.tracked_layers()).len();
    if !same_size
        || from.tracked_layers() as usize != layers
        || read != layers
        || from.dimension != Dimension::D2
        || from.mips != 1
        || from.samples != 1
        || output.range.slice
        || to.samples != 1
        || input.range.view.or(output.range.view).is_some()
        || !to.format.is_resolvable()
        // Several attachments of the intermediate, each with a part of its layers.
        || attached.colors().chain(attached.resolves()).filter(is_input).any(|(_, (_, r))| r.layer_range(from.tracked_layers()).len() != layers)
    {
        return Err(Refusal::TargetShape);
    }
    let mut others = accesses.iter().filter(|a| !a.mode.writes() && a.resource != intermediate);
    if prior_access(output) != PriorAccess::No || others.any(|a| prior_access(a) == PriorAccess::Written) {
        return Err(Refusal::SampledElsewhere);
    }
    let drawn = [Some(intermediate), samples];
    let producer = check_producers(graph, members, inlined_into, &drawn)?;
    // The shader of each producer binds the resources of all epilogues too, except the values between them.
    let inlined = members.iter().filter(|m| m.join == Join::Inlined).map(|m| m.pass);
    let exists = |a: &&Access| a.resource != intermediate && !is_inlined(inlined_into, a.resource);
    for (pass, _) in producers(graph, members, inlined_into, &drawn) {
        let shader = inlined.clone().chain([pass, candidate.pass]).flat_map(|pass| graph.accesses_of(pass));
        if !fits_shader(graph, candidate.caps, shader.filter(exists)) {
            return Err(Refusal::TooManyBindings);
        }
    }
    // The only uses may be the inlined read and the draws of the step.
    let inside = count_inside(graph, members, intermediate);
    if uses.access_counts[intermediate.index()] != inside + 1 {
        return Err(Refusal::NeededAsTexture);
    }
    if let Some(samples) = samples {
        let persistent = graph.resources[samples.index()].kind != Kind::Transient || uses.exported[samples.index()];
        if persistent || uses.access_counts[samples.index()] != count_inside(graph, members, samples) {
            return Err(Refusal::NeededAsTexture);
        }
    }
    let mut exchanged = *attached;
    exchanged.set_color(slot, (output.resource, output.range));
    exchanged.fits(graph, candidate.caps)?;
    let within = accesses.iter().position(|a| std::ptr::eq(a, output)).unwrap_or_default();
    let target = AccessId::at(graph.passes[candidate.pass.index()].accesses.start as usize + within);
    Ok(Inlining { producer, slot, intermediate, target, samples })
}

fn count_inside(graph: &Tables, members: &[StepPass], resource: ResourceId) -> u32 {
    let accesses = members.iter().flat_map(|m| graph.accesses_of(m.pass));
    let draws = |a: &Access| matches!(a.kind, AccessKind::Color | AccessKind::Resolve);
    accesses.filter(|a| a.resource == resource && draws(a)).count() as u32
}

/// Returns the passes that draw into one of the textures, each with its first such access. Inlined passes are left out.
fn producers<'a>(
    graph: &'a Tables,
    members: &'a [StepPass],
    inlined_into: &'a InlinedInto,
    drawn: &'a [Option<ResourceId>; 2],
) -> impl Iterator<Item = (PassId, &'a Access)> {
    members.iter().filter(|m| m.join != Join::Inlined).filter_map(|member| {
        let is_drawn = |a: &Access| drawn.contains(&Some(range_in_plan(graph, inlined_into, a).0));
        let mut colors = graph.accesses_of(member.pass).iter();
        let color = colors.find(|a| a.kind == AccessKind::Color && is_drawn(a))?;
        Some((member.pass, color))
    })
}

/// Checks the passes that draw into the intermediate: each must accept an epilogue and must not blend, and the first
/// must not use previous contents. Returns the last of them.
fn check_producers(
    graph: &Tables,
    members: &[StepPass],
    inlined_into: &InlinedInto,
    drawn: &[Option<ResourceId>; 2],
) -> Result<PassId, Refusal> {
    let mut producer = None;
    for (pass, color) in producers(graph, members, inlined_into, drawn) {
        let flags = graph.passes[pass.index()].flags;
        if flags.has(PassFlags::BLENDS) {
            return Err(Refusal::Blends);
        }
        if !flags.has(PassFlags::TAKES_EPILOGUE) {
            return Err(Refusal::NoEpilogue);
        }
        if producer.is_none() && color.mode == Mode::Modify {
            return Err(Refusal::BuildsOnContents);
        }
        producer = Some(pass);
    }
    producer.ok_or(Refusal::NoEpilogue)
}

/// Replaces the intermediate by the target.
pub(crate) fn apply(
    graph: &Tables,
    attached: &mut AttachmentSet,
    found: &Inlining,
    inlined_into: &mut InlinedInto,
    format_of: &mut [ResourceId],
) {
    let Inlining { slot, intermediate, target, samples, .. } = *found;
    inlined_into[intermediate.index()] = target;
    let target = &graph.accesses[target.index()];
    let spot = (target.resource, target.range);
    match samples {
        None => attached.set_color(slot, spot),
        Some(samples) => {
            attached.set_resolve(slot, spot);
            format_of[samples.index()] = target.resource;
        }
    }
}
