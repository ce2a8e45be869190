//! Checks hazards inside of steps, and conditions for sharing a step.
//!
//! The passes of a step are not separated by barriers or tile flushes. Two of them may access the same part in memory
//! only if neither writes it, and no pass may read from memory what the step draws.

use super::finding::Rule;
use super::rule_input::{Replaced, RuleInput};
use framegraph::access::{Access, AccessKind, Mode, Range};
use framegraph::graph::PassFlags;
use framegraph::id::{PassId, ResourceId, StepId};
use framegraph::plan::{Attachment, Join, Placement};
use framegraph::resource::Dimension;

/// Use of a part by a pass within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum UseKind {
    /// Attached and not changed by this access.
    Shown,
    /// Drawn into.
    Drawn,
    /// Read from memory.
    Read,
    /// Written to memory.
    Written,
}

/// Examines every step.
pub(super) fn hazards(ctx: &RuleInput<'_>) {
    for step in ctx.plan.step_ids() {
        memory(ctx, step);
        joins(ctx, step);
    }
    for resource in ctx.graph.resource_ids() {
        if let Some(replaced) = ctx.replaced[resource.index()] {
            inlining(ctx, resource, replaced);
        }
    }
}

/// Checks the uses of one step for conflicts.
fn memory(ctx: &RuleInput<'_>, step: StepId) {
    let mut uses: Vec<(usize, UseKind, usize, PassId, ResourceId)> = Vec::new();
    let spot = |resource, part| ctx.spot(resource, part);
    for attachment in ctx.plan.attachments_of(step) {
        let (attached, resource) = (ctx.attached(attachment), attachment.resource);
        uses.extend(attached.map(|part| (spot(resource, part), UseKind::Shown, part, PassId::NONE, resource)));
    }
    for (member, planned) in ctx.accesses_by(ctx.plan.passes_of(step)) {
        let use_kind = match (planned.access.kind.is_attachment(), planned.access.mode.writes()) {
            (true, true) => UseKind::Drawn,
            (true, false) => UseKind::Shown,
            (false, true) => UseKind::Written,
            (false, false) if ctx.in_tile(step, member, &planned) => UseKind::Shown,
            (false, false) => UseKind::Read,
        };
        let (parts, resource) = (ctx.parts.covered(planned.resource, planned.range), planned.resource);
        uses.extend(parts.map(|part| (spot(resource, part), use_kind, part, member.pass, resource)));
    }
    uses.sort_unstable();
    let depth = ctx.plan.caps().sample_read_only_depth;
    for of_part in uses.chunk_by(|a, b| a.0 == b.0) {
        for (index, &(_, use_kind, part, pass, resource)) in of_part.iter().enumerate() {
            for &(_, before, beside, other, _) in &of_part[..index] {
                // Conflicts between two planes in one pass are checked elsewhere.
                if beside != part && (other == pass || other.is_none() || pass.is_none()) {
                    continue;
                }
                let clash = match (before, use_kind) {
                    (UseKind::Drawn, UseKind::Read) | (UseKind::Drawn | UseKind::Shown, UseKind::Written) => true,
                    (UseKind::Shown, UseKind::Read) => !depth,
                    (UseKind::Read | UseKind::Written, UseKind::Written) => other != pass,
                    _ => false,
                };
                let place = ((step, pass, resource), ctx.parts.name(resource, part));
                let why = format_args!("conflicting uses in one step: {before:?} by one pass, {use_kind:?} by another");
                ctx.report.require(!clash, Rule::Hazard, place, why);
            }
        }
    }
}

/// Checks that the passes of a step may share it, and that their joins are correct.
fn joins(ctx: &RuleInput<'_>, step: StepId) {
    let (caps, options) = (ctx.plan.caps(), ctx.plan.options());
    let members = ctx.plan.passes_of(step);
    let alone = members.iter().find(|m| ctx.flag(m.pass, PassFlags::NEVER_MERGE));
    if let (Some(alone), true) = (alone, members.len() > 1) {
        ctx.report.violation(Rule::Merging, (step, alone.pass), "it is declared `never_merge`");
    }
    for (index, member) in members.iter().enumerate().skip(1) {
        let place = (step, member.pass);
        ctx.report.require(ctx.is_raster(step), Rule::Merging, place, "only raster passes share a step");
        let allowed = match member.join {
            Join::Inlined => options.inline && caps.inline,
            _ => options.merge && caps.merge_attachments,
        };
        let why = format_args!("options or device do not allow {:?}", member.join);
        ctx.report.require(allowed, Rule::Merging, place, why);
        let mut uses = ctx.planned_accesses(*member);
        let right = match member.join {
            Join::First | Join::Resolve => false,
            Join::Inlined => true,
            Join::SamePixel => caps.same_pixel && uses.any(|t| ctx.in_tile(step, *member, &t)),
            Join::Attachments => {
                uses.any(|t| t.access.kind.is_attachment() && ctx.attached_by(&members[..index], t.resource, t.range))
            }
        };
        let why = format_args!("its join is not {:?}", member.join);
        ctx.report.require(right, Rule::Merging, place, why);
    }
}

/// Checks that the pass that replaces `input` is a valid epilogue of the passes that draw it.
///
/// The input, and the samples resolved into it, must be drawn only by those passes, in this step, without previous
/// contents and without blending. The target must have the same shape. The pass must not blend or have a side effect,
/// because an epilogue is only a shader.
fn inlining(ctx: &RuleInput<'_>, input: ResourceId, replaced: Replaced) {
    let graph = ctx.graph;
    let step = ctx.plan.pass_steps()[replaced.by.index()];
    let require = |holds: bool, why: &str| {
        ctx.report.require(holds, Rule::Inlining, (step, replaced.by, input), why);
    };
    require(ctx.is_transient(input), "its input must survive as a texture");
    let own = |flag| ctx.flag(replaced.by, flag);
    require(own(PassFlags::POINTWISE), "it is not declared point-wise");
    require(!own(PassFlags::SIDE_EFFECT), "it has a side effect, which an epilogue loses");
    require(!own(PassFlags::BLENDS), "it blends, which an epilogue cannot");
    let output = graph.accesses_of(replaced.by).iter().find(|a| a.mode.writes());
    require(output.is_some_and(|a| a.mode != Mode::Modify), "it modifies previous contents of its target");
    require(same_shape(ctx, input, replaced), "its target differs in more than its format");

    let mut before: Vec<PassId> = ctx.plan.passes_of(step).iter().map(|m| m.pass).collect();
    before.truncate(before.iter().position(|pass| *pass == replaced.by).unwrap_or(0));
    // Resources in the place of the last target of a chain of epilogues.
    let last = ctx.effective(input, Range::ALL).0;
    let is_last = |a: &Access| ctx.effective(a.resource, a.range).0 == last;
    let resolved = samples_of(ctx, step, is_last);
    let draws = |a: &Access| a.kind == AccessKind::Color && (is_last(a) || resolved.contains(&a.resource));
    for producer in before.iter().filter(|pass| !is_inlined(ctx, **pass) && graph.accesses_of(**pass).iter().any(draws))
    {
        let inlined = before.iter().copied().filter(|pass| is_inlined(ctx, *pass));
        let shader: Vec<_> = inlined.chain([*producer, replaced.by]).collect();
        require(fits_shader(ctx, &shader, input), "its shader exceeds the bindings of a stage");
    }

    let samples = samples_of(ctx, step, |a| a.resource == input);
    for resource in std::iter::once(&input).chain(&samples) {
        let users = ctx.users[resource.index()].iter().filter(|(pass, _)| *pass != replaced.by);
        for (index, (pass, access)) in users.enumerate() {
            let draws = matches!(access.kind, AccessKind::Color | AccessKind::Resolve);
            let here = ctx.plan.pass_steps()[pass.index()] == step;
            require(draws && here, "its input has uses other than its producers");
            let whole = ctx.parts.covered(*resource, access.range).count() == ctx.parts.all(*resource).len();
            require(whole || *resource != input, "an attachment has only a part of its input");
            if access.kind == AccessKind::Color && !is_inlined(ctx, *pass) {
                require(ctx.flag(*pass, PassFlags::TAKES_EPILOGUE), "a producer does not accept an epilogue");
                require(!ctx.flag(*pass, PassFlags::BLENDS), "a producer blends");
            }
            require(index > 0 || access.mode != Mode::Modify, "its input uses previous contents");
        }
    }
    for sample in samples {
        let mut kept = ctx.plan.attachments_of(step).iter().filter(|a| a.resource == sample);
        let stored = kept.any(Attachment::stores);
        require(ctx.is_transient(sample) && !stored, "the samples resolved into its input must survive");
    }
    require(ctx.placement(input) == Placement::Inlined, "its input has a placement");
}

/// Returns `true` if a shader stage can bind what the passes use together. `input` and inlined resources are values
/// between the passes, not bindings.
pub(super) fn fits_shader(ctx: &RuleInput<'_>, passes: &[PassId], input: ResourceId) -> bool {
    let caps = ctx.plan.caps();
    let mut counts = [0; 4];
    let exists = |a: &&Access| a.resource != input && ctx.placement(a.resource) != Placement::Inlined;
    for access in passes.iter().flat_map(|pass| ctx.graph.accesses_of(*pass)).filter(exists) {
        let is_texture = ctx.texture(access.resource).is_some();
        match access.kind {
            AccessKind::Sampled => counts[0] += 1,
            AccessKind::SamePixel if !caps.same_pixel => counts[0] += 1,
            AccessKind::StorageRead | AccessKind::StorageWrite if is_texture => counts[1] += 1,
            AccessKind::StorageRead | AccessKind::StorageWrite => counts[2] += 1,
            AccessKind::Uniform => counts[3] += 1,
            _ => {}
        }
    }
    let max =
        [caps.max_sampled_textures, caps.max_storage_textures, caps.max_storage_buffers, caps.max_uniform_buffers];
    counts.iter().zip(max).all(|(count, max)| *count <= max)
}

/// Returns `true` if a running pass is an epilogue.
fn is_inlined(ctx: &RuleInput<'_>, pass: PassId) -> bool {
    ctx.member(pass).is_some_and(|m| m.join == Join::Inlined)
}

/// Returns the multisampled attachments of the step with a resolve that `is_into` accepts.
fn samples_of(ctx: &RuleInput<'_>, step: StepId, is_into: impl Fn(&Access) -> bool) -> Vec<ResourceId> {
    let mut found = Vec::new();
    for member in ctx.plan.passes_of(step) {
        let accesses = ctx.graph.accesses_of(member.pass);
        let resolves = ctx.accesses_of(member.pass).filter(|(id, _)| !ctx.dropped[*id]).map(|(_, a)| a);
        for resolve in resolves.filter(|a| a.kind == AccessKind::Resolve && is_into(a)) {
            let from = accesses.iter().find(|a| a.kind == AccessKind::Color && a.slot == resolve.slot);
            found.extend(from.map(|a| a.resource));
        }
    }
    found
}

/// Returns `true` if the target of an inlined pass has the shape of its input: one level and one sample of the same
/// size, and as many layers. The pass reads all layers of the input. A slice among others does not fit.
pub(super) fn same_shape(ctx: &RuleInput<'_>, input: ResourceId, replaced: Replaced) -> bool {
    let (Some(from), Some(to)) = (ctx.texture(input), ctx.texture(replaced.target)) else {
        return false;
    };
    let frame = ctx.plan.frame();
    let layers = usize::from(from.layers);
    let reads = ctx.accesses_of(replaced.by).filter(|(_, access)| access.resource == input);
    ctx.parts.covered(replaced.target, replaced.range).count() == layers
        && reads.map(|(_, access)| ctx.parts.covered(input, access.range).count()).all(|read| read == layers)
        && replaced.range.view.is_none()
        && !replaced.range.slice
        && ctx.parts.all(input).len() == layers
        && from.dimension == Dimension::D2
        && to.mip_extent(frame, replaced.range.mip.into()) == from.extent.texels(frame)
        && from.samples == 1
        && to.samples == 1
}
