//! Inlining: producers of an inlined pass, and objections to an epilogue.

use super::merges::Candidate;
use crate::check::attachments::Weight;
use crate::check::hazards::{fits_shader, same_shape};
use crate::check::rule_input::{Replaced, only};
use framegraph::access::{Access, AccessKind, Mode, Range};
use framegraph::decision::Refusal;
use framegraph::graph::PassFlags;
use framegraph::id::{PassId, ResourceId};
use framegraph::plan::{Join, Role};
use framegraph::resolve::ResolveMode;

impl Candidate<'_, '_> {
    /// Returns the only same-pixel read of the pass.
    fn input(&self) -> Option<&Access> {
        only(self.accesses, |a| a.kind == AccessKind::SamePixel)
    }

    /// Returns the last pass of the step, other than epilogues, that draws the input of an inlined pass.
    pub(super) fn last_producer(&self) -> Option<PassId> {
        let output = only(self.accesses, |a| a.kind == AccessKind::Color)?;
        let target = self.ctx.effective(output.resource, output.range);
        let samples = self.samples();
        let mut running = self.members.iter().rev().filter(|m| m.join != Join::Inlined);
        let draws = |m| {
            let mut uses = self.ctx.planned_accesses(m).filter(|t| t.access.kind == AccessKind::Color);
            uses.any(|t| (t.resource, t.range) == target || samples.contains(&t.resource))
        };
        running.find(|m| draws(**m)).map(|m| m.pass)
    }

    /// Returns the attachments that are resolved into the pass's same-pixel input.
    fn samples(&self) -> Vec<ResourceId> {
        let Some(input) = self.input() else {
            return Vec::new();
        };
        let target = self.ctx.effective(input.resource, input.range).0;
        let rows = self.ctx.plan.attachments_of(self.step).iter();
        let slot = rows.filter(|a| a.resource == target).find_map(|a| match a.role {
            Role::ResolveTarget(slot, _) => Some(slot),
            _ => None,
        });
        self.colors().filter(|a| slot.is_some_and(|s| a.role == Role::Color(s))).map(|a| a.resource).collect()
    }

    /// Returns `true` if the objection to becoming an epilogue exists.
    pub(super) fn not_inlined(&self, why: Refusal) -> bool {
        let flag = |pass: &PassId, flag| self.ctx.flag(*pass, flag);
        if why == Refusal::NeverMerge {
            return self.stays_alone();
        }
        if why == Refusal::SideEffect {
            return flag(&self.pass, PassFlags::SIDE_EFFECT);
        }
        if why == Refusal::RoomForLater {
            return self.room_for_later();
        }
        let output = only(self.accesses, |a| a.mode.writes() || a.kind.is_attachment());
        let output = output.filter(|a| a.kind == AccessKind::Color);
        let (Some(input), Some(output)) = (self.input(), output) else {
            return why == Refusal::NotPointwise;
        };
        let producers = self.producers(input.resource);
        match why {
            Refusal::BuildsOnContents => {
                let first = |p: &PassId| {
                    let mut colors = self.ctx.graph.accesses_of(*p).iter();
                    colors.any(|a| a.kind == AccessKind::Color && a.mode == Mode::Modify)
                };
                let blends = flag(&self.pass, PassFlags::BLENDS);
                blends || output.mode == Mode::Modify || producers.first().is_some_and(first)
            }
            Refusal::SampledElsewhere => {
                let mut others = self.accesses.iter().filter(|a| a.kind != AccessKind::SamePixel);
                others.any(|a| self.touched(a, |_| true))
            }
            Refusal::DrawnElsewhere => producers.is_empty(),
            Refusal::NeededAsTexture => self.needed_as_texture(input.resource),
            Refusal::TargetShape => {
                let Access { resource: target, range, .. } = *output;
                let same = same_shape(self.ctx, input.resource, Replaced { by: self.pass, target, range });
                let is_part = |a: &Access| {
                    let parts = &self.ctx.parts;
                    let draws =
                        matches!(a.kind, AccessKind::Color | AccessKind::Resolve) && a.resource == input.resource;
                    draws && parts.covered(a.resource, a.range).count() != parts.all(a.resource).len()
                };
                !same
                    || self.members.iter().any(|m| self.ctx.graph.accesses_of(m.pass).iter().any(is_part))
                    || input.range.view.is_some()
                    || !self.ctx.texture(target).is_some_and(|t| t.format.is_resolvable())
            }
            Refusal::Blends => producers.iter().any(|p| flag(p, PassFlags::BLENDS)),
            Refusal::NoEpilogue => {
                producers.is_empty() || !producers.iter().all(|p| flag(p, PassFlags::TAKES_EPILOGUE))
            }
            Refusal::TooManyAttachments | Refusal::TileMemory => self.too_heavy(input, output),
            Refusal::ResolveMode => self.members.iter().any(|m| {
                let mut into = self.ctx.accesses_of(m.pass).filter(|(_, a)| a.resource == input.resource);
                let target = self.ctx.texture(output.resource).map(|t| t.format);
                let target = target.is_some_and(|f| !self.ctx.plan.caps().averages(f));
                into.any(|(id, a)| {
                    let other = a.resolve != ResolveMode::Average || self.ctx.is_full_screen(id) || target;
                    a.kind == AccessKind::Resolve && other
                })
            }),
            Refusal::StorageHazard => self.storage_hazard(),
            Refusal::TooManyBindings => {
                let inlined: Vec<_> = self.members.iter().filter(|m| m.join == Join::Inlined).map(|m| m.pass).collect();
                let exceeds = |producer: &PassId| {
                    let shader = [inlined.as_slice(), &[*producer, self.pass]].concat();
                    !fits_shader(self.ctx, &shader, input.resource)
                };
                producers.iter().filter(|pass| !inlined.contains(pass)).any(exceeds)
            }
            _ => false,
        }
    }

    /// Returns the passes of the step that draw into a resource, or into the samples resolved into it, in order.
    fn producers(&self, input: ResourceId) -> Vec<PassId> {
        let (target, _) = self.ctx.effective(input, Range::ALL);
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

    /// Returns `true` if a resource, or the samples resolved into it, must survive or has uses other than the step's
    /// producers.
    fn needed_as_texture(&self, input: ResourceId) -> bool {
        let ctx = self.ctx;
        self.samples().into_iter().chain([input]).any(|resource| {
            let others = ctx.users[resource.index()].iter().any(|(pass, access)| {
                let draws = matches!(access.kind, AccessKind::Color | AccessKind::Resolve);
                let here = self.members.iter().any(|m| m.pass == *pass);
                let reads_it = *pass == self.pass && access.kind == AccessKind::SamePixel;
                !(reads_it || draws && here)
            });
            !ctx.is_transient(resource) || others
        })
    }

    /// Returns `true` if the step would exceed the attachment limit or the tile memory with the target instead of the
    /// input.
    fn too_heavy(&self, input: &Access, output: &Access) -> bool {
        let caps = self.ctx.plan.caps();
        let input = self.ctx.effective(input.resource, input.range).0;
        let samples = self.samples();
        let formats = self.colors().filter_map(|a| {
            let replaced = a.resource == input || samples.contains(&a.resource);
            self.ctx.format(if replaced { output.resource } else { a.resource })
        });
        let (weight, tile) = (Weight::of(formats), caps.tile_bytes_per_pixel);
        !weight.fits(caps) || (tile != 0 && weight.bytes * u32::from(self.ctx.step(self.step).samples) > tile)
    }
}
