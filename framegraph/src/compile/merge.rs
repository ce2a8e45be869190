//! Phase 4: which consecutive raster passes share one step.
//!
//! Every step boundary costs a tile-based GPU a round trip of its attachments through memory. From left to right, each
//! pass joins the open step when nothing stands against it; otherwise the first objection is logged and a new step opens.
//! Three ways in: the pass draws into attachments of the step ([`Join::Attachments`]; it may bring more of its own as
//! long as it shares one), it reads them at the same pixel ([`Join::SamePixel`], where the device can), or it is
//! point-wise and becomes an epilogue of the shaders that produce its input ([`Join::Inlined`], see `inline`).

use super::framebuffer::{Framebuffer, framebuffer_of_pass};
use super::inline::{self, Uses};
use super::join::{ATTACHED_WRITE, Candidate, STORAGE_WRITE, Touch, join_kind, objects_to_pass, touch, touched};
use super::measure::Measured;
use super::step_attachments::StepAttachments;
use crate::access::{Access, AccessKind};
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Refusal, Subject};
use crate::graph::{Declared, PassFlags, PassKind, Tables};
use crate::id::{AccessId, PassId, ResourceId, Span, StepId};
use crate::options::Options;
use crate::plan::{Join, Step, StepPass};

/// Memory of the phase, kept between compiles.
#[derive(Debug, Default)]
pub(crate) struct MergeScratch {
    touches: Vec<Touch>,
    attached: StepAttachments,
    /// The first pass of the open step is noted in `touches` and `attached`: put off until a pass wants to join that fits by
    /// size, layers and samples.
    noted: bool,
    uses: Uses,
}

/// What the phase fills.
pub(crate) struct Merged<'a> {
    pub(crate) steps: &'a mut Vec<Step>,
    pub(crate) step_passes: &'a mut Vec<StepPass>,
    /// For each resource, the access that draws in its stead since its reader was inlined; none for most, and empty when
    /// no pass that could be inlined was met.
    pub(crate) inlined_into: &'a mut Vec<AccessId>,
    /// For each resource, the resource whose format it is made with since its reader was inlined; as long as
    /// `inlined_into`.
    pub(crate) format_of: &'a mut Vec<ResourceId>,
    pub(crate) decisions: &'a mut Vec<Decision>,
}

/// The open step.
#[derive(Clone, Copy)]
struct Open {
    /// Whether it draws.
    raster: bool,
    /// One of its passes asks to stay alone.
    alone: bool,
    framebuffer: Framebuffer,
    /// Where its passes begin in `step_passes`.
    first: usize,
    /// Its last pass; none before the first step.
    last: PassId,
}

/// Groups `order` into steps, and fills the step of each declared pass: none for culled ones.
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
    let inlining = options.inline && caps.inline;
    let merging = options.merge && caps.merge_attachments;
    let mut last_raster = PassId::NONE;
    let mut open = Open { raster: false, alone: false, framebuffer: Framebuffer::NONE, first: 0, last: PassId::NONE };
    for &pass in order {
        let declared = &graph.passes[pass.index()];
        let &Declared { kind, flags, .. } = declared;
        let raster = kind == PassKind::Raster;
        let framebuffer = if raster { framebuffer_of_pass(graph, measures, declared) } else { Framebuffer::NONE };
        let join = if raster && open.raster {
            let pointwise = inlining && flags.has(PassFlags::POINTWISE);
            match plain_objection(merging, &open, flags, framebuffer) {
                Some(why) if !pointwise => {
                    log(out.decisions, pass, Reason::Split(open.last, why));
                    Join::First
                }
                objection => {
                    if pointwise && out.inlined_into.is_empty() {
                        start_inlining(graph, order, scratch, out);
                    }
                    let (accesses, number) = (graph.accesses_of(pass), out.steps.len() as u32);
                    let candidate = Candidate { graph, caps, options, pass, accesses, number };
                    try_join(&candidate, pointwise, objection, open, scratch, out)
                }
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
            open = Open { raster, alone: false, framebuffer, first: out.step_passes.len(), last: pass };
            scratch.noted = false;
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
        }
        open.last = pass;
        open.alone |= flags.has(PassFlags::NEVER_MERGE);
        out.step_passes.push(StepPass { pass, join });
        // There are no more steps than passes, and passes were counted.
        pass_steps[pass.index()] = StepId::unchecked(out.steps.len() - 1);
    }
}

/// Prepares what inlining needs, when the first pass is met that may be inlined.
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

/// Joins the pass to the open step, or logs why not: as an epilogue if it is `pointwise`, else by its attachments unless
/// there is an objection already.
#[inline(never)]
fn try_join(
    candidate: &Candidate<'_>,
    pointwise: bool,
    objection: Option<Refusal>,
    open: Open,
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) -> Join {
    if pointwise && try_inline(candidate, open, scratch, out) {
        return Join::Inlined;
    }
    let found = match objection {
        Some(why) => Err(why),
        None => match early_objection(candidate, open, scratch) {
            Some(why) => Err(why),
            None => {
                note_first(candidate, open, scratch, out);
                join_kind(candidate, &scratch.touches, &mut scratch.attached)
            }
        },
    };
    let (join, reason) = match found {
        Ok(Join::SamePixel) => (Join::SamePixel, Reason::MergedSamePixel(open.last)),
        Ok(join) => (join, Reason::MergedAttachments(open.last)),
        Err(why) => (Join::First, Reason::Split(open.last, why)),
    };
    if join != Join::First {
        let MergeScratch { touches, attached, .. } = scratch;
        let into = &*out.inlined_into;
        touch(touches, candidate.number, candidate.accesses, join, attached, into);
    }
    log(out.decisions, candidate.pass, reason);
    join
}

/// Makes the pass an epilogue of the open step's shaders, or logs why not.
fn try_inline(candidate: &Candidate<'_>, open: Open, scratch: &mut MergeScratch, out: &mut Merged<'_>) -> bool {
    note_first(candidate, open, scratch, out);
    let MergeScratch { touches, attached, uses, .. } = scratch;
    let members = &out.step_passes[open.first..];
    let is_touched = |r: ResourceId| match touched(touches, candidate.number, r) {
        0 => inline::Touched::No,
        flags if flags & (ATTACHED_WRITE | STORAGE_WRITE) == 0 => inline::Touched::Read,
        _ => inline::Touched::Written,
    };
    match inline::inlinable(candidate, attached, members, uses, out.inlined_into, is_touched) {
        Ok(found) => {
            inline::apply(candidate.graph, attached, &found, out.inlined_into, out.format_of);
            let (into, join) = (&*out.inlined_into, Join::Inlined);
            touch(touches, candidate.number, candidate.accesses, join, attached, into);
            log(out.decisions, candidate.pass, Reason::MergedInline(found.producer));
            true
        }
        Err(why) => {
            log(out.decisions, candidate.pass, Reason::NotInlined(open.last, why));
            false
        }
    }
}

/// What stands against a pass that reads nothing at the same pixel, next to a step of one pass that is not noted yet: mostly
/// that it samples what that pass draws.
fn early_objection(candidate: &Candidate<'_>, open: Open, scratch: &MergeScratch) -> Option<Refusal> {
    let in_tile = |access: &Access| access.kind == AccessKind::SamePixel;
    if scratch.noted || candidate.accesses.iter().any(in_tile) {
        return None;
    }
    objects_to_pass(candidate, candidate.graph.accesses_of(open.last))
}

/// Notes the first pass of the open step, unless that is done.
fn note_first(candidate: &Candidate<'_>, open: Open, scratch: &mut MergeScratch, out: &Merged<'_>) {
    if std::mem::replace(&mut scratch.noted, true) {
        return;
    }
    let accesses = candidate.graph.accesses_of(open.last);
    let MergeScratch { touches, attached, .. } = scratch;
    touches.resize(candidate.graph.resources.len(), Touch::default());
    attached.open(accesses, open.framebuffer.samples());
    touch(touches, candidate.number, accesses, Join::First, attached, out.inlined_into);
}

/// What stands against a pass whatever the step's attachments are.
#[inline]
fn plain_objection(merging: bool, open: &Open, flags: PassFlags, framebuffer: Framebuffer) -> Option<Refusal> {
    if !merging {
        Some(Refusal::Disabled)
    } else if open.alone || flags.has(PassFlags::NEVER_MERGE) {
        Some(Refusal::NeverMerge)
    } else if framebuffer != open.framebuffer {
        Some(framebuffer.difference(open.framebuffer))
    } else {
        None
    }
}
