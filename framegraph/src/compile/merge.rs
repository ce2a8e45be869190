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

use super::framebuffer::{Framebuffer, framebuffer_of_pass};
use super::inline::{self, Uses};
use super::join::{
    ATTACHED_WRITE, Candidate, Joined, STORAGE_WRITE, Touch, Touched, join_kind, objects_to_pass, touch,
};
use super::measure::Measured;
use super::open::Open;
use super::rival::Rival;
use super::step_attachments::StepAttachments;
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
    touches: Vec<Touch>,
    attached: StepAttachments,
    /// The first pass of the current step is recorded in `touches` and `attached`. This is deferred until another pass
    /// with the same framebuffer may join.
    noted: bool,
    uses: Uses,
    rival: Rival,
    undo: Vec<Undo>,
}

/// Outputs of the phase.
pub(crate) struct Merged<'a> {
    pub(crate) steps: &'a mut Vec<Step>,
    pub(crate) step_passes: &'a mut Vec<StepPass>,
    /// For each resource, the access that replaces it because its reader was inlined; otherwise none. Empty if no pass
    /// is a candidate for inlining.
    pub(crate) inlined_into: &'a mut Vec<AccessId>,
    /// For each resource, the resource that determines its format because its reader was inlined; otherwise none. As
    /// long as `inlined_into`.
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
    scratch.touches.clear();
    scratch.rival.reset();
    let inlining = options.inline && caps.inline;
    let merging = options.merge && caps.merge_attachments;
    let mut last_raster = PassId::NONE;
    let mut open = Open::NONE;
    // Index of the next pass, and of the pass before which a step was split; earlier passes are final.
    let (mut at, mut cut) = (0, usize::MAX);
    while let Some(&pass) = order.get(at) {
        let declared = &graph.passes[pass.index()];
        let &Declared { kind, flags, .. } = declared;
        let raster = kind == PassKind::Raster;
        let framebuffer = if raster { framebuffer_of_pass(graph, measures, declared) } else { Framebuffer::NONE };
        let alone = flags.has(PassFlags::NEVER_MERGE);
        let opened = || Open { raster, alone, framebuffer, first: at, last: pass };
        let join = if raster && open.raster {
            let pointwise = inlining && flags.has(PassFlags::POINTWISE);
            let objection = open.plain_objection(merging, flags, framebuffer);
            if cut == at {
                cut_off(pass, pointwise, open.last, out);
                Join::First
            } else if objection.is_some() && !pointwise && !scratch.rival.is_apart() {
                log(out.decisions, pass, Reason::Split(open.last, objection.unwrap_or(Refusal::Disabled)));
                Join::First
            } else {
                if pointwise && out.inlined_into.is_empty() {
                    start_inlining(graph, order, scratch, out);
                }
                let candidate = Candidate { graph, caps, options, pass, accesses: graph.accesses_of(pass) };
                let logged = out.decisions.len();
                let joined = try_join(&candidate, pointwise, objection, open, scratch, out);
                let rival = &mut scratch.rival;
                if rival.is_apart() {
                    let fits = rival.open.plain_objection(merging, flags, framebuffer).is_none()
                        && rival.takes(&candidate, out.step_passes);
                    if fits && joined.join == Join::First {
                        (at, cut) = (rival.open.first, rival.open.first);
                        cut_back(&mut open, scratch, out);
                        continue;
                    }
                    if joined.join != Join::First && !fits {
                        rival.begin(&candidate, opened(), logged);
                    }
                } else if joined.by_tile {
                    rival.begin(&candidate, opened(), logged);
                }
                joined.join
            }
        } else {
            if open.raster {
                last_raster = open.last;
            }
            if raster && !last_raster.is_none() {
                log(out.decisions, pass, Reason::Split(last_raster, Refusal::ComputeBetween));
            } else if !open.last.is_none() {
                log(out.decisions, pass, Reason::Split(open.last, Refusal::NotRaster));
            }
            Join::First
        };
        if join == Join::First {
            open = opened();
            scratch.noted = false;
            scratch.undo.clear();
            scratch.rival.end();
            out.steps.push(Step {
                kind,
                samples: framebuffer.samples(),
                passes: Span::new(open.first, open.first + 1),
                attachments: Span::default(),
                extent: framebuffer.extent(),
                layers: framebuffer.layers(),
            });
        } else if let Some(step) = out.steps.last_mut() {
            step.passes.len += 1;
            (open.last, open.alone) = (pass, open.alone | alone);
        }
        out.step_passes.push(StepPass { pass, join });
        // Cannot overflow: there are at most as many steps as passes.
        pass_steps[pass.index()] = StepId::unchecked(out.steps.len() - 1);
        at += 1;
    }
}

/// Truncates the current step to where its alternative began.
#[cold]
fn cut_back(open: &mut Open, scratch: &mut MergeScratch, out: &mut Merged<'_>) {
    let MergeScratch { rival, undo, .. } = scratch;
    let first = rival.open.first;
    while let Some(last) = undo.pop_if(|u| u.at >= first) {
        out.inlined_into[last.intermediate.index()] = AccessId::NONE;
        if let Some((samples, like)) = last.samples {
            out.format_of[samples.index()] = like;
        }
    }
    out.decisions.truncate(rival.log);
    out.step_passes.truncate(first);
    open.last = out.step_passes[first - 1].pass;
    if let Some(step) = out.steps.last_mut() {
        step.passes = Span::new(open.first, first);
    }
    rival.end();
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
    open: Open,
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) -> Joined {
    if pointwise && try_inline(candidate, open, scratch, out) {
        return Joined { join: Join::Inlined, by_tile: true };
    }
    let number = out.steps.len() as u32;
    let found = match objection {
        Some(why) => Err(why),
        None => match early_objection(candidate, open, scratch) {
            Some(why) => Err(why),
            None => {
                note_first(candidate, open, scratch, out);
                let MergeScratch { touches, attached, .. } = scratch;
                let (members, inlined_into) = (&out.step_passes[open.first..], &*out.inlined_into);
                let step = Touched { touches, number, members, inlined_into, sampled: false };
                join_kind(candidate, step, attached)
            }
        },
    };
    let (joined, reason) = match found {
        Ok(joined) if joined.join == Join::SamePixel => (joined, Reason::MergedSamePixel(open.last)),
        Ok(joined) => (joined, Reason::MergedAttachments(open.last)),
        Err(why) => (Joined { join: Join::First, by_tile: false }, Reason::Split(open.last, why)),
    };
    if joined.join != Join::First {
        let MergeScratch { touches, attached, .. } = scratch;
        touch(touches, number, candidate.accesses, joined.join, attached, out.inlined_into);
    }
    log(out.decisions, candidate.pass, reason);
    joined
}

/// Inlines the pass into the shaders of the current step, or logs why not.
fn try_inline(candidate: &Candidate<'_>, open: Open, scratch: &mut MergeScratch, out: &mut Merged<'_>) -> bool {
    note_first(candidate, open, scratch, out);
    let MergeScratch { touches, attached, uses, undo, .. } = scratch;
    let (members, number) = (&out.step_passes[open.first..], out.steps.len() as u32);
    let step = Touched { touches, number, members, inlined_into: out.inlined_into, sampled: false };
    let is_touched = |access: &Access| match step.by(candidate, attached, access) {
        0 => inline::Touched::No,
        flags if flags & (ATTACHED_WRITE | STORAGE_WRITE) == 0 => inline::Touched::Read,
        _ => inline::Touched::Written,
    };
    match inline::inlinable(candidate, attached, members, uses, out.inlined_into, is_touched) {
        Ok(found) => {
            let samples = found.samples.map(|samples| (samples, out.format_of[samples.index()]));
            undo.push(Undo { at: out.step_passes.len(), intermediate: found.intermediate, samples });
            inline::apply(candidate.graph, attached, &found, out.inlined_into, out.format_of);
            touch(touches, number, candidate.accesses, Join::Inlined, attached, out.inlined_into);
            log(out.decisions, candidate.pass, Reason::MergedInline(found.producer));
            true
        }
        Err(why) => {
            log(out.decisions, candidate.pass, Reason::NotInlined(open.last, why));
            false
        }
    }
}

/// Fast check of a pass without same-pixel reads against a step of one unrecorded pass. Usually the pass samples what
/// the step draws.
fn early_objection(candidate: &Candidate<'_>, open: Open, scratch: &MergeScratch) -> Option<Refusal> {
    let in_tile = |access: &Access| access.kind == AccessKind::SamePixel;
    if scratch.noted || candidate.accesses.iter().any(in_tile) {
        return None;
    }
    objects_to_pass(candidate, candidate.graph.accesses_of(open.last))
}

/// Records the first pass of the current step, unless that is done.
fn note_first(candidate: &Candidate<'_>, open: Open, scratch: &mut MergeScratch, out: &Merged<'_>) {
    if std::mem::replace(&mut scratch.noted, true) {
        return;
    }
    let accesses = candidate.graph.accesses_of(open.last);
    let MergeScratch { touches, attached, .. } = scratch;
    touches.resize(candidate.graph.resources.len(), Touch::default());
    attached.open(accesses, open.framebuffer.samples());
    touch(touches, out.steps.len() as u32, accesses, Join::First, attached, out.inlined_into);
}
