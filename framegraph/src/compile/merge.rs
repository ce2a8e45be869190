//! Phase 4: which consecutive raster passes share one step.
//!
//! Every step boundary costs a tile-based GPU a round trip of its attachments through memory. From left to right, each
//! pass joins the open step when nothing stands against it; otherwise the first objection is logged and a new step opens.
//! Three ways in: the pass draws into attachments of the step ([`Join::Attachments`]; it may bring more of its own as
//! long as it shares one), it reads them at the same pixel ([`Join::SamePixel`], where the device can), or it is
//! point-wise and becomes an epilogue of the shaders that produce its input ([`Join::Inlined`], see `inline`).

use super::group::{Group, Shape};
use super::inline::{self, Uses};
use super::join::{ATTACHED_WRITE, Case, STORAGE_WRITE, Touch, join_kind, touch, touched};
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Refusal, Subject};
use crate::graph::{Graph, PassFlags, PassKind};
use crate::id::{AccessId, PassId, ResourceId, Span};
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
    /// For each resource, the access that draws in its stead since its reader was inlined; none for most, and empty when
    /// nothing was inlined.
    pub(crate) inlined_into: &'a mut Vec<AccessId>,
    /// For each resource, the resource whose format it is made with since its reader was inlined; as long as
    /// `inlined_into`.
    pub(crate) format_of: &'a mut Vec<ResourceId>,
    pub(crate) decisions: &'a mut Vec<Decision>,
}

/// The open step, beside its row.
struct Open {
    /// Its last pass.
    last: PassId,
    /// One of its passes asks to stay alone.
    alone: bool,
    /// Its first pass is noted in `touches` and `group`: put off until a pass wants to join that fits by shape.
    noted: bool,
}

/// Groups `order` into steps; `shapes` are those of the passes' attachments.
pub(crate) fn merge(
    graph: &Graph,
    caps: &Caps,
    options: &Options,
    shapes: &[Shape],
    order: &[PassId],
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) {
    out.steps.clear();
    out.step_passes.clear();
    out.inlined_into.clear();
    out.format_of.clear();
    scratch.touches.clear();
    scratch.touches.resize(graph.resources.len(), Touch::default());
    let pointwise = |p: &PassId| graph.passes[p.index()].flags.has(PassFlags::POINTWISE);
    let inlining = options.inline && caps.inline && order.iter().any(pointwise);
    if inlining {
        scratch.uses.count(graph, order);
        out.inlined_into.resize(graph.resources.len(), AccessId::NONE);
        out.format_of.resize(graph.resources.len(), ResourceId::NONE);
    }
    let merging = options.merge && caps.merge_attachments;
    let mut last_raster = PassId::NONE;
    let mut open = Open { last: PassId::NONE, alone: false, noted: true };
    for &pass in order {
        let declared = &graph.passes[pass.index()];
        let (kind, flags, shape) = (declared.kind, declared.flags, shapes[pass.index()]);
        let raster = kind == PassKind::Raster;
        let join = match out.steps.last() {
            None => Join::First,
            Some(step) if raster && step.kind == PassKind::Raster => {
                let pointwise = inlining && flags.has(PassFlags::POINTWISE);
                match plain_objection(merging, &open, step, flags, shape) {
                    Some(why) if !pointwise => {
                        log(out.decisions, pass, Reason::Split(open.last, why));
                        Join::First
                    }
                    objection => {
                        let case = Case {
                            graph,
                            caps,
                            options,
                            pass,
                            accesses: declared.accesses.of(&graph.accesses),
                            number: out.steps.len() as u32,
                        };
                        try_join(&case, pointwise, objection, &mut open, scratch, out)
                    }
                }
            }
            Some(_) => {
                let reason = if raster && !last_raster.is_none() {
                    Reason::Split(last_raster, Refusal::ComputeBetween)
                } else {
                    Reason::Split(open.last, Refusal::NotRaster)
                };
                log(out.decisions, pass, reason);
                Join::First
            }
        };
        if join == Join::First {
            open_step(kind, shape, out);
            (open.alone, open.noted) = (false, false);
        }
        open.last = pass;
        open.alone |= flags.has(PassFlags::NEVER_MERGE);
        out.step_passes.push(StepPass { pass, join });
        if let Some(step) = out.steps.last_mut() {
            step.passes.len += 1;
        }
        if raster {
            last_raster = pass;
        }
    }
}

#[inline]
fn open_step(kind: PassKind, shape: Shape, out: &mut Merged<'_>) {
    out.steps.push(Step {
        kind,
        samples: shape.samples.max(1),
        passes: Span::new(out.step_passes.len(), out.step_passes.len()),
        attachments: Span::default(),
        extent: shape.extent,
        layers: shape.layers,
    });
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
    let Some(step) = out.steps.last() else {
        return false;
    };
    note_first(case, open, scratch, out);
    let MergeScratch { touches, group, uses } = scratch;
    let members = step.passes.of(out.step_passes);
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
    group.open(accesses, out.steps.last().map_or(1, |s| s.samples));
    touch(touches, case.number, accesses, Join::First, group, out.inlined_into);
}

/// What stands against a pass whatever the step's attachments are.
#[inline]
fn plain_objection(merging: bool, open: &Open, step: &Step, flags: PassFlags, shape: Shape) -> Option<Refusal> {
    if !merging {
        Some(Refusal::Disabled)
    } else if open.alone || flags.has(PassFlags::NEVER_MERGE) {
        Some(Refusal::NeverMerge)
    } else if shape.extent != step.extent {
        Some(Refusal::Extent)
    } else if shape.samples != step.samples {
        Some(Refusal::Samples)
    } else if shape.layers != step.layers {
        Some(Refusal::Layers)
    } else {
        None
    }
}
