//! Command buffers of a part of a frame. A new one begins wherever aliased memory is reused.

use crate::device::gpu::Gpu;
use crate::execute::commands::CommandList;
use crate::execute::prepared::Prepared;
use crate::placed::alias_barriers::{AliasBarrier, alias_barriers};
use crate::placed::arenas::{Arena, Arenas};
use crate::placed::driver::{Driver, Object, PlacedTexture};
use crate::resources::realize::Realized;
use framegraph::{Plan, ResourceId, StepId};
use std::ops::Range;
use wgpu::{CommandBuffer, CommandEncoder, CommandEncoderDescriptor, TextureTransition};

/// Command buffers while they are recorded. See the [module documentation](self).
pub(crate) struct Segments<'a> {
    gpu: &'a Gpu,
    pub(crate) encoder: CommandEncoder,
    done: CommandList,
    steps: Range<u32>,
    sharing: Option<Sharing<'a>>,
}

/// Aliased resources of the frame.
struct Sharing<'a> {
    driver: &'a Driver,
    arena: &'a Arena,
    plan: &'a Plan,
    realized: &'a Realized,
    /// Activations that follow, in reverse order.
    pending: Vec<AliasBarrier>,
    /// Resources that currently own their memory.
    active: Vec<ResourceId>,
}

impl<'a> Segments<'a> {
    /// Begins recording the given steps.
    pub(crate) fn new(frame: &Prepared<'a>, arenas: &'a Arenas, steps: Range<u32>) -> Self {
        let Prepared { gpu, plan, realized, .. } = *frame;
        let sharing = arenas.current().zip(arenas.placing()).map(|(arena, driver)| {
            let mut pending = alias_barriers(plan, |resource| realized.placed_at(resource).is_some());
            if arenas.skips_alias_barriers() {
                // Without barriers, all resources are activated before the first step.
                let resources = pending.drain(..).flat_map(|a| a.resources).collect();
                pending.push(AliasBarrier { before: StepId::at(0), resources });
            }
            // Earlier parts of the frame activated and retired the resources before the first step.
            let begin = StepId::at(steps.start as usize);
            let here = pending.partition_point(|a| a.before < begin);
            let before = pending.drain(..here).flat_map(|a| a.resources);
            let active = before.filter(|r| plan.resources()[r.index()].last >= begin).collect();
            pending.reverse();
            Sharing { driver, arena, plan, realized, pending, active }
        });
        Self { gpu, encoder: encoder(gpu), done: CommandList::default(), steps, sharing }
    }

    /// Begins a step. Activates the resources that use their memory from here on.
    pub(crate) fn begin_step(&mut self, step: StepId) {
        let Some(sharing) = &mut self.sharing else { return };
        let Some(now) = sharing.pending.pop_if(|a| a.before == step) else { return };
        sharing.retire(step, &mut self.encoder);
        let before = std::mem::replace(&mut self.encoder, encoder(self.gpu));
        // Before the first step, the command buffer is still empty.
        if step.index() > self.steps.start as usize {
            self.done.push(before.finish());
        }
        self.done.push(sharing.activate(now.resources));
    }

    /// Ends the part of the frame and returns its command buffers.
    pub(crate) fn finish(mut self) -> CommandList {
        if let Some(sharing) = &mut self.sharing {
            let last = self.steps.end as usize == sharing.plan.steps().len();
            let next = if last { StepId::NONE } else { StepId::at(self.steps.end as usize) };
            sharing.retire(next, &mut self.encoder);
        }
        self.done.push(self.encoder.finish());
        self.done
    }
}

impl<'a> Sharing<'a> {
    fn texture(&self, resource: ResourceId) -> Option<&'a PlacedTexture> {
        match &self.arena.objects[self.realized.placed_at(resource)?] {
            Object::Texture(placed) => Some(placed),
            Object::Buffer(_) => None,
        }
    }

    /// Returns resources that are not used from `step` on to their resting usage, where the next frame expects them.
    fn retire(&mut self, step: StepId, encoder: &mut CommandEncoder) {
        let over = |r: &ResourceId| self.plan.resources()[r.index()].last < step;
        let (over, active): (Vec<_>, Vec<_>) = self.active.iter().copied().partition(over);
        self.active = active;
        let textures: Vec<_> = over.into_iter().filter_map(|r| self.texture(r)).collect();
        let resting_usage =
            |t: &'a PlacedTexture| TextureTransition { texture: t.texture(), selector: None, state: t.resting_usage() };
        if !textures.is_empty() {
            encoder.transition_resources(std::iter::empty(), textures.into_iter().map(resting_usage));
        }
    }

    fn activate(&mut self, resources: Vec<ResourceId>) -> CommandBuffer {
        let textures: Vec<_> = resources.iter().filter_map(|r| self.texture(*r)).collect();
        self.active.extend(resources);
        self.driver.alias_barrier(&textures)
    }
}

fn encoder(gpu: &Gpu) -> CommandEncoder {
    gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("frame") })
}
