//! Phase 4: merging of consecutive raster passes into steps.
//!
//! On a tile-based GPU, every step boundary costs a round trip of the attachments through memory. The phase goes
//! through the passes in order. A pass joins the current step unless there is an objection; otherwise the first
//! objection is logged, and the pass begins a new step. A pass can join in three ways:
//!
//! - It draws into attachments of the step ([`Join::Attachments`]). It may add attachments as long as it shares one.
//! - It reads attachments at the same pixel, if the device supports that ([`Join::SamePixel`]).
//! - It is point-wise and becomes an epilogue of the shaders that produce its input ([`Join::Inlined`], see `inline`).
//!
//! The last two can prevent later merges, because the earlier pass occupies the step. To avoid that, the phase tracks
//! the *sampled alternative* of the step: the step that would result if same-pixel reads were sampled. If a pass fits
//! only into the alternative, the step is split where the alternative began ([`Refusal::RoomForLater`]). Same-pixel
//! reads therefore never cost more loads, stores or steps than sampling.

use super::attachment_set::AttachmentSet;
use super::current_step::CurrentStep;
use super::framebuffer::{Framebuffer, framebuffer_of_pass};
use super::inline::{self, Uses};
use super::join::{
    ATTACHED_WRITE, AccessFlags, Candidate, Joined, STORAGE_WRITE, StepAccesses, join_kind, objects_to_pass,
    record_accesses,
};
use super::measure::Measured;
use super::sampled_alternative::SampledAlternative;
use crate::access::{Access, AccessKind};
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Refusal, Subject};
use crate::graph::{Declared, PassFlags, PassKind, Tables};
use crate::id::{AccessId, PassId, ResourceId, Span, StepId};
use crate::options::Options;
use crate::plan::{Join, Step, StepPass};

/// Memory of the phase, reused between compilations.
#[derive(Debug, Default)]
pub(crate) struct MergeScratch {
    access_flags: Vec<AccessFlags>,
    attached: AttachmentSet,
    /// The first pass of the current step is recorded in `access_flags` and `attached`. This is deferred until another pass
    /// with the same framebuffer may join.
    noted: bool,
    uses: Uses,
    alternative: SampledAlternative,
    undo: Vec<Undo>,
}

/// Outputs of the phase.
pub(crate) struct Merged<'a> {
    pub(crate) steps: &'a mut Vec<Step>,
    pub(crate) step_passes: &'a mut Vec<StepPass>,
    /// For each resource, the access that replaces it because its reader was inlined; otherwise none. Empty if no pass
    /// is a candidate for inlining.
    pub(crate) inlined_into: &'a mut Vec<AccessId>,
    /// For each resource, the resource that determines its format because its reader was inlined; otherwise none. Has
    /// the length of `inlined_into`.
    pub(crate) format_of: &'a mut Vec<ResourceId>,
    pub(crate) decisions: &'a mut Vec<Decision>,
}

/// Undo record of an inlined pass.
#[derive(Clone, Copy, Debug)]
struct Undo {
    /// Index of the pass in `step_passes`.
    at: usize,
    intermediate: ResourceId,
    /// The multisampled attachment, and the previous value of its `format_of`.
    samples: Option<(ResourceId, ResourceId)>,
}

/// Groups `order` into steps, and fills the step of each declared pass; none for culled passes.
#[inline(never)]
pub(crate) fn merge(
    graph: &Tables,
    caps: &Caps,
    options: &Options,
    measures: &[Measured],
    order: &[PassId],
    scratch: &mut MergeScratch,
    pass_steps: &mut Vec<StepId>,
    out: &mut Merged<'_>,
) {
    out.steps.clear();
    out.step_passes.clear();
    out.inlined_into.clear();
    out.format_of.clear();
    pass_steps.clear();
    pass_steps.resize(graph.passes.len(), StepId::NONE);
    scratch.access_flags.clear();
    scratch.alternative.reset();
    let inlining = options.inline && caps.inline;
    let merging = options.merge && caps.merge_attachments;
    let mut last_raster = PassId::NONE;
    let mut current = CurrentStep::NONE;
    // Index of the next pass, and of the pass before which a step was split; earlier passes are final.
    let (mut at, mut cut) = (0, usize::MAX);
    while let Some(&pass) = order.get(at) {
        let declared = &graph.passes[pass.index()];
        let &Declared { kind, flags, .. } = declared;
        let raster = kind == PassKind::Raster;
        let framebuffer = if raster { framebuffer_of_pass(graph, measures, declared) } else { Framebuffer::NONE };
        let alone = flags.has(PassFlags::NEVER_MERGE);
        let opened = || CurrentStep { raster, alone, framebuffer, first: at, last: pass };
        let join = if raster && current.raster {
            let pointwise = inlining && flags.has(PassFlags::POINTWISE);
            let objection = current.basic_objection(merging, flags, framebuffer);
            if cut == at {
                cut_off(pass, pointwise, current.last, out);
                Join::First
            } else if objection.is_some() && !pointwise && !scratch.alternative.is_apart() {
                log(out.decisions, pass, Reason::Split(current.last, objection.unwrap_or(Refusal::Disabled)));
                Join::First
            } else {
                if pointwise && out.inlined_into.is_empty() {
                    start_inlining(graph, order, scratch, out);
                }
                let candidate = Candidate { graph, caps, options, pass, accesses: graph.accesses_of(pass) };
                let logged = out.decisions.len();
                let joined = try_join(&candidate, pointwise, objection, current, scratch, out);
                let alternative = &mut scratch.alternative;
                if alternative.is_apart() {
                    let fits = alternative.current.basic_objection(merging, flags, framebuffer).is_none()
                        && alternative.takes(&candidate, out.step_passes);
                    if fits && joined.join == Join::First {
                        (at, cut) = (alternative.current.first, alternative.current.first);
                        cut_back(&mut current, scratch, out);
                        continue;
                    }
                    if joined.join != Join::First && !fits {
                        alternative.begin(&candidate, opened(), logged);
                    }
                } else if joined.by_tile {
                    alternative.begin(&candidate, opened(), logged);
                }
                joined.join
            }
        } else {
            if current.raster {
                last_raster = current.last;
            }
            if raster && !last_raster.is_none() {
                log(out.decisions, pass, Reason::Split(last_raster, Refusal::ComputeBetween));
            } else if !current.last.is_none() {
                log(out.decisions, pass, Reason::Split(current.last, Refusal::NotRaster));
            }
            Join::First
        };
        if join == Join::First {
            current = opened();
            scratch.noted = false;
            scratch.undo.clear();
            scratch.alternative.end();
            out.steps.push(Step {
                kind,
                samples: framebuffer.samples(),
                passes: Span::new(current.first, current.first + 1),
                attachments: Span::default(),
                extent: framebuffer.extent(),
                layers: framebuffer.layers(),
            });
        } else if let Some(step) = out.steps.last_mut() {
            step.passes.len += 1;
            (current.last, current.alone) = (pass, current.alone | alone);
        }
        out.step_passes.push(StepPass { pass, join });
        // Cannot overflow: there are at most as many steps as passes.
        pass_steps[pass.index()] = StepId::unchecked(out.steps.len() - 1);
        at += 1;
    }
}

/// Truncates the current step to where its alternative began.
#[cold]
fn cut_back(current: &mut CurrentStep, scratch: &mut MergeScratch, out: &mut Merged<'_>) {
    let MergeScratch { alternative, undo, .. } = scratch;
    let first = alternative.current.first;
    while let Some(last) = undo.pop_if(|u| u.at >= first) {
        out.inlined_into[last.intermediate.index()] = AccessId::NONE;
        if let Some((samples, like)) = last.samples {
            out.format_of[samples.index()] = like;
        }
    }
    out.decisions.truncate(alternative.log);
    out.step_passes.truncate(first);
    current.last = out.step_passes[first - 1].pass;
    if let Some(step) = out.steps.last_mut() {
        step.passes = Span::new(current.first, first);
    }
    alternative.end();
}

/// Logs why a pass begins a step after a split.
#[cold]
fn cut_off(pass: PassId, pointwise: bool, before: PassId, out: &mut Merged<'_>) {
    if pointwise {
        log(out.decisions, pass, Reason::NotInlined(before, Refusal::RoomForLater));
    }
    log(out.decisions, pass, Reason::Split(before, Refusal::RoomForLater));
}

/// Prepares the tables for inlining, when the first candidate is met.
#[inline(never)]
fn start_inlining(graph: &Tables, order: &[PassId], scratch: &mut MergeScratch, out: &mut Merged<'_>) {
    scratch.uses.count(graph, order);
    out.inlined_into.resize(graph.resources.len(), AccessId::NONE);
    out.format_of.resize(graph.resources.len(), ResourceId::NONE);
}

#[inline]
fn log(decisions: &mut Vec<Decision>, pass: PassId, reason: Reason) {
    decisions.push(Decision { subject: Subject::Pass(pass), reason });
}

/// Joins the pass to the current step or logs why not: as an epilogue if it is `pointwise`, otherwise by its
/// attachments unless there is already an objection.
#[inline(never)]
fn try_join(
    candidate: &Candidate<'_>,
    pointwise: bool,
    objection: Option<Refusal>,
    current: CurrentStep,
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) -> Joined {
    if pointwise && try_inline(candidate, current, scratch, out) {
        return Joined { join: Join::Inlined, by_tile: true };
    }
    let number = out.steps.len() as u32;
    let found = match objection {
        Some(why) => Err(why),
        None => match early_objection(candidate, current, scratch) {
            Some(why) => Err(why),
            None => {
                note_first(candidate, current, scratch, out);
                let MergeScratch { access_flags, attached, .. } = scratch;
                let (members, inlined_into) = (&out.step_passes[current.first..], &*out.inlined_into);
                let step = StepAccesses { access_flags, number, members, inlined_into, sampled: false };
                join_kind(candidate, step, attached)
            }
        },
    };
    let (joined, reason) = match found {
        Ok(joined) if joined.join == Join::SamePixel => (joined, Reason::MergedSamePixel(current.last)),
        Ok(joined) => (joined, Reason::MergedAttachments(current.last)),
        Err(why) => (Joined { join: Join::First, by_tile: false }, Reason::Split(current.last, why)),
    };
    if joined.join != Join::First {
        let MergeScratch { access_flags, attached, .. } = scratch;
        record_accesses(access_flags, number, candidate.accesses, joined.join, attached, out.inlined_into);
    }
    log(out.decisions, candidate.pass, reason);
    joined
}

/// Inlines the pass into the shaders of the current step, or logs why not.
fn try_inline(
    candidate: &Candidate<'_>,
    current: CurrentStep,
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) -> bool {
    note_first(candidate, current, scratch, out);
    let MergeScratch { access_flags, attached, uses, undo, .. } = scratch;
    let (members, number) = (&out.step_passes[current.first..], out.steps.len() as u32);
    let step = StepAccesses { access_flags, number, members, inlined_into: out.inlined_into, sampled: false };
    let is_touched = |access: &Access| match step.by(candidate, attached, access) {
        0 => inline::PriorAccess::No,
        flags if flags & (ATTACHED_WRITE | STORAGE_WRITE) == 0 => inline::PriorAccess::Read,
        _ => inline::PriorAccess::Written,
    };
    match inline::inlinable(candidate, attached, members, uses, out.inlined_into, is_touched) {
        Ok(found) => {
            let samples = found.samples.map(|samples| (samples, out.format_of[samples.index()]));
            undo.push(Undo { at: out.step_passes.len(), intermediate: found.intermediate, samples });
            inline::apply(candidate.graph, attached, &found, out.inlined_into, out.format_of);
            record_accesses(access_flags, number, candidate.accesses, Join::Inlined, attached, out.inlined_into);
            log(out.decisions, candidate.pass, Reason::MergedInline(found.producer));
            true
        }
        Err(why) => {
            log(out.decisions, candidate.pass, Reason::NotInlined(current.last, why));
            false
        }
    }
}

/// Fast check of a pass without same-pixel reads against a step of one unrecorded pass. Usually the pass samples what
/// the step draws.
fn early_objection(candidate: &Candidate<'_>, current: CurrentStep, scratch: &MergeScratch) -> Option<Refusal> {
    let in_tile = |access: &Access| access.kind == AccessKind::SamePixel;
    if scratch.noted || candidate.accesses.iter().any(in_tile) {
        return None;
    }
    objects_to_pass(candidate, candidate.graph.accesses_of(current.last))
}

/// Records the first pass of the current step, unless that is done.
fn note_first(candidate: &Candidate<'_>, current: CurrentStep, scratch: &mut MergeScratch, out: &Merged<'_>) {
    if std::mem::replace(&mut scratch.noted, true) {
        return;
    }
    let accesses = candidate.graph.accesses_of(current.last);
    let MergeScratch { access_flags, attached, .. } = scratch;
    access_flags.resize(candidate.graph.resources.len(), AccessFlags::default());
    attached.reset_to(accesses, current.framebuffer.samples());
    record_accesses(access_flags, out.steps.len() as u32, accesses, Join::First, attached, out.inlined_into);
}
