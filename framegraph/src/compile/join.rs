//! Phase 4, one pass against the open step: what stands against sharing it, and what the step becomes if nothing does.

use super::step_attachments::StepAttachments;
use super::steps::{InlinedInto, is_inlined};
use crate::access::{Access, AccessKind, Mode};
use crate::caps::Caps;
use crate::decision::Refusal;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use crate::options::Options;
use crate::plan::Join;

/// How a resource was touched in the open step; stamped with the step's number so that nothing needs clearing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Touch {
    step: u32,
    flags: u8,
}

pub(super) const ATTACHED_WRITE: u8 = 1;
const ATTACHED_READ: u8 = 2;
const READ: u8 = 4;
pub(super) const STORAGE_WRITE: u8 = 8;

/// One pass that wants to join the open step.
pub(crate) struct Candidate<'a> {
    pub(crate) graph: &'a Tables,
    pub(crate) caps: &'a Caps,
    pub(crate) options: &'a Options,
    pub(crate) pass: PassId,
    pub(crate) accesses: &'a [Access],
    /// The open step's number plus one: the stamp of its touches.
    pub(super) number: u32,
}

/// How the step numbered `number` touched a resource so far.
pub(super) fn touched(touches: &[Touch], number: u32, resource: ResourceId) -> u8 {
    let touch = touches[resource.index()];
    if touch.step == number { touch.flags } else { 0 }
}

/// How the pass can join the step, whose attachments are widened by those of the pass; or the first objection, and the
/// step stays as it is.
pub(super) fn join_kind(
    candidate: &Candidate<'_>,
    touches: &[Touch],
    attached: &mut StepAttachments,
) -> Result<Join, Refusal> {
    let same_pixel = same_pixel_inside(candidate, touches, attached)?;
    hazards(candidate, |resource| touched(touches, candidate.number, resource))?;
    let before = attached.taken();
    let fits = match attach_all(candidate, attached) {
        Ok(shares) if !shares && !same_pixel => Err(Refusal::ColorsDiffer),
        Ok(_) => attached.fits(candidate.graph, candidate.caps),
        Err(why) => Err(why),
    };
    if let Err(why) = fits {
        attached.restore(before);
        return Err(why);
    }
    Ok(if same_pixel { Join::SamePixel } else { Join::Attachments })
}

#[inline]
fn is_attached(attached: &StepAttachments, access: &Access) -> bool {
    let spot = (access.resource, access.range);
    match access.kind {
        AccessKind::Color => attached.color_slot(spot).is_some(),
        AccessKind::Depth | AccessKind::DepthReadOnly => attached.is_depth(spot),
        _ => false,
    }
}

/// Whether a same-pixel read of the pass finds its texel in the tile; an objection when the device would have to sample.
fn same_pixel_inside(
    candidate: &Candidate<'_>,
    touches: &[Touch],
    attached: &StepAttachments,
) -> Result<bool, Refusal> {
    let mut inside = false;
    for access in candidate.accesses.iter().filter(|a| a.kind == AccessKind::SamePixel) {
        let in_tile = attached.shows((access.resource, access.range));
        if in_tile && candidate.caps.same_pixel {
            inside = true;
        } else if in_tile {
            return Err(Refusal::SamePixelUnsupported);
        } else if touched(touches, candidate.number, access.resource) & (ATTACHED_WRITE | STORAGE_WRITE) != 0 {
            return Err(Refusal::SampledElsewhere);
        }
    }
    Ok(inside)
}

/// What stands against sharing a step that has one pass yet, which makes these accesses, of what it reads and writes.
pub(super) fn objects_to_pass(candidate: &Candidate<'_>, first: &[Access]) -> Option<Refusal> {
    let flags =
        |resource: ResourceId| first.iter().filter(|a| a.resource == resource).fold(0, |flags, a| flags | flag(a.kind));
    hazards(candidate, flags).err()
}

/// Reads and writes outside of the attachments that the step's other passes exclude, which `touched` resources so.
#[inline]
fn hazards(candidate: &Candidate<'_>, touched: impl Fn(ResourceId) -> u8) -> Result<(), Refusal> {
    for access in candidate.accesses {
        let flags = touched(access.resource);
        let why = match access.kind {
            AccessKind::SamePixel => None,
            AccessKind::StorageWrite => (flags != 0).then_some(Refusal::StorageHazard),
            AccessKind::Color | AccessKind::Depth | AccessKind::Resolve => {
                (flags & (READ | STORAGE_WRITE) != 0).then_some(Refusal::SampledElsewhere)
            }
            AccessKind::DepthReadOnly if candidate.caps.sample_read_only_depth => None,
            AccessKind::DepthReadOnly => (flags & READ != 0).then_some(Refusal::SampledElsewhere),
            _ if flags & STORAGE_WRITE != 0 => Some(Refusal::StorageHazard),
            _ if flags & ATTACHED_WRITE != 0 => Some(Refusal::SampledElsewhere),
            _ if flags & ATTACHED_READ != 0 && !candidate.caps.sample_read_only_depth => {
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

/// Widens the step by the attachments of the pass; returns whether they share one.
fn attach_all(candidate: &Candidate<'_>, attached: &mut StepAttachments) -> Result<bool, Refusal> {
    let mut shares = false;
    for access in candidate.accesses.iter().filter(|a| a.kind.is_attachment()) {
        let known = is_attached(attached, access);
        shares |= known;
        if known && access.mode == Mode::Clear {
            return Err(Refusal::ClearBetween);
        }
        let slot = attached.color_slot((access.resource, access.range));
        if access.kind == AccessKind::Color && slot.is_some_and(|s| attached.resolve_of(s).is_some()) {
            return Err(Refusal::ResolveBetween);
        }
        let spot = (access.resource, access.range);
        if attached.crosses(spot) || !attached.attach(candidate.accesses, access, candidate.caps.same_pixel) {
            return Err(match access.kind {
                AccessKind::Color => Refusal::ColorsDiffer,
                AccessKind::Resolve => Refusal::ResolveBetween,
                _ => Refusal::DepthDiffers,
            });
        }
    }
    Ok(shares)
}

/// How an access touches its resource.
#[inline]
const fn flag(kind: AccessKind) -> u8 {
    match kind {
        AccessKind::Color | AccessKind::Depth | AccessKind::Resolve => ATTACHED_WRITE,
        AccessKind::DepthReadOnly => ATTACHED_READ,
        AccessKind::StorageWrite | AccessKind::CopyTarget => STORAGE_WRITE,
        _ => READ,
    }
}

/// Notes what the pass touches in the step numbered `number`.
pub(super) fn touch(
    touches: &mut [Touch],
    number: u32,
    accesses: &[Access],
    join: Join,
    attached: &StepAttachments,
    inlined_into: &InlinedInto,
) {
    for access in accesses {
        let spot = (access.resource, access.range);
        let flag = match access.kind {
            AccessKind::SamePixel if join != Join::First && is_inlined(inlined_into, access.resource) => {
                continue;
            }
            AccessKind::SamePixel if join == Join::SamePixel && attached.shows(spot) => ATTACHED_READ,
            kind => flag(kind),
        };
        let touch = &mut touches[access.resource.index()];
        if touch.step != number {
            *touch = Touch { step: number, flags: 0 };
        }
        touch.flags |= flag;
    }
}
