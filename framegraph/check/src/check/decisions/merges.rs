//! Rows about merging and inlining.
//!
//! A refusal must name an objection that exists. For a pass that begins a step, it is between the pass and the previous
//! step. For a pass that joined but was not inlined, it is between the pass and the earlier passes of its step.

use super::rows::{judge, number, predecessor};
use crate::check::attachments::Weight;
use crate::check::resolves::{self, attaches_samples};
use crate::check::rule_input::{PlannedAccess, RuleInput, layers_of};
use framegraph::access::{Access, AccessKind, Mode};
use framegraph::decision::{Reason, Refusal};
use framegraph::graph::{PassFlags, PassKind};
use framegraph::id::{PassId, ResourceId, StepId};
use framegraph::plan::{Attachment, Join, Role, StepPass};
use std::collections::BTreeSet;

/// A pass, and the step that it did or did not join.
pub(super) struct Candidate<'c, 'p> {
    pub(super) ctx: &'c RuleInput<'p>,
    pub(super) pass: PassId,
    pub(super) accesses: &'p [Access],
    /// The step.
    pub(super) step: StepId,
    /// The step's passes before the pass.
    pub(super) members: &'p [StepPass],
}

/// Examines the rows about one pass.
pub(super) fn merges(ctx: &RuleInput<'_>, pass: PassId, reasons: &[Reason]) {
    let (mut merged, mut split, mut refused) = (0, 0, 0);
    let candidate = Candidate::of(ctx, pass);
    let and = |holds: &dyn Fn(&Candidate<'_, '_>) -> bool| candidate.as_ref().is_some_and(holds);
    let join = ctx.member(pass).map(|m| m.join);
    let follows = |with| predecessor(ctx, pass) == Some(with);
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
        judge(ctx, pass, reason, holds);
    }
    let opens = join == Some(Join::First) && candidate.is_some();
    let joins = join.is_some_and(|j| j != Join::First);
    number(ctx, pass, "its merge", merged, usize::from(joins));
    number(ctx, pass, "its split", split, usize::from(opens));
    let wanted = and(&|c| c.wants_to_be_inlined()) && join != Some(Join::Inlined);
    number(ctx, pass, "its inlining", refused, usize::from(wanted));
}

impl<'c, 'p> Candidate<'c, 'p> {
    /// Returns a running pass and the previous step; `None` for the first pass.
    fn of(ctx: &'c RuleInput<'p>, pass: PassId) -> Option<Self> {
        let before = predecessor(ctx, pass)?;
        let step = ctx.plan.pass_steps()[before.index()];
        let members = ctx.plan.passes_of(step);
        let end = members.iter().position(|m| m.pass == pass).unwrap_or(members.len());
        Some(Self { ctx, pass, accesses: ctx.graph.accesses_of(pass), step, members: &members[..end] })
    }

    /// Returns the earlier accesses of the step, without those of inlined passes, including resolves performed after
    /// the step.
    pub(super) fn before(&self) -> impl Iterator<Item = (PassId, PlannedAccess)> {
        let drawn = self.members.iter().filter(|m| m.join != Join::Resolve);
        let uses = drawn.flat_map(|m| self.ctx.declared_accesses(*m).map(|t| (m.pass, t)));
        uses.filter(|(_, t)| !t.in_shader)
    }

    /// Returns `true` if an earlier pass of the step attached the range of an access as color or depth.
    fn attached(&self, access: &Access) -> bool {
        self.ctx.attached_by(self.members, access.resource, access.range)
    }

    /// Returns `true` if an earlier pass of the step has an overlapping access for which `which` is true.
    pub(super) fn touched(&self, access: &Access, which: impl Fn(&Access) -> bool) -> bool {
        let spots = |range| self.ctx.parts.covered(access.resource, range);
        let spots = |range| spots(range).map(|part| self.ctx.spot(access.resource, part));
        let meets = |t: &PlannedAccess| {
            // A whole buffer has one usage, whichever bytes are accessed.
            let whole = self.ctx.texture(access.resource).is_none();
            let shared = || spots(access.range).any(|s| spots(t.range).any(|o| o == s));
            t.resource == access.resource && (whole || shared())
        };
        self.before().any(|(_, t)| which(&t.access) && meets(&t))
    }

    /// Returns `true` if the row `RoomForLater` is correct.
    ///
    /// The previous step could hold the pass only because of same-pixel reads: of the pass itself, or of earlier passes
    /// of that step. A later pass of the step that the pass begins must not fit into the previous step.
    pub(super) fn room_for_later(&self) -> bool {
        let plan = self.ctx.plan;
        let own = plan.pass_steps()[self.pass.index()];
        let shown = |a: &Access| {
            let (resource, range) = self.ctx.effective(a.resource, a.range);
            let (attached, target) = (self.ctx.attached_by(self.members, resource, range), AccessKind::Resolve);
            attached || self.ctx.attachment(self.step, target, resource, range).is_some()
        };
        let mut reads = self.accesses.iter().filter(|a| a.kind == AccessKind::SamePixel);
        let longer = self.members.iter().any(|m| matches!(m.join, Join::SamePixel | Join::Inlined));
        let drawn = || longer && self.attachments().any(|a| self.attached(a));
        // The plan does not show what an epilogue would have changed.
        let stands = || self.wants_to_be_inlined() || self.keeps_later_out(own);
        own != self.step && plan.passes_of(own).len() > 1 && (reads.any(shown) || drawn()) && stands()
    }

    /// Returns `true` if a pass of step `own` has an objection against all passes before it, from those of this step
    /// on, or if their attachments exceed the limits.
    fn keeps_later_out(&self, own: StepId) -> bool {
        let (ctx, plan) = (self.ctx, self.ctx.plan);
        let (caps, samples) = (plan.caps(), u32::from(ctx.step(own).samples));
        let (start, passes) = (ctx.step(self.step).passes.start as usize, ctx.step(own).passes.range());
        passes.skip(1).any(|at| {
            let (pass, members) = (plan.step_passes()[at].pass, &plan.step_passes()[start..at]);
            let later = Self { ctx, pass, accesses: ctx.graph.accesses_of(pass), step: self.step, members };
            let with = plan.step_passes()[at - 1].pass;
            let objects = |why: &Refusal| *why != Refusal::RoomForLater && later.split(with, *why);
            let drawn = ctx.accesses_by(&plan.step_passes()[start..=at]).map(|(_, t)| t);
            let colors = drawn.filter(|t| t.access.kind == AccessKind::Color);
            // Ordered by slot; a resource that several passes draw counts once.
            let mut seen = BTreeSet::new();
            let drawn: BTreeSet<_> =
                colors.filter(|t| seen.insert(t.resource)).map(|t| (t.access.slot, t.resource)).collect();
            let weight = Weight::of(drawn.into_iter().filter_map(|(_, r)| ctx.format(r)));
            let (many, tile) = (!weight.fits(caps), caps.tile_bytes_per_pixel);
            Refusal::ALL.iter().any(objects) || many && !caps.same_pixel || tile != 0 && weight.bytes * samples > tile
        })
    }

    fn is_raster(&self, pass: PassId) -> bool {
        self.ctx.graph.passes()[pass.index()].kind == PassKind::Raster
    }

    fn wants_to_be_inlined(&self) -> bool {
        let enabled = self.ctx.plan.options().inline && self.ctx.plan.caps().inline;
        let rasters = self.is_raster(self.pass) && self.ctx.is_raster(self.step);
        enabled && rasters && self.ctx.flag(self.pass, PassFlags::POINTWISE)
    }

    /// Returns `true` if the pass, or an earlier one of the step, is declared `never_merge`.
    pub(super) fn stays_alone(&self) -> bool {
        let mut passes = self.members.iter().map(|m| m.pass).chain([self.pass]);
        passes.any(|p| self.ctx.flag(p, PassFlags::NEVER_MERGE))
    }

    /// Returns `true` if the objection to sharing the step exists.
    fn split(&self, with: PassId, why: Refusal) -> bool {
        let (ctx, caps, options) = (self.ctx, self.ctx.plan.caps(), self.ctx.plan.options());
        let raster = self.is_raster(self.pass);
        let both = raster && ctx.is_raster(self.step);
        let partner = match why {
            Refusal::ComputeBetween => self.last_raster(),
            _ => self.members.last().map(|m| m.pass),
        };
        if partner != Some(with) {
            return false;
        }
        let row = ctx.step(self.step);
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
            Refusal::TooManyAttachments => !caps.same_pixel && !self.weight().fits(caps),
            Refusal::TileMemory => {
                let bytes = self.weight().bytes * u32::from(row.samples);
                caps.tile_bytes_per_pixel != 0 && bytes > caps.tile_bytes_per_pixel
            }
            Refusal::SampledElsewhere => self.sampled_elsewhere(),
            Refusal::SamePixelUnsupported => {
                let mut reads = self.accesses.iter().filter(|a| a.kind == AccessKind::SamePixel);
                !caps.same_pixel && reads.any(|a| self.attached(a))
            }
            Refusal::ClearBetween => {
                let mut clears = self.accesses.iter().filter(|a| a.mode == Mode::Clear && a.kind.is_attachment());
                // An attachment has one clear value.
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

    /// Returns the last raster pass before the pass.
    fn last_raster(&self) -> Option<PassId> {
        let position = self.ctx.position[self.pass.index()]?;
        self.ctx.order[..position].iter().rev().find(|p| self.is_raster(**p)).copied()
    }

    /// Returns the color and depth attachments of the pass.
    fn attachments(&self) -> impl Iterator<Item = &'p Access> {
        self.accesses.iter().filter(|a| a.kind.is_attachment() && a.kind != AccessKind::Resolve)
    }

    /// Returns extent, samples and layers of the pass's attachments.
    fn size(&self) -> ([u32; 2], u8, u32) {
        let size = self.attachments().next().and_then(|a| {
            let texture = self.ctx.texture(a.resource)?;
            let layers = a.range.layer_range(texture.tracked_layers()).len() as u32;
            Some((texture.mip_extent(self.ctx.plan.frame(), a.range.mip.into()), texture.samples, layers))
        });
        size.unwrap_or(([0; 2], 1, 0))
    }

    /// Returns the color attachments of the step.
    pub(super) fn colors(&self) -> impl Iterator<Item = &'p Attachment> {
        self.ctx.plan.attachments_of(self.step).iter().filter(|a| matches!(a.role, Role::Color(_)))
    }

    /// Returns `true` if an earlier pass of the step attaches a part of an access.
    fn drawn(&self, access: &Access) -> bool {
        let parts = |range| self.ctx.parts.covered(access.resource, range);
        self.before().any(|(_, t)| {
            t.access.kind.is_attachment()
                && t.resource == access.resource
                && parts(access.range).any(|p| parts(t.range).any(|q| p == q))
        })
    }

    /// Compares an attachment of the step with an access. Returns two flags: same level, layers and view format; some
    /// common layers.
    fn shows(&self, row: &Attachment, access: &Access) -> (bool, bool) {
        let layers = access.range.layer_range(self.ctx.parts.counts(access.resource)[1]);
        let own = layers_of(row);
        let level = row.resource == access.resource && row.mip == access.range.mip;
        let same = own == layers && row.view == access.range.view;
        (level && same, level && own.start < layers.end && layers.start < own.end)
    }

    /// Returns `true` if the pass shares no attachment with the step, uses another one in the same slot, or overlaps
    /// one partly.
    fn colors_differ(&self) -> bool {
        let shares = self.attachments().any(|a| self.attached(a));
        let colors = || self.attachments().filter(|a| a.kind == AccessKind::Color);
        let taken = || colors().any(|a| self.colors().any(|r| r.role == Role::Color(a.slot) && !self.shows(r, a).0));
        let mut rows = self.ctx.plan.attachments_of(self.step).iter();
        let crosses = rows.any(|r| colors().any(|a| matches!(self.shows(r, a), (false, true)) || is_target(r, a)));
        !shares || crosses || !self.ctx.plan.caps().slot_mapping && taken()
    }

    /// Returns `true` if the pass uses a color attachment of the step in another slot.
    fn placed_elsewhere(&self) -> bool {
        let mut colors = self.attachments().filter(|a| a.kind == AccessKind::Color);
        colors.any(|a| self.colors().any(|r| self.shows(r, a).0 && r.role != Role::Color(a.slot)))
    }

    /// Returns the number and size of the color attachments of the step including the pass.
    fn weight(&self) -> Weight {
        let own = self.accesses.iter().filter(|a| a.kind == AccessKind::Color && !self.attached(a));
        let slot = |role: Role| if let Role::Color(slot) = role { slot } else { u8::MAX };
        let all = self.colors().map(|a| (slot(a.role), a.resource)).chain(own.map(|a| (a.slot, a.resource)));
        let mut all: Vec<_> = all.collect();
        all.sort_by_key(|(slot, _)| *slot);
        Weight::of(all.into_iter().filter_map(|(_, r)| self.ctx.format(r)))
    }

    /// Returns `true` if the pass reads from memory what the step draws, or draws what the step reads from memory.
    fn sampled_elsewhere(&self) -> bool {
        let depth = self.ctx.plan.caps().sample_read_only_depth;
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

    /// Returns `true` if the pass changes an attachment that the step resolves, or resolves it again.
    fn resolve_between(&self) -> bool {
        // Resolves of earlier passes, in the store or after the step.
        let resolved = |resource: ResourceId| {
            let mut made = self.before().filter(|(_, t)| t.access.kind == AccessKind::Resolve);
            made.any(|(pass, resolve)| {
                let mut own = self.ctx.graph.accesses_of(pass).iter();
                own.any(|a| attaches_samples(a, &resolve.access) && a.resource == resource)
            })
        };
        self.accesses.iter().any(|a| match a.kind {
            AccessKind::Color | AccessKind::Depth => resolved(a.resource),
            AccessKind::Resolve => {
                let mut samples = self.accesses.iter().filter(|s| attaches_samples(s, a));
                samples.any(|s| resolved(s.resource)) || self.touched(a, |b| b.kind.is_attachment())
            }
            _ => false,
        })
    }

    /// Returns `true` if the pass and the step access a resource that one of them writes in memory.
    pub(super) fn storage_hazard(&self) -> bool {
        let stored = |x: &Access| !x.kind.is_attachment() && x.mode.writes();
        self.accesses.iter().any(|a| self.touched(a, |b| stored(a) || stored(b)))
    }
}

/// Returns `true` if an attachment of a step is a resolve target of the resource of an access.
fn is_target(row: &Attachment, access: &Access) -> bool {
    resolves::is_target(row.role) && row.resource == access.resource
}
