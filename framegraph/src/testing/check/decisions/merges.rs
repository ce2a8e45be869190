//! Rows on how passes came into their steps: merged, inlined, or why not.
//!
//! A refusal must name an objection that stands between the pass and the step before it (for a pass that opened a step)
//! or the passes before it (for one that joined, and was not inlined).

use super::rows::{judge, number, predecessor};
use crate::access::{Access, AccessKind, Mode};
use crate::decision::{Reason, Refusal};
use crate::graph::{PassFlags, PassKind};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::{Attachment, Join, Role, StepPass};
use crate::testing::check::attachments::weight;
use crate::testing::check::case::{Case, Touch, layers_of};
use std::collections::BTreeSet;

/// A pass and the step that it joined or did not join.
pub(super) struct Candidate<'c, 'p> {
    pub(super) case: &'c Case<'p>,
    pub(super) pass: PassId,
    pub(super) accesses: &'p [Access],
    /// The step.
    pub(super) step: StepId,
    /// The step's passes before the pass.
    pub(super) members: &'p [StepPass],
}

/// Examines the rows on one pass.
pub(super) fn merges(case: &Case<'_>, pass: PassId, reasons: &[Reason]) {
    let (mut merged, mut split, mut refused) = (0, 0, 0);
    let candidate = Candidate::of(case, pass);
    let and = |holds: &dyn Fn(&Candidate<'_, '_>) -> bool| candidate.as_ref().is_some_and(holds);
    let join = case.position[pass.index()].map(|p| case.plan.step_passes()[p].join);
    let follows = |with| predecessor(case, pass) == Some(with);
    for &reason in reasons {
        let (count, holds) = match reason {
            Reason::MergedAttachments(with) => (&mut merged, join == Some(Join::Attachments) && follows(with)),
            Reason::MergedSamePixel(with) => (&mut merged, join == Some(Join::SamePixel) && follows(with)),
            Reason::MergedInline(with) => {
                (&mut merged, join == Some(Join::Inlined) && and(&|c| c.last_producer() == Some(with)))
            }
            Reason::Split(with, why) => (&mut split, join == Some(Join::First) && and(&|c| c.split(with, why))),
            Reason::NotInlined(with, why) => {
                (&mut refused, join != Some(Join::Inlined) && follows(with) && and(&|c| c.not_inlined(why)))
            }
            _ => continue,
        };
        *count += 1;
        judge(case, pass, reason, holds);
    }
    let opens = join == Some(Join::First) && candidate.is_some();
    let joins = join.is_some_and(|j| j != Join::First);
    number(case, pass, "its merge", merged, usize::from(joins));
    number(case, pass, "its split", split, usize::from(opens));
    let wanted = and(&|c| c.wants_to_be_inlined()) && join != Some(Join::Inlined);
    number(case, pass, "its inlining", refused, usize::from(wanted));
}

impl<'c, 'p> Candidate<'c, 'p> {
    /// A running pass and the step before it; none for the first pass of all.
    fn of(case: &'c Case<'p>, pass: PassId) -> Option<Self> {
        let before = predecessor(case, pass)?;
        let step = case.plan.pass_steps()[before.index()];
        let members = case.plan.passes_of(step);
        let end = members.iter().position(|m| m.pass == pass).unwrap_or(members.len());
        Some(Self { case, pass, accesses: case.graph.accesses_of(pass), step, members: &members[..end] })
    }

    /// What the step's passes touched before the pass, inlined ones left out.
    pub(super) fn before(&self) -> impl Iterator<Item = (PassId, Touch<'p>)> {
        self.case.touched_by(self.members).map(|(m, t)| (m.pass, t))
    }

    /// Whether an earlier pass of the step attached what an access names as color or depth.
    fn attached(&self, access: &Access) -> bool {
        self.case.attached_by(self.members, access.resource, access.range)
    }

    /// Whether earlier passes of the step touch a part of an access in that way.
    pub(super) fn touched(&self, access: &Access, which: impl Fn(&Access) -> bool) -> bool {
        let spots = |range| self.case.parts.covered(access.resource, range);
        let spots = |range| spots(range).map(|part| self.case.spot(access.resource, part));
        let meets = |t: &Touch<'_>| {
            // All of a buffer is in one use, whatever bytes are named.
            let whole = self.case.texture(access.resource).is_none();
            let shared = || spots(access.range).any(|s| spots(t.range).any(|o| o == s));
            t.resource == access.resource && (whole || shared())
        };
        self.before().any(|(_, t)| which(t.access) && meets(&t))
    }

    /// The step before would take the pass for what the tile holds: the pass reads there at the same pixel, or it draws
    /// into an attachment of a step which such a read made longer. And a later pass of the step that the pass opens would
    /// not fit behind them.
    pub(super) fn room_for_later(&self) -> bool {
        let plan = self.case.plan;
        let own = plan.pass_steps()[self.pass.index()];
        let shown = |a: &Access| {
            let (resource, range) = self.case.effective(a.resource, a.range);
            let (attached, target) = (self.case.attached_by(self.members, resource, range), AccessKind::Resolve);
            attached || self.case.attachment(self.step, target, resource, range).is_some()
        };
        let mut reads = self.accesses.iter().filter(|a| a.kind == AccessKind::SamePixel);
        let longer = self.members.iter().any(|m| matches!(m.join, Join::SamePixel | Join::Inlined));
        let drawn = || longer && self.attachments().any(|a| self.attached(a));
        // What an epilogue would have made of the step is not to be seen in the plan.
        let stands = || self.wants_to_be_inlined() || self.keeps_later_out(own);
        own != self.step && plan.passes_of(own).len() > 1 && (reads.any(shown) || drawn()) && stands()
    }

    /// Whether something stands between a pass of the step `own` and all passes before it, from those of this step on: an
    /// objection, or attachments that are too many or too large together.
    fn keeps_later_out(&self, own: StepId) -> bool {
        let (case, plan) = (self.case, self.case.plan);
        let (caps, samples) = (plan.caps(), u32::from(case.step(own).samples));
        let (start, passes) = (case.step(self.step).passes.start as usize, case.step(own).passes.range());
        passes.skip(1).any(|at| {
            let (pass, members) = (plan.step_passes()[at].pass, &plan.step_passes()[start..at]);
            let later = Self { case, pass, accesses: case.graph.accesses_of(pass), step: self.step, members };
            let with = plan.step_passes()[at - 1].pass;
            let objects = |why: &Refusal| *why != Refusal::RoomForLater && later.split(with, *why);
            let drawn = case.touched_by(&plan.step_passes()[start..=at]).map(|(_, t)| t);
            let drawn: BTreeSet<_> = drawn.filter(|t| t.access.kind == AccessKind::Color).map(|t| t.resource).collect();
            let (count, bytes) = weight(drawn.into_iter().filter_map(|r| case.format(r)));
            let many = count > caps.max_color_attachments.into() || bytes > caps.max_color_bytes_per_sample;
            let tile = caps.tile_bytes_per_pixel;
            Refusal::ALL.iter().any(objects) || many && !caps.same_pixel || tile != 0 && bytes * samples > tile
        })
    }

    fn is_raster(&self, pass: PassId) -> bool {
        self.case.graph.passes()[pass.index()].kind == PassKind::Raster
    }

    fn wants_to_be_inlined(&self) -> bool {
        let enabled = self.case.plan.options().inline && self.case.plan.caps().inline;
        let rasters = self.is_raster(self.pass) && self.case.is_raster(self.step);
        enabled && rasters && self.case.flag(self.pass, PassFlags::POINTWISE)
    }

    /// Whether the pass, or one of the step's before it, asks to stay alone.
    pub(super) fn stays_alone(&self) -> bool {
        let mut passes = self.members.iter().map(|m| m.pass).chain([self.pass]);
        passes.any(|p| self.case.flag(p, PassFlags::NEVER_MERGE))
    }

    /// Whether the objection to sharing the step stands.
    fn split(&self, with: PassId, why: Refusal) -> bool {
        let (case, caps, options) = (self.case, self.case.plan.caps(), self.case.plan.options());
        let raster = self.is_raster(self.pass);
        let both = raster && case.is_raster(self.step);
        let partner = match why {
            Refusal::ComputeBetween => self.last_raster(),
            _ => self.members.last().map(|m| m.pass),
        };
        if partner != Some(with) {
            return false;
        }
        let row = case.step(self.step);
        match why {
            Refusal::NotRaster => !both && (!raster || self.last_raster().is_none()),
            Refusal::ComputeBetween => !both && raster,
            _ if !both => false,
            Refusal::Disabled => !options.merge || !caps.merge_attachments,
            Refusal::NeverMerge => self.stays_alone(),
            Refusal::Extent => self.size().0 != row.extent,
            Refusal::Samples => self.size().1 != row.samples,
            Refusal::Layers => self.size().2 != row.layers,
            Refusal::ColorsDiffer => self.colors_differ(),
            Refusal::SlotsDiffer => !caps.slot_mapping && self.placed_elsewhere(),
            Refusal::RoomForLater => self.room_for_later(),
            Refusal::DepthDiffers => self.accesses.iter().any(|a| {
                let mut depth = self.before().filter(|(_, t)| t.access.kind.is_depth());
                a.kind.is_depth() && depth.next().is_some() && !self.attached(a)
            }),
            Refusal::TooManyAttachments => {
                let (count, bytes) = self.weight();
                let too_many = count > u32::from(caps.max_color_attachments);
                !caps.same_pixel && (too_many || bytes > caps.max_color_bytes_per_sample)
            }
            Refusal::TileMemory => {
                let bytes = self.weight().1 * u32::from(row.samples);
                caps.tile_bytes_per_pixel != 0 && bytes > caps.tile_bytes_per_pixel
            }
            Refusal::SampledElsewhere => self.sampled_elsewhere(),
            Refusal::SamePixelUnsupported => {
                let mut reads = self.accesses.iter().filter(|a| a.kind == AccessKind::SamePixel);
                !caps.same_pixel && reads.any(|a| self.attached(a))
            }
            Refusal::ClearBetween => {
                let mut clears = self.accesses.iter().filter(|a| a.mode == Mode::Clear && a.kind.is_attachment());
                // One attachment has one clear value.
                let second = |a: &Access| {
                    a.kind == AccessKind::Depth
                        && self
                            .before()
                            .any(|(_, t)| t.access.kind == AccessKind::Depth && t.access.mode == Mode::Clear)
                };
                clears.any(|a| self.attached(a) && (second(a) || self.drawn(a)))
            }
            Refusal::ResolveBetween => self.resolve_between(),
            Refusal::StorageHazard => self.storage_hazard(),
            _ => false,
        }
    }

    /// The last raster pass that ran before the pass.
    fn last_raster(&self) -> Option<PassId> {
        let position = self.case.position[self.pass.index()]?;
        self.case.order[..position].iter().rev().find(|p| self.is_raster(**p)).copied()
    }

    /// The color and depth attachments of the pass.
    fn attachments(&self) -> impl Iterator<Item = &'p Access> {
        self.accesses.iter().filter(|a| a.kind.is_attachment() && a.kind != AccessKind::Resolve)
    }

    /// Extent, samples and layers of the pass's attachments.
    fn size(&self) -> ([u32; 2], u8, u32) {
        let size = self.attachments().next().and_then(|a| {
            let texture = self.case.texture(a.resource)?;
            let layers = a.range.layer_range(texture.tracked_layers()).len() as u32;
            Some((texture.mip_extent(self.case.plan.frame(), a.range.mip.into()), texture.samples, layers))
        });
        size.unwrap_or(([0; 2], 1, 0))
    }

    /// The color attachments of the step.
    pub(super) fn colors(&self) -> impl Iterator<Item = &'p Attachment> {
        self.case.plan.attachments_of(self.step).iter().filter(|a| matches!(a.role, Role::Color(_)))
    }

    /// Whether earlier passes of the step attach a part of an access.
    fn drawn(&self, access: &Access) -> bool {
        let parts = |range| self.case.parts.covered(access.resource, range);
        self.before().any(|(_, t)| {
            t.access.kind.is_attachment()
                && t.resource == access.resource
                && parts(access.range).any(|p| parts(t.range).any(|q| p == q))
        })
    }

    /// Whether an attachment of the step shows what an access names: the same level and layers through the same format; or
    /// some of the layers.
    fn shows(&self, row: &Attachment, access: &Access) -> (bool, bool) {
        let layers = access.range.layer_range(self.case.parts.counts(access.resource).1);
        let own = layers_of(row);
        let level = row.resource == access.resource && row.mip == access.range.mip;
        let same = own == layers && row.view == access.range.view;
        (level && same, level && own.start < layers.end && layers.start < own.end)
    }

    /// The pass shares no attachment with the step, draws another one in the slot of one of them, or some layers of one.
    fn colors_differ(&self) -> bool {
        let shares = self.attachments().any(|a| self.attached(a));
        let colors = || self.attachments().filter(|a| a.kind == AccessKind::Color);
        let taken = || colors().any(|a| self.colors().any(|r| r.role == Role::Color(a.slot) && !self.shows(r, a).0));
        let mut rows = self.case.plan.attachments_of(self.step).iter();
        let crosses = rows.any(|r| colors().any(|a| matches!(self.shows(r, a), (false, true)) || is_target(r, a)));
        !shares || crosses || !self.case.plan.caps().slot_mapping && taken()
    }

    /// The pass draws a color attachment of the step in another slot.
    fn placed_elsewhere(&self) -> bool {
        let mut colors = self.attachments().filter(|a| a.kind == AccessKind::Color);
        colors.any(|a| self.colors().any(|r| self.shows(r, a).0 && r.role != Role::Color(a.slot)))
    }

    /// Color attachments and bytes a sample of the step with the pass.
    fn weight(&self) -> (u32, u32) {
        let own = self.accesses.iter().filter(|a| a.kind == AccessKind::Color && !self.attached(a));
        let all = self.colors().map(|a| a.resource).chain(own.map(|a| a.resource));
        weight(all.filter_map(|r| self.case.format(r)))
    }

    /// The pass reads in memory what the step draws, or draws what the step reads there.
    fn sampled_elsewhere(&self) -> bool {
        let depth = self.case.plan.caps().sample_read_only_depth;
        self.accesses.iter().any(|a| {
            if a.kind.is_attachment() {
                (a.mode.writes() || !depth) && self.touched(a, |b| !b.kind.is_attachment())
            } else {
                self.touched(a, |b| {
                    let kept = b.kind == AccessKind::DepthReadOnly && !depth;
                    b.mode.writes() || kept || b.kind == AccessKind::Resolve
                })
            }
        })
    }

    /// The pass changes an attachment that the step resolves, or resolves a second time.
    fn resolve_between(&self) -> bool {
        let rows = self.case.plan.attachments_of(self.step);
        let resolved = |resource: ResourceId| {
            let target = |slot: u8| rows.iter().any(|b| b.role == Role::ResolveTarget(slot));
            self.colors().any(|a| a.resource == resource && matches!(a.role, Role::Color(slot) if target(slot)))
        };
        self.accesses.iter().any(|a| match a.kind {
            AccessKind::Color => resolved(a.resource),
            AccessKind::Resolve => self.touched(a, |b| b.kind.is_attachment()),
            _ => false,
        })
    }

    /// The pass and the step touch something that one of them writes in memory.
    pub(super) fn storage_hazard(&self) -> bool {
        let stored = |x: &Access| !x.kind.is_attachment() && x.mode.writes();
        self.accesses.iter().any(|a| self.touched(a, |b| stored(a) || stored(b)))
    }
}

/// Whether an attachment of a step is a resolve target of the resource of an access.
fn is_target(row: &Attachment, access: &Access) -> bool {
    matches!(row.role, Role::ResolveTarget(_)) && row.resource == access.resource
}
