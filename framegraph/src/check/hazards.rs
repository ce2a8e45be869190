//! Hazards inside of a step, and who may share one.
//!
//! Nothing separates the passes of a step in memory: no barrier, no flush of the tile. So two of them may touch a part in
//! memory only if neither writes it, and nobody may read in memory what the step draws.

use super::case::{Case, Replaced};
use super::finding::{Findings, Place, Rule};
use crate::access::{AccessKind, Mode};
use crate::graph::{PassFlags, PassKind};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::{Join, Placement, StepPass};
use crate::resource::Kind;

/// How a pass touches a part within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Way {
    /// Shown as an attachment, and not changed by this access.
    Shown,
    /// Drawn into.
    Drawn,
    /// Read in memory.
    Read,
    /// Written in memory.
    Written,
}

/// Examines every step.
pub(super) fn hazards(case: &Case<'_>, findings: &mut Findings<'_>) {
    for step in case.plan.step_ids() {
        memory(case, step, findings);
        company(case, step, findings);
    }
    for resource in case.graph.resource_ids() {
        if let Some(replaced) = case.replaced[resource.index()] {
            inlining(case, resource, replaced, findings);
        }
    }
}

/// The touches of one step that exclude each other.
fn memory(case: &Case<'_>, step: StepId, findings: &mut Findings<'_>) {
    let mut ways: Vec<(usize, Way, PassId, ResourceId)> = Vec::new();
    for attachment in case.plan.attachments_of(step) {
        let shown = case.shown(attachment);
        ways.extend(shown.map(|part| (part, Way::Shown, PassId::NONE, attachment.resource)));
    }
    for &member in case.plan.passes_of(step) {
        for touch in case.touches(member).filter(|t| !t.in_shader) {
            let way = match (touch.access.kind.is_attachment(), touch.access.mode.writes()) {
                (true, true) => Way::Drawn,
                (true, false) => Way::Shown,
                (false, true) => Way::Written,
                (false, false) if case.in_tile(step, member, &touch) => Way::Shown,
                (false, false) => Way::Read,
            };
            let parts = case.parts.covered(touch.resource, touch.range);
            ways.extend(parts.map(|part| (part, way, member.pass, touch.resource)));
        }
    }
    ways.sort_unstable();
    for of_part in ways.chunk_by(|a, b| a.0 == b.0) {
        for (index, &(part, way, pass, resource)) in of_part.iter().enumerate() {
            for &(_, before, other, _) in &of_part[..index] {
                let depth = case.plan.caps().sample_read_only_depth;
                let clash = match (before, way) {
                    (Way::Drawn, Way::Read) | (Way::Drawn | Way::Shown, Way::Written) => true,
                    (Way::Shown, Way::Read) => !depth,
                    (Way::Read | Way::Written, Way::Written) => other != pass,
                    _ => false,
                };
                if clash {
                    let place = Place::step(step).and_pass(pass).and_resource(resource);
                    let place = place.and_part(case.parts.name(resource, part));
                    let sentence = format!("{way:?} by one pass and {before:?} by another in one step");
                    findings.violation(Rule::Hazard, place, sentence);
                }
            }
        }
    }
}

/// Whether the passes of a step may share it, and whether each says rightly how it came in.
fn company(case: &Case<'_>, step: StepId, findings: &mut Findings<'_>) {
    let (caps, options) = (case.plan.caps(), case.plan.options());
    let members = case.plan.passes_of(step);
    let flags = |m: &StepPass| case.graph.passes()[m.pass.index()].flags;
    let alone = members.iter().find(|m| flags(m).has(PassFlags::NEVER_MERGE));
    if let (Some(alone), true) = (alone, members.len() > 1) {
        let place = Place::step(step).and_pass(alone.pass);
        findings.violation(Rule::Merging, place, "it asks to stay alone");
    }
    for (index, member) in members.iter().enumerate().skip(1) {
        let place = Place::step(step).and_pass(member.pass);
        let raster = case.plan.steps()[step.index()].kind == PassKind::Raster;
        findings.require(raster, Rule::Merging, place, || "only raster passes share a step".into());
        let allowed = if member.join == Join::Inlined {
            options.inline && caps.inline
        } else {
            options.merge && caps.merge_attachments
        };
        findings.require(allowed, Rule::Merging, place, || format!("options or device rule {:?} out", member.join));
        let reads = case.touches(*member).any(|t| case.in_tile(step, *member, &t));
        let shares = case
            .touches(*member)
            .any(|t| t.access.kind.is_attachment() && case.shown_by(&members[..index], t.resource, t.range));
        let right = match member.join {
            Join::First => false,
            Join::Inlined => true,
            Join::SamePixel => caps.same_pixel && reads,
            Join::Attachments => shares,
        };
        findings.require(right, Rule::Merging, place, || format!("it did not come in by {:?}", member.join));
    }
}

/// Whether the pass that replaces `input` can be an epilogue of the passes that draw it.
///
/// The input may be nothing but what those passes draw, from scratch and without blending, in this step; what is resolved
/// into it may be nothing else either; the target has its shape. The epilogue is only a shader: it blends nothing, and
/// does nothing that no resource shows.
fn inlining(case: &Case<'_>, input: ResourceId, replaced: Replaced, findings: &mut Findings<'_>) {
    let graph = case.graph;
    let step = case.plan.pass_steps()[replaced.by.index()];
    let place = Place::step(step).and_pass(replaced.by).and_resource(input);
    let mut require = |holds: bool, why: &str| {
        findings.require(holds, Rule::Inlining, place, || why.into());
    };
    let row = &graph.resources()[input.index()];
    let transient = row.kind == Kind::Transient && !case.exported[input.index()];
    require(transient, "its input must survive as a texture");
    let own = graph.passes()[replaced.by.index()].flags;
    require(own.has(PassFlags::POINTWISE), "it is not declared point-wise");
    require(!own.has(PassFlags::SIDE_EFFECT), "it has a side effect, which an epilogue would lose");
    require(!own.has(PassFlags::BLENDS), "it blends, which an epilogue cannot");
    let output = graph.accesses_of(replaced.by).iter().find(|a| a.mode.writes());
    let scratch = output.is_some_and(|a| a.mode != Mode::Modify);
    require(scratch, "it adds to older contents of its target");
    require(same_shape(case, input, replaced), "its target differs in more than the format");

    let samples = samples_of(case, step, input);
    for resource in std::iter::once(&input).chain(&samples) {
        let mut drawn = false;
        for (pass, access) in &case.users[resource.index()] {
            if *pass == replaced.by {
                continue;
            }
            let draws = matches!(access.kind, AccessKind::Color | AccessKind::Resolve);
            let here = case.plan.pass_steps()[pass.index()] == step;
            require(draws && here, "its input is used by others than its producers");
            let flags = graph.passes()[pass.index()].flags;
            let inlined = is_inlined(case, *pass);
            if access.kind == AccessKind::Color && !inlined {
                require(flags.has(PassFlags::TAKES_EPILOGUE), "a producer takes no epilogue");
                require(!flags.has(PassFlags::BLENDS), "a producer blends");
            }
            let first = !std::mem::replace(&mut drawn, true);
            require(!first || access.mode != Mode::Modify, "its input builds on older contents");
        }
    }
    for sample in samples {
        let row = &graph.resources()[sample.index()];
        let transient = row.kind == Kind::Transient && !case.exported[sample.index()];
        let kept = case.plan.attachments_of(step).iter();
        let stored = kept.filter(|a| a.resource == sample).any(crate::plan::Attachment::stores);
        require(transient && !stored, "the samples behind its input must survive");
    }
    let nowhere = case.plan.resources()[input.index()].placement == Placement::Inlined;
    require(nowhere, "its input is placed somewhere");
}

/// Whether a running pass is an epilogue.
fn is_inlined(case: &Case<'_>, pass: PassId) -> bool {
    let position = case.position[pass.index()];
    position.is_some_and(|p| case.plan.step_passes()[p].join == Join::Inlined)
}

/// The multisampled attachments that passes of the step resolve into `input`.
fn samples_of(case: &Case<'_>, step: StepId, input: ResourceId) -> Vec<ResourceId> {
    let mut found = Vec::new();
    for &member in case.plan.passes_of(step) {
        let accesses = case.graph.accesses_of(member.pass);
        let into = accesses.iter().filter(|a| a.kind == AccessKind::Resolve && a.resource == input);
        for resolve in into {
            let from = accesses.iter().find(|a| a.kind == AccessKind::Color && a.slot == resolve.slot);
            found.extend(from.map(|a| a.resource));
        }
    }
    found
}

/// The target of an inlined pass covers exactly what its input covered: one level, one layer, one sample, one size.
fn same_shape(case: &Case<'_>, input: ResourceId, replaced: Replaced) -> bool {
    let graph = case.graph;
    let texture = |r: ResourceId| graph.resources()[r.index()].desc.texture().copied();
    let (Some(from), Some(to)) = (texture(input), texture(replaced.target)) else {
        return false;
    };
    let frame = case.plan.frame();
    let extent = to.mip_extent(frame, replaced.range.mip.into());
    let parts = case.parts.covered(replaced.target, replaced.range).count();
    parts == 1
        && case.parts.all(input).len() == 1
        && extent == from.extent.resolve(frame)
        && from.layers == 1
        && from.samples == to.samples
        && to.samples == 1
}
