//! Phase 4: which consecutive raster passes share one step.
//!
//! Every step boundary costs a tile-based GPU a round trip of its attachments through memory. From left to right, each
//! pass joins the open step when nothing stands against it; otherwise the first objection is logged and a new step opens.
//! Three ways in: the pass draws into attachments of the step ([`Join::Attachments`]; it may bring more of its own as
//! long as it shares one), it reads them at the same pixel ([`Join::SamePixel`], where the device can), or it is
//! point-wise and becomes an epilogue of the shaders that produce its input ([`Join::Inlined`], see `inline`).

use super::group::{Group, Shape, shape_of_pass};
use super::inline::{self, InlinedInto, Uses};
use crate::access::{Access, AccessKind, Mode};
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Refusal, Subject};
use crate::graph::{Graph, PassFlags, PassKind};
use crate::id::{AccessId, PassId, ResourceId, Span};
use crate::options::Options;
use crate::plan::{Join, Step, StepPass};

/// How a resource was touched in the open step; stamped with the step's number so that nothing needs clearing.
#[derive(Clone, Copy, Debug, Default)]
struct Touch {
    step: u32,
    flags: u8,
}

const ATTACHED_WRITE: u8 = 1;
const ATTACHED_READ: u8 = 2;
const READ: u8 = 4;
const STORAGE_WRITE: u8 = 8;

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
    /// For each resource, the access that draws in its stead since its reader was inlined; none for most.
    pub(crate) inlined_into: &'a mut Vec<AccessId>,
    /// For each resource, the resource whose format it is made with since its reader was inlined; none for most.
    pub(crate) format_of: &'a mut Vec<ResourceId>,
    pub(crate) decisions: &'a mut Vec<Decision>,
}

/// Groups `order` into steps.
pub(crate) fn merge(
    graph: &Graph,
    caps: &Caps,
    options: &Options,
    order: &[PassId],
    scratch: &mut MergeScratch,
    out: &mut Merged<'_>,
) {
    out.steps.clear();
    out.step_passes.clear();
    out.inlined_into.clear();
    out.inlined_into
        .resize(graph.resources.len(), AccessId::NONE);
    out.format_of.clear();
    out.format_of
        .resize(graph.resources.len(), ResourceId::NONE);
    scratch.touches.clear();
    scratch
        .touches
        .resize(graph.resources.len(), Touch::default());
    let pointwise = |p: &PassId| graph.passes[p.index()].flags.has(PassFlags::POINTWISE);
    let inlining = options.inline && caps.inline && order.iter().any(pointwise);
    if inlining {
        scratch.uses.count(graph, order);
    }
    let mut last_raster = None;
    for &pass in order {
        let declared = &graph.passes[pass.index()];
        let accesses = declared.accesses.of(&graph.accesses);
        let number = out.steps.len() as u32;
        let raster = declared.kind == PassKind::Raster;
        let shape = if raster {
            shape_of_pass(graph, accesses, options.frame)
        } else {
            NO_SHAPE
        };
        let joined = match out.steps.last() {
            None => None,
            Some(step) if declared.kind != PassKind::Raster || step.kind != PassKind::Raster => {
                let previous = out.step_passes[out.step_passes.len() - 1].pass;
                let (before, why) = match last_raster {
                    Some(raster) if declared.kind == PassKind::Raster => {
                        (raster, Refusal::ComputeBetween)
                    }
                    _ => (previous, Refusal::NotRaster),
                };
                log(out.decisions, pass, Reason::Split(before, why));
                None
            }
            Some(_) => {
                let case = Case {
                    graph,
                    caps,
                    options,
                    pass,
                    accesses,
                    number,
                    shape,
                };
                try_join(&case, scratch, inlining, out)
            }
        };
        let join = joined.unwrap_or(Join::First);
        if join == Join::First {
            scratch
                .group
                .open(if raster { accesses } else { &[] }, shape);
            open_step(declared.kind, shape, out);
        }
        let end = out.step_passes.len() + 1;
        out.step_passes.push(StepPass { pass, join });
        if let Some(step) = out.steps.last_mut() {
            step.passes = Span::new(step.passes.start as usize, end);
            touch(
                &mut scratch.touches,
                out.steps.len() as u32,
                accesses,
                join,
                &scratch.group,
                out.inlined_into,
            );
        }
        if declared.kind == PassKind::Raster {
            last_raster = Some(pass);
        }
    }
}

/// One pass that wants to join the open step.
pub(crate) struct Case<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) caps: &'a Caps,
    pub(crate) options: &'a Options,
    pub(crate) pass: PassId,
    pub(crate) accesses: &'a [Access],
    /// The open step's number plus one: the stamp of its touches.
    number: u32,
    /// What the pass's attachments share.
    shape: Shape,
}

const NO_SHAPE: Shape = Shape {
    extent: [0; 2],
    layers: 0,
    samples: 1,
};

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

fn log(decisions: &mut Vec<Decision>, pass: PassId, reason: Reason) {
    decisions.push(Decision {
        subject: Subject::Pass(pass),
        reason,
    });
}

/// Joins the pass to the open step, or logs why not.
fn try_join(
    case: &Case<'_>,
    scratch: &mut MergeScratch,
    inlining: bool,
    out: &mut Merged<'_>,
) -> Option<Join> {
    let MergeScratch {
        touches,
        group,
        uses,
    } = scratch;
    let step = out.steps.last()?;
    let members = &out.step_passes[step.passes.range()];
    let previous = members.last()?.pass;
    let flags = case.graph.passes[case.pass.index()].flags;
    if flags.has(PassFlags::POINTWISE) && inlining {
        let touched = |r: ResourceId| match touched(touches, case.number, r) {
            0 => inline::Touched::No,
            flags if flags & (ATTACHED_WRITE | STORAGE_WRITE) == 0 => inline::Touched::Read,
            _ => inline::Touched::Written,
        };
        match inline::inlinable(case, group, members, uses, out.inlined_into, touched) {
            Ok(found) => {
                inline::apply(case.graph, group, &found, out.inlined_into, out.format_of);
                log(
                    out.decisions,
                    case.pass,
                    Reason::MergedInline(found.producer),
                );
                return Some(Join::Inlined);
            }
            Err(why) => log(out.decisions, case.pass, Reason::NotInlined(previous, why)),
        }
    }
    match join_kind(case, touches, group, members) {
        Ok((join, widened)) => {
            *group = widened;
            let reason = match join {
                Join::SamePixel => Reason::MergedSamePixel(previous),
                _ => Reason::MergedAttachments(previous),
            };
            log(out.decisions, case.pass, reason);
            Some(join)
        }
        Err(why) => {
            log(out.decisions, case.pass, Reason::Split(previous, why));
            None
        }
    }
}

fn touched(touches: &[Touch], number: u32, resource: ResourceId) -> u8 {
    let touch = touches[resource.index()];
    if touch.step == number { touch.flags } else { 0 }
}

/// How the pass can join the step, with the step's attachments afterwards; or the first objection.
fn join_kind(
    case: &Case<'_>,
    touches: &[Touch],
    group: &Group,
    members: &[StepPass],
) -> Result<(Join, Group), Refusal> {
    let Case {
        graph,
        caps,
        options,
        accesses,
        ..
    } = *case;
    let flags = |pass: PassId| graph.passes[pass.index()].flags;
    if !options.merge || !caps.merge_attachments {
        return Err(Refusal::Disabled);
    }
    let alone = |pass| flags(pass).has(PassFlags::NEVER_MERGE);
    if alone(case.pass) || members.iter().any(|m| alone(m.pass)) {
        return Err(Refusal::NeverMerge);
    }
    let shape = case.shape;
    let checks = [
        (shape.extent == group.shape.extent, Refusal::Extent),
        (shape.samples == group.shape.samples, Refusal::Samples),
        (shape.layers == group.shape.layers, Refusal::Layers),
    ];
    if let Some((_, why)) = checks.into_iter().find(|(same, _)| !same) {
        return Err(why);
    }
    let same_pixel = same_pixel_inside(case, touches, group)?;
    hazards(case, touches)?;
    let widened = attach_all(case, group)?;
    let shares = accesses
        .iter()
        .any(|a| a.kind.is_attachment() && is_attached(group, a));
    if !shares && !same_pixel {
        return Err(Refusal::ColorsDiffer);
    }
    widened.fits(graph, caps)?;
    Ok((
        if same_pixel {
            Join::SamePixel
        } else {
            Join::Attachments
        },
        widened,
    ))
}

#[inline]
fn is_attached(group: &Group, access: &Access) -> bool {
    let spot = (access.resource, access.range);
    match access.kind {
        AccessKind::Color => group.color_slot(spot).is_some(),
        AccessKind::Depth | AccessKind::DepthReadOnly => group.is_depth(spot),
        _ => false,
    }
}

/// Whether a same-pixel read of the pass finds its texel in the tile; an objection when the device would have to sample.
fn same_pixel_inside(case: &Case<'_>, touches: &[Touch], group: &Group) -> Result<bool, Refusal> {
    let mut inside = false;
    for access in case
        .accesses
        .iter()
        .filter(|a| a.kind == AccessKind::SamePixel)
    {
        let in_tile = group.shows((access.resource, access.range));
        if in_tile && case.caps.same_pixel {
            inside = true;
        } else if in_tile {
            return Err(Refusal::SamePixelUnsupported);
        } else if touched(touches, case.number, access.resource) & (ATTACHED_WRITE | STORAGE_WRITE)
            != 0
        {
            return Err(Refusal::SampledElsewhere);
        }
    }
    Ok(inside)
}

/// Reads and writes outside of the attachments that the step's other passes exclude.
fn hazards(case: &Case<'_>, touches: &[Touch]) -> Result<(), Refusal> {
    for access in case.accesses {
        let flags = touched(touches, case.number, access.resource);
        let why = match access.kind {
            AccessKind::SamePixel => None,
            AccessKind::StorageWrite => (flags != 0).then_some(Refusal::StorageHazard),
            AccessKind::Color | AccessKind::Depth | AccessKind::Resolve => {
                (flags & (READ | STORAGE_WRITE) != 0).then_some(Refusal::SampledElsewhere)
            }
            AccessKind::DepthReadOnly if case.caps.sample_read_only_depth => None,
            AccessKind::DepthReadOnly => (flags & READ != 0).then_some(Refusal::SampledElsewhere),
            _ if flags & STORAGE_WRITE != 0 => Some(Refusal::StorageHazard),
            _ if flags & ATTACHED_WRITE != 0 => Some(Refusal::SampledElsewhere),
            _ if flags & ATTACHED_READ != 0 && !case.caps.sample_read_only_depth => {
                Some(Refusal::SampledElsewhere)
            }
            _ => None,
        };
        if let Some(why) = why {
            return Err(why);
        }
    }
    Ok(())
}

/// The step's attachments with those of the pass.
fn attach_all(case: &Case<'_>, group: &Group) -> Result<Group, Refusal> {
    let mut widened = *group;
    for access in case.accesses.iter().filter(|a| a.kind.is_attachment()) {
        let known = is_attached(group, access);
        if known && access.mode == Mode::Clear {
            return Err(Refusal::ClearBetween);
        }
        let slot = group.color_slot((access.resource, access.range));
        if access.kind == AccessKind::Color && slot.is_some_and(|s| group.resolve_of(s).is_some()) {
            return Err(Refusal::ResolveBetween);
        }
        let spot = (access.resource, access.range);
        if widened.crosses(spot) || !widened.attach(case.accesses, access, case.caps.same_pixel) {
            return Err(match access.kind {
                AccessKind::Color => Refusal::ColorsDiffer,
                AccessKind::Resolve => Refusal::ResolveBetween,
                _ => Refusal::DepthDiffers,
            });
        }
    }
    Ok(widened)
}

/// Notes what the pass touches in the step numbered `number`.
fn touch(
    touches: &mut [Touch],
    number: u32,
    accesses: &[Access],
    join: Join,
    group: &Group,
    inlined_into: &InlinedInto,
) {
    for access in accesses {
        let spot = (access.resource, access.range);
        let flag = match access.kind {
            AccessKind::Color | AccessKind::Depth | AccessKind::Resolve => ATTACHED_WRITE,
            AccessKind::DepthReadOnly => ATTACHED_READ,
            AccessKind::StorageWrite | AccessKind::CopyTarget => STORAGE_WRITE,
            AccessKind::SamePixel
                if join != Join::First && !inlined_into[access.resource.index()].is_none() =>
            {
                continue;
            }
            AccessKind::SamePixel if join == Join::SamePixel && group.shows(spot) => ATTACHED_READ,
            _ => READ,
        };
        let touch = &mut touches[access.resource.index()];
        if touch.step != number {
            *touch = Touch {
                step: number,
                flags: 0,
            };
        }
        touch.flags |= flag;
    }
}
