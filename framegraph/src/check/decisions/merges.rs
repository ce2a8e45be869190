//! Rows on how passes came into their steps: merged, inlined, or why not.
//!
//! A refusal must name an objection that stands between the pass and the step before it (for a pass that opened a step)
//! or the passes before it (for one that joined, and was not inlined).

use super::{number, predecessor, untrue};
use crate::access::{Access, AccessKind, Mode};
use crate::check::attachments::weight;
use crate::check::case::Case;
use crate::check::finding::{Findings, Place};
use crate::decision::{Reason, Refusal};
use crate::graph::{PassFlags, PassKind};
use crate::id::{PassId, ResourceId, StepId};
use crate::plan::{Attachment, Join, Role, StepPass};

/// A pass and the step that it joined or did not join.
pub(super) struct Meeting<'c, 'p> {
    pub(super) case: &'c Case<'p>,
    pub(super) pass: PassId,
    pub(super) accesses: &'p [Access],
    /// The step.
    pub(super) step: StepId,
    /// The step's passes before the pass.
    pub(super) members: &'p [StepPass],
}

/// Examines the rows on one pass.
pub(super) fn merges(case: &Case<'_>, pass: PassId, reasons: &[Reason], findings: &mut Findings<'_>) {
    let place = Place::pass(pass);
    let (mut merged, mut split, mut refused) = (0, 0, 0);
    let meeting = Meeting::of(case, pass);
    let join = case.position[pass.index()].map(|p| case.plan.step_passes()[p].join);
    for &reason in reasons {
        let holds = match reason {
            Reason::MergedAttachments(with) => {
                merged += 1;
                join == Some(Join::Attachments) && predecessor(case, pass) == Some(with)
            }
            Reason::MergedSamePixel(with) => {
                merged += 1;
                join == Some(Join::SamePixel) && predecessor(case, pass) == Some(with)
            }
            Reason::MergedInline(with) => {
                merged += 1;
                join == Some(Join::Inlined) && meeting.as_ref().is_some_and(|m| m.last_producer() == Some(with))
            }
            Reason::Split(with, why) => {
                split += 1;
                join == Some(Join::First) && meeting.as_ref().is_some_and(|m| m.split(with, why))
            }
            Reason::NotInlined(with, why) => {
                refused += 1;
                let holds = |m: &Meeting<'_, '_>| predecessor(case, pass) == Some(with) && m.not_inlined(why);
                join != Some(Join::Inlined) && meeting.as_ref().is_some_and(holds)
            }
            _ => continue,
        };
        if !holds {
            untrue(findings, case, place, reason);
        }
    }
    let opens = join == Some(Join::First) && meeting.is_some();
    let joins = join.is_some_and(|j| j != Join::First);
    number(findings, place, "its merge", merged, usize::from(joins));
    number(findings, place, "its split", split, usize::from(opens));
    let wanted = meeting.is_some_and(|m| m.wants_to_be_inlined()) && join != Some(Join::Inlined);
    number(findings, place, "its inlining", refused, usize::from(wanted));
}

impl<'c, 'p> Meeting<'c, 'p> {
    /// The step that a running pass met; none for the first pass of all.
    fn of(case: &'c Case<'p>, pass: PassId) -> Option<Self> {
        let before = predecessor(case, pass)?;
        let step = case.plan.pass_steps()[before.index()];
        let members = case.plan.passes_of(step);
        let end = members.iter().position(|m| m.pass == pass);
        Some(Self {
            case,
            pass,
            accesses: case.graph.accesses_of(pass),
            step,
            members: &members[..end.unwrap_or(members.len())],
        })
    }

    pub(super) fn flag(&self, pass: PassId, flag: PassFlags) -> bool {
        self.case.graph.passes()[pass.index()].flags.has(flag)
    }

    fn kind(&self, pass: PassId) -> PassKind {
        self.case.graph.passes()[pass.index()].kind
    }

    /// The accesses that the step's passes made before the pass, inlined ones left out, with what they touch.
    pub(super) fn before(&self) -> impl Iterator<Item = (PassId, crate::check::case::Touch<'p>)> {
        let running = self.members.iter();
        running.flat_map(|m| {
            let touches = self.case.touches(*m).filter(|t| !t.in_shader);
            touches.map(|t| (m.pass, t))
        })
    }

    /// Whether an earlier pass of the step shows a spot as color or depth.
    fn shows(&self, access: &Access) -> bool {
        self.case.shown_by(self.members, access.resource, access.range)
    }

    pub(super) fn touched(&self, resource: ResourceId, which: impl Fn(&Access) -> bool) -> bool {
        self.before().any(|(_, t)| t.resource == resource && which(t.access))
    }

    fn wants_to_be_inlined(&self) -> bool {
        let enabled = self.case.plan.options().inline && self.case.plan.caps().inline;
        let rasters = self.kind(self.pass) == PassKind::Raster && self.case.is_raster(self.step);
        enabled && rasters && self.flag(self.pass, PassFlags::POINTWISE)
    }

    /// Whether the objection to sharing the step stands.
    fn split(&self, with: PassId, why: Refusal) -> bool {
        let (case, caps, options) = (self.case, self.case.plan.caps(), self.case.plan.options());
        let last = self.members.last().map(|m| m.pass);
        let raster = self.kind(self.pass) == PassKind::Raster;
        let both = raster && case.is_raster(self.step);
        let partner = match why {
            Refusal::ComputeBetween => self.last_raster(),
            _ => last,
        };
        if partner != Some(with) {
            return false;
        }
        let row = &case.plan.steps()[self.step.index()];
        match why {
            Refusal::NotRaster => !both && (!raster || self.last_raster().is_none()),
            Refusal::ComputeBetween => !both && raster,
            _ if !both => false,
            Refusal::Disabled => !options.merge || !caps.merge_attachments,
            Refusal::NeverMerge => {
                let mut passes = self.members.iter().map(|m| m.pass).chain([self.pass]);
                passes.any(|p| self.flag(p, PassFlags::NEVER_MERGE))
            }
            Refusal::Extent => self.shape().0 != row.extent,
            Refusal::Samples => self.shape().1 != row.samples,
            Refusal::Layers => self.shape().2 != row.layers,
            Refusal::ColorsDiffer => self.colors_differ(),
            Refusal::DepthDiffers => self.accesses.iter().any(|a| {
                let mut depth = self.before().filter(|(_, t)| t.access.kind.is_depth());
                a.kind.is_depth() && depth.next().is_some() && !self.shows(a)
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
                !caps.same_pixel && reads.any(|a| self.shows(a))
            }
            Refusal::ClearBetween => {
                let clears = |a: &&Access| a.mode == Mode::Clear && a.kind.is_attachment();
                self.accesses.iter().filter(clears).any(|a| self.shows(a))
            }
            Refusal::ResolveBetween => self.resolve_between(),
            Refusal::StorageHazard => self.storage_hazard(),
            _ => false,
        }
    }

    /// The last raster pass that ran before the pass.
    fn last_raster(&self) -> Option<PassId> {
        let position = self.case.position[self.pass.index()]?;
        let mut earlier = self.case.order[..position].iter().rev();
        earlier.find(|p| self.kind(**p) == PassKind::Raster).copied()
    }

    /// Size, samples and layers of the pass's attachments.
    fn shape(&self) -> ([u32; 2], u8, u32) {
        let shown = |a: &&Access| a.kind.is_attachment() && a.kind != AccessKind::Resolve;
        let first = self.accesses.iter().find(shown).and_then(|a| {
            let texture = self.case.graph.resources()[a.resource.index()].desc.texture()?;
            let layers = a.range.layer_range(texture.tracked_layers()).len() as u32;
            let extent = texture.mip_extent(self.case.plan.frame(), a.range.mip.into());
            Some((extent, texture.samples, layers))
        });
        first.unwrap_or(([0; 2], 1, 0))
    }

    /// The pass shares no attachment with the step, or would find one in another slot.
    fn colors_differ(&self) -> bool {
        let attached = |a: &&Access| a.kind.is_attachment() && a.kind != AccessKind::Resolve;
        let shares = self.accesses.iter().filter(attached).any(|a| self.shows(a));
        let slots = self.accesses.iter().filter(|a| a.kind == AccessKind::Color).any(|a| {
            let rows = self.case.plan.attachments_of(self.step).iter();
            let here = |r: &Attachment| r.resource == a.resource && r.mip == a.range.mip;
            let mut colors = rows.filter(|r| matches!(r.role, Role::Color(_)));
            colors.any(|r| (r.role == Role::Color(a.slot)) != here(r))
        });
        !shares || slots
    }

    /// Color attachments and bytes a sample of the step with the pass.
    fn weight(&self) -> (u32, u32) {
        let rows = self.case.plan.attachments_of(self.step).iter();
        let of_step = rows.filter(|a| matches!(a.role, Role::Color(_))).map(|a| a.resource);
        let own = self.accesses.iter().filter(|a| a.kind == AccessKind::Color && !self.shows(a));
        let all = of_step.chain(own.map(|a| a.resource));
        weight(all.filter_map(|r| self.case.format(r)))
    }

    /// The pass reads in memory what the step draws, or draws what the step reads there.
    fn sampled_elsewhere(&self) -> bool {
        let depth = self.case.plan.caps().sample_read_only_depth;
        self.accesses.iter().any(|a| {
            let in_memory = |b: &Access| !b.kind.is_attachment();
            if a.kind.is_attachment() && (a.mode.writes() || !depth) {
                self.touched(a.resource, in_memory)
            } else if a.kind.is_attachment() {
                false
            } else {
                self.touched(a.resource, |b| b.mode.writes() || (b.kind == AccessKind::DepthReadOnly && !depth))
                    || self.touched(a.resource, |b| b.kind == AccessKind::Resolve)
            }
        })
    }

    /// The pass changes an attachment that the step resolves, or resolves a second time.
    fn resolve_between(&self) -> bool {
        let rows = self.case.plan.attachments_of(self.step);
        let resolved = |resource: ResourceId| {
            rows.iter().any(|a| {
                let target = |b: &Attachment| matches!((a.role, b.role), (Role::Color(x), Role::Resolve(y)) if x == y);
                a.resource == resource && rows.iter().any(target)
            })
        };
        self.accesses.iter().any(|a| match a.kind {
            AccessKind::Color => resolved(a.resource),
            AccessKind::Resolve => self.touched(a.resource, |b| b.kind.is_attachment()),
            _ => false,
        })
    }

    /// The pass and the step touch something that one of them writes in memory.
    pub(super) fn storage_hazard(&self) -> bool {
        self.accesses.iter().any(|a| {
            let stored = |x: &Access| !x.kind.is_attachment() && x.mode.writes();
            self.touched(a.resource, |b| stored(a) || stored(b))
        })
    }
}
