//! Phase 4: which consecutive raster passes share one step.
//!
//! Every step boundary costs a tile-based GPU a round trip of its attachments through memory. From left to right, each
//! pass joins the open step when nothing stands against it; otherwise the first objection is logged and a new step opens.
//! Three ways in: the pass draws into attachments of the step ([`Join::Attachments`]; it may bring more of its own as
//! long as it shares one), it reads them at the same pixel ([`Join::SamePixel`], where the device can), or it is
//! point-wise and becomes an epilogue of the shaders that produce its input ([`Join::Inlined`], see `inline`).

use super::group::{Group, NO_SHAPE, Shape, shape_of_pass};
use super::inline::{self, Uses};
use super::join::{ATTACHED_WRITE, Case, STORAGE_WRITE, Touch, join_kind, touch, touched};
use super::measure::Measured;
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Refusal, Subject};
use crate::graph::{PassFlags, PassKind, Tables};
use crate::id::{AccessId, PassId, ResourceId, Span, StepId};
use crate::options::Options;
use crate::plan::{Join, Step, StepPass};

/// Memory of the phase, kept between compiles.
#[derive(Debug, Default)]
pub(crate) struct MergeScratch {
    touches: Vec<Touch>,
    group: Group,
    pub(crate) uses: Uses,
}

/// What the phase fills.
pub(crate) struct Merged<'a> {
    pub(crate) steps: &'a mut Vec<Step>,
    pub(crate) step_passes: &'a mut Vec<StepPass>,
    /// The step of each declared pass; none for culled ones.
    pub(crate) pass_steps: &'a mut Vec<StepId>,
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
    kind: PassKind,
    shape: Shape,
    /// Where its passes begin in `step_passes`.
    first: usize,
    /// Its last pass; none when no step is open.
    last: PassId,
    /// One of its passes asks to stay alone.
    alone: bool,
    /// Its first pass is noted in `touches` and `group`: put off until a pass wants to join that fits by shape.
    noted: bool,
}

/// Groups `order` into steps.
pub(crate) fn merge(
    graph: &Tables,
    caps: &Caps,
    options: &Options,
    measures: &[Measured],
    order: &[PassId],
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) {
    out.steps.clear();
    out.step_passes.clear();
    out.pass_steps.clear();
    out.pass_steps.resize(graph.passes.len(), StepId::NONE);
    out.inlined_into.clear();
    out.format_of.clear();
    scratch.touches.clear();
    let inlining = options.inline && caps.inline;
    let merging = options.merge && caps.merge_attachments;
    let mut last_raster = PassId::NONE;
    let mut open = open_step(PassKind::Compute, NO_SHAPE, 0);
    for &pass in order {
        let declared = &graph.passes[pass.index()];
        let (kind, flags) = (declared.kind, declared.flags);
        let raster = kind == PassKind::Raster;
        let shape = if raster { shape_of_pass(graph, measures, pass) } else { NO_SHAPE };
        let join = if open.last.is_none() {
            Join::First
        } else if raster && open.kind == PassKind::Raster {
            let pointwise = inlining && flags.has(PassFlags::POINTWISE);
            match plain_objection(merging, &open, flags, shape) {
                Some(why) if !pointwise => {
                    log(out.decisions, pass, Reason::Split(open.last, why));
                    Join::First
                }
                objection => {
                    let accesses = declared.accesses.of(&graph.accesses);
                    let number = out.steps.len() as u32 + 1;
                    let case = Case { graph, caps, options, pass, accesses, number };
                    if pointwise && out.inlined_into.is_empty() {
                        scratch.uses.count(graph, order);
                        out.inlined_into.resize(graph.resources.len(), AccessId::NONE);
                        out.format_of.resize(graph.resources.len(), ResourceId::NONE);
                    }
                    let mut joined = open;
                    let join = try_join(&case, pointwise, objection, &mut joined, scratch, out);
                    open = joined;
                    join
                }
            }
        } else {
            let reason = if raster && !last_raster.is_none() {
                Reason::Split(last_raster, Refusal::ComputeBetween)
            } else {
                Reason::Split(open.last, Refusal::NotRaster)
            };
            log(out.decisions, pass, reason);
            Join::First
        };
        if join == Join::First {
            close_step(&open, out);
            open = open_step(kind, shape, out.step_passes.len());
        }
        open.last = pass;
        open.alone |= flags.has(PassFlags::NEVER_MERGE);
        out.step_passes.push(StepPass { pass, join });
        out.pass_steps[pass.index()] = StepId::at(out.steps.len());
        if raster {
            last_raster = pass;
        }
    }
    close_step(&open, out);
}

#[inline]
const fn open_step(kind: PassKind, shape: Shape, first: usize) -> Open {
    Open { kind, shape, first, last: PassId::NONE, alone: false, noted: false }
}

#[inline]
fn close_step(open: &Open, out: &mut Merged<'_>) {
    if !open.last.is_none() {
        let Shape { extent, layers, samples } = open.shape;
        out.steps.push(Step {
            kind: open.kind,
            samples: samples.max(1),
            passes: Span::new(open.first, out.step_passes.len()),
            attachments: Span::default(),
            extent,
            layers,
        });
    }
}

#[inline]
fn log(decisions: &mut Vec<Decision>, pass: PassId, reason: Reason) {
    decisions.push(Decision { subject: Subject::Pass(pass), reason });
}

/// Joins the pass to the open step, or logs why not: as an epilogue if it is `pointwise`, else by its attachments unless
/// there is an objection already.
#[inline(never)]
fn try_join(
    case: &Case<'_>,
    pointwise: bool,
    objection: Option<Refusal>,
    open: &mut Open,
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) -> Join {
    if pointwise && try_inline(case, open, scratch, out) {
        return Join::Inlined;
    }
    let found = match objection {
        Some(why) => Err(why),
        None => {
            note_first(case, open, scratch, out);
            join_kind(case, &scratch.touches, &mut scratch.group)
        }
    };
    let (join, reason) = match found {
        Ok(Join::SamePixel) => (Join::SamePixel, Reason::MergedSamePixel(open.last)),
        Ok(join) => (join, Reason::MergedAttachments(open.last)),
        Err(why) => (Join::First, Reason::Split(open.last, why)),
    };
    if join != Join::First {
        let MergeScratch { touches, group, .. } = scratch;
        let into = &*out.inlined_into;
        touch(touches, case.number, case.accesses, join, group, into);
    }
    log(out.decisions, case.pass, reason);
    join
}

/// Makes the pass an epilogue of the open step's shaders, or logs why not.
fn try_inline(case: &Case<'_>, open: &mut Open, scratch: &mut MergeScratch, out: &mut Merged<'_>) -> bool {
    note_first(case, open, scratch, out);
    let MergeScratch { touches, group, uses } = scratch;
    let members = &out.step_passes[open.first..];
    let is_touched = |r: ResourceId| match touched(touches, case.number, r) {
        0 => inline::Touched::No,
        flags if flags & (ATTACHED_WRITE | STORAGE_WRITE) == 0 => inline::Touched::Read,
        _ => inline::Touched::Written,
    };
    match inline::inlinable(case, group, members, uses, out.inlined_into, is_touched) {
        Ok(found) => {
            inline::apply(case.graph, group, &found, out.inlined_into, out.format_of);
            let (into, join) = (&*out.inlined_into, Join::Inlined);
            touch(touches, case.number, case.accesses, join, group, into);
            log(out.decisions, case.pass, Reason::MergedInline(found.producer));
            true
        }
        Err(why) => {
            log(out.decisions, case.pass, Reason::NotInlined(open.last, why));
            false
        }
    }
}

/// Notes the first pass of the open step, unless that is done.
fn note_first(case: &Case<'_>, open: &mut Open, scratch: &mut MergeScratch, out: &Merged<'_>) {
    if std::mem::replace(&mut open.noted, true) {
        return;
    }
    let accesses = case.graph.accesses_of(open.last);
    let MergeScratch { touches, group, .. } = scratch;
    touches.resize(case.graph.resources.len(), Touch::default());
    group.open(accesses, open.shape.samples.max(1));
    touch(touches, case.number, accesses, Join::First, group, out.inlined_into);
}

/// What stands against a pass whatever the step's attachments are.
#[inline]
fn plain_objection(merging: bool, open: &Open, flags: PassFlags, shape: Shape) -> Option<Refusal> {
    if !merging {
        Some(Refusal::Disabled)
    } else if open.alone || flags.has(PassFlags::NEVER_MERGE) {
        Some(Refusal::NeverMerge)
    } else if shape.extent != open.shape.extent {
        Some(Refusal::Extent)
    } else if shape.samples != open.shape.samples {
        Some(Refusal::Samples)
    } else if shape.layers != open.shape.layers {
        Some(Refusal::Layers)
    } else {
        None
    }
}
