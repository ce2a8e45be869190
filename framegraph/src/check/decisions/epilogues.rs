//! Inlining: who the producers are, and whether an objection to an epilogue stands.

use super::merges::Meeting;
use crate::access::{Access, AccessKind, Mode, Range};
use crate::check::attachments::weight;
use crate::check::case::only;
use crate::decision::Refusal;
use crate::graph::PassFlags;
use crate::id::{PassId, ResourceId};
use crate::plan::{Attachment, Join, Role, StepPass};
use crate::resource::Kind;

impl Meeting<'_, '_> {
    /// The last pass of the step that draws what an inlined pass reads, itself no epilogue.
    pub(super) fn last_producer(&self) -> Option<PassId> {
        let output = only(self.accesses, |a| a.kind == AccessKind::Color)?;
        let target = self.case.effective(output.resource, output.range);
        let draws = |m: &&StepPass| {
            let mut touches = self.case.touches(**m).filter(|t| !t.in_shader);
            let samples = |r: ResourceId| self.samples().contains(&r);
            m.join != Join::Inlined
                && touches.any(|t| {
                    t.access.kind == AccessKind::Color && ((t.resource, t.range) == target || samples(t.resource))
                })
        };
        self.members.iter().rev().find(draws).map(|m| m.pass)
    }

    /// The attachments that are resolved into what the pass reads at the same pixel.
    fn samples(&self) -> Vec<ResourceId> {
        let Some(input) = only(self.accesses, |a| a.kind == AccessKind::SamePixel) else {
            return Vec::new();
        };
        let target = self.case.effective(input.resource, input.range).0;
        let rows = self.case.plan.attachments_of(self.step);
        let resolve = |a: &&Attachment| matches!(a.role, Role::Resolve(_)) && a.resource == target;
        let Some(Role::Resolve(slot)) = rows.iter().find(resolve).map(|a| a.role) else {
            return Vec::new();
        };
        let color = rows.iter().filter(|a| a.role == Role::Color(slot));
        color.map(|a| a.resource).collect()
    }

    /// Whether the objection to becoming an epilogue stands.
    pub(super) fn not_inlined(&self, why: Refusal) -> bool {
        if why == Refusal::NeverMerge {
            let mut passes = self.members.iter().map(|m| m.pass).chain([self.pass]);
            return passes.any(|p| self.flag(p, PassFlags::NEVER_MERGE));
        }
        if why == Refusal::SideEffect {
            return self.flag(self.pass, PassFlags::SIDE_EFFECT);
        }
        let input = only(self.accesses, |a| a.kind == AccessKind::SamePixel);
        let output = only(self.accesses, |a| a.mode.writes() || a.kind.is_attachment());
        let output = output.filter(|a| a.kind == AccessKind::Color);
        let (Some(input), Some(output)) = (input, output) else {
            return why == Refusal::NotPointwise;
        };
        let producers = self.producers(input.resource);
        match why {
            Refusal::BuildsOnContents => {
                let first = |p: &PassId| {
                    let mut colors = self.case.graph.accesses_of(*p).iter();
                    colors.any(|a| a.kind == AccessKind::Color && a.mode == Mode::Modify)
                };
                let blends = self.flag(self.pass, PassFlags::BLENDS);
                blends || output.mode == Mode::Modify || producers.first().is_some_and(first)
            }
            Refusal::SampledElsewhere => {
                let others = self.accesses.iter().filter(|a| a.kind != AccessKind::SamePixel);
                let busy = |a: &Access| self.touched(a.resource, |_| true);
                producers.is_empty() || others.into_iter().any(busy)
            }
            Refusal::NeededAsTexture => self.needed_as_texture(input.resource),
            Refusal::TargetShape => !self.same_shape(input, output),
            Refusal::Blends => producers.iter().any(|p| self.flag(*p, PassFlags::BLENDS)),
            Refusal::NoEpilogue => {
                let takes = |p: &PassId| self.flag(*p, PassFlags::TAKES_EPILOGUE);
                producers.is_empty() || !producers.iter().all(takes)
            }
            Refusal::TooManyAttachments | Refusal::TileMemory => self.too_heavy(output),
            Refusal::StorageHazard => self.storage_hazard(),
            _ => false,
        }
    }

    /// The passes of the step that draw into a resource or into the samples behind it, in order.
    fn producers(&self, input: ResourceId) -> Vec<PassId> {
        let (target, _) = self.case.effective(input, Range::ALL);
        let samples = self.samples();
        let mut found = Vec::new();
        for (pass, touch) in self.before() {
            let drawn = touch.resource == target || samples.contains(&touch.resource);
            if drawn && touch.access.kind == AccessKind::Color && !found.contains(&pass) {
                found.push(pass);
            }
        }
        found
    }

    /// A resource, or the samples behind it, must survive or is used by others than the step's producers.
    fn needed_as_texture(&self, input: ResourceId) -> bool {
        let case = self.case;
        let mut all = self.samples();
        all.push(input);
        all.into_iter().any(|resource| {
            let row = &case.graph.resources()[resource.index()];
            let others = case.users[resource.index()].iter().any(|(pass, access)| {
                let draws = matches!(access.kind, AccessKind::Color | AccessKind::Resolve);
                let here = self.members.iter().any(|m| m.pass == *pass);
                let reads_it = *pass == self.pass && access.kind == AccessKind::SamePixel;
                !(reads_it || draws && here)
            });
            row.kind != Kind::Transient || case.exported[resource.index()] || others
        })
    }

    /// Whether the target of the pass has the shape of its input.
    fn same_shape(&self, input: &Access, output: &Access) -> bool {
        let graph = self.case.graph;
        let texture = |a: &Access| graph.resources()[a.resource.index()].desc.texture().copied();
        let (Some(from), Some(to)) = (texture(input), texture(output)) else {
            return false;
        };
        let frame = self.case.plan.frame();
        let extent = to.mip_extent(frame, output.range.mip.into());
        let parts = self.case.parts.covered(output.resource, output.range).count();
        let one = parts == 1 && from.layers == 1 && self.case.parts.all(input.resource).len() == 1;
        let samples = from.samples == 1 && to.samples == 1;
        one && samples && extent == from.extent.resolve(frame) && to.format.is_resolvable()
    }

    /// With the target in the place of the input, the step has more color attachments than the device or its tile holds.
    fn too_heavy(&self, output: &Access) -> bool {
        let caps = self.case.plan.caps();
        let input = only(self.accesses, |a| a.kind == AccessKind::SamePixel);
        let Some(input) = input.map(|a| self.case.effective(a.resource, a.range).0) else {
            return false;
        };
        let samples = self.samples();
        let rows = self.case.plan.attachments_of(self.step).iter();
        let colors = rows.filter(|a| matches!(a.role, Role::Color(_)));
        let formats = colors.filter_map(|a| {
            let replaced = a.resource == input || samples.contains(&a.resource);
            self.case.format(if replaced { output.resource } else { a.resource })
        });
        let (count, bytes) = weight(formats);
        let row = &self.case.plan.steps()[self.step.index()];
        let tile = caps.tile_bytes_per_pixel;
        count > u32::from(caps.max_color_attachments)
            || bytes > caps.max_color_bytes_per_sample
            || (tile != 0 && bytes * u32::from(row.samples) > tile)
    }
}
