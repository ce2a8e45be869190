//! Phase 4, one pass against the current step: checks if the pass can join, and updates the step.

use super::attachment_set::AttachmentSet;
use super::steps::{InlinedInto, is_inlined};
use crate::access::{Access, AccessKind, Mode};
use crate::caps::Caps;
use crate::decision::Refusal;
use crate::format::Aspect;
use crate::graph::Tables;
use crate::id::PassId;
use crate::options::Options;
use crate::plan::{Join, StepPass};

/// Kinds of access of the current step to a resource. Stamped with the step's number, so that it needs no clearing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AccessFlags {
    step: u32,
    flags: u8,
}

pub(super) const ATTACHED_WRITE: u8 = 1;
const ATTACHED_READ: u8 = 2;
const READ: u8 = 4;
pub(super) const STORAGE_WRITE: u8 = 8;

/// A pass that may join the current step.
pub(crate) struct Candidate<'a> {
    pub(crate) graph: &'a Tables,
    pub(crate) caps: &'a Caps,
    pub(crate) options: &'a Options,
    pub(crate) pass: PassId,
    pub(crate) accesses: &'a [Access],
}

/// The accesses of the current step.
#[derive(Clone, Copy)]
pub(super) struct StepAccesses<'a> {
    /// Indexed by resource.
    pub(super) access_flags: &'a [AccessFlags],
    /// The stamp of the step's accesses.
    pub(super) number: u32,
    pub(super) members: &'a [StepPass],
    pub(super) inlined_into: &'a InlinedInto,
    /// Treats same-pixel reads as sampled: none stays in the tile, and nothing is inlined.
    pub(super) sampled: bool,
}

/// The way in which a pass joins a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joined {
    pub(super) join: Join,
    /// The pass could not join if its same-pixel reads were sampled.
    pub(super) by_tile: bool,
}

impl StepAccesses<'_> {
    /// Returns how the step has accessed the range of an access so far, tracking subresources separately.
    pub(super) fn by(self, candidate: &Candidate<'_>, attached: &AttachmentSet, access: &Access) -> u8 {
        let touch = self.access_flags[access.resource.index()];
        if touch.step != self.number || touch.flags == 0 {
            0
        } else if access.range.is_all() {
            touch.flags
        } else {
            let accesses =
                self.members.iter().flat_map(|m| candidate.graph.accesses_of(m.pass).iter().map(move |a| (m, a)));
            let met = accesses.filter(|(_, a)| meets(candidate, a, access));
            met.fold(0, |flags, (member, a)| {
                let join = if self.sampled { Join::First } else { member.join };
                flags | flags_of(a, join, attached, self.inlined_into)
            })
        }
    }
}

/// Checks how the pass can join the step, and adds its attachments to those of the step. On refusal, the step is
/// unchanged.
pub(super) fn join_kind(
    candidate: &Candidate<'_>,
    step: StepAccesses<'_>,
    attached: &mut AttachmentSet,
) -> Result<Joined, Refusal> {
    let caps = candidate.caps;
    let (mut inside, mut by_tile) = (false, false);
    for access in candidate.accesses {
        let objection = hazard(caps, access.kind, step.by(candidate, attached, access));
        let shown = access.kind == AccessKind::SamePixel && attached.shows((access.resource, access.range));
        if shown && caps.same_pixel && !step.sampled {
            inside = true;
            by_tile |= objection.is_some();
        } else if let Some(why) = objection {
            return Err(if shown { Refusal::SamePixelUnsupported } else { why });
        }
    }
    let before = attached.taken();
    let fits = match attach_all(candidate, attached) {
        Ok(shares) if !shares && !inside => Err(Refusal::ColorsDiffer),
        Ok(shares) => attached.fits(candidate.graph, caps).map(|()| shares),
        Err(why) => Err(why),
    };
    let shares = fits.inspect_err(|_| attached.restore(before))?;
    let join = if inside { Join::SamePixel } else { Join::Attachments };
    Ok(Joined { join, by_tile: by_tile || !shares })
}

#[inline]
fn is_attached(attached: &AttachmentSet, access: &Access) -> bool {
    let spot = (access.resource, access.range);
    match access.kind {
        AccessKind::Color => attached.color_slot(spot).is_some(),
        AccessKind::Depth | AccessKind::DepthReadOnly => attached.is_depth(spot),
        _ => false,
    }
}

/// Checks the accesses of a pass against those of a step that consists of one pass.
pub(super) fn objects_to_pass(candidate: &Candidate<'_>, first: &[Access]) -> Option<Refusal> {
    candidate.accesses.iter().find_map(|access| {
        let met = first.iter().filter(|a| meets(candidate, a, access));
        hazard(candidate.caps, access.kind, met.fold(0, |flags, a| flags | flag(a.kind)))
    })
}

/// Returns `true` if two accesses overlap. Planes that the device cannot use separately count as one.
fn meets(candidate: &Candidate<'_>, a: &Access, b: &Access) -> bool {
    if a.resource != b.resource {
        return false;
    }
    if a.range.is_all() || b.range.is_all() {
        return true;
    }
    let Some(texture) = candidate.graph.resources[a.resource.index()].desc.texture() else {
        return true;
    };
    let all = |access: &Access| crate::access::Range { aspect: Aspect::All, ..access.range };
    if candidate.caps.separate_planes && candidate.caps.sample_read_only_depth {
        a.range.overlaps(&b.range, texture.format)
    } else {
        all(a).overlaps(&all(b), texture.format)
    }
}

/// Returns the hazard between an access and earlier accesses of other passes of the step, if any.
#[inline]
fn hazard(caps: &Caps, kind: AccessKind, flags: u8) -> Option<Refusal> {
    let elsewhere = |so: bool| so.then_some(Refusal::SampledElsewhere);
    match kind {
        AccessKind::StorageWrite => (flags != 0).then_some(Refusal::StorageHazard),
        AccessKind::Color | AccessKind::Depth | AccessKind::Resolve => elsewhere(flags & (READ | STORAGE_WRITE) != 0),
        AccessKind::DepthReadOnly => elsewhere(!caps.sample_read_only_depth && flags & READ != 0),
        _ if flags & STORAGE_WRITE != 0 => Some(Refusal::StorageHazard),
        _ => elsewhere(flags & ATTACHED_WRITE != 0 || flags & ATTACHED_READ != 0 && !caps.sample_read_only_depth),
    }
}

/// Adds the attachments of the pass to the step. Returns `true` if they share one.
fn attach_all(candidate: &Candidate<'_>, attached: &mut AttachmentSet) -> Result<bool, Refusal> {
    let mut shares = false;
    for access in candidate.accesses.iter().filter(|a| a.kind.is_attachment()) {
        let known = is_attached(attached, access);
        shares |= known;
        let cleared = access.mode == Mode::Clear && known;
        if cleared && !(access.kind == AccessKind::Depth && attached.can_clear((access.resource, access.range))) {
            return Err(Refusal::ClearBetween);
        }
        let slot = attached.color_slot((access.resource, access.range));
        let changed = match access.kind {
            AccessKind::Color => slot,
            AccessKind::Depth if known => Some(Access::DEPTH),
            _ => None,
        };
        if changed.is_some_and(|s| attached.resolve_of(s).is_some()) {
            return Err(Refusal::ResolveBetween);
        }
        let spot = (access.resource, access.range);
        if attached.crosses(spot) || !attached.attach(candidate.accesses, access, candidate.caps.slot_mapping) {
            return Err(match access.kind {
                AccessKind::Color if known => Refusal::SlotsDiffer,
                AccessKind::Color => Refusal::ColorsDiffer,
                AccessKind::Resolve => Refusal::ResolveBetween,
                _ => Refusal::DepthDiffers,
            });
        }
    }
    Ok(shares)
}

/// Returns the flag of an access kind.
#[inline]
const fn flag(kind: AccessKind) -> u8 {
    match kind {
        AccessKind::Color | AccessKind::Depth | AccessKind::Resolve => ATTACHED_WRITE,
        AccessKind::DepthReadOnly => ATTACHED_READ,
        AccessKind::StorageWrite | AccessKind::CopyTarget => STORAGE_WRITE,
        _ => READ,
    }
}

/// Returns the flag of an access, taking into account how its pass joined the step.
#[inline]
fn flags_of(access: &Access, join: Join, attached: &AttachmentSet, inlined_into: &InlinedInto) -> u8 {
    match access.kind {
        AccessKind::SamePixel if join != Join::First && is_inlined(inlined_into, access.resource) => 0,
        AccessKind::SamePixel if join == Join::SamePixel && attached.shows((access.resource, access.range)) => {
            ATTACHED_READ
        }
        kind => flag(kind),
    }
}

/// Records the accesses of a pass in the step with this number.
pub(super) fn record_accesses(
    access_flags: &mut [AccessFlags],
    number: u32,
    accesses: &[Access],
    join: Join,
    attached: &AttachmentSet,
    inlined_into: &InlinedInto,
) {
    for access in accesses {
        let flags = flags_of(access, join, attached, inlined_into);
        let touch = &mut access_flags[access.resource.index()];
        if touch.step != number {
            *touch = AccessFlags { step: number, flags: 0 };
        }
        touch.flags |= flags;
    }
}
