//! Execution of the commands of one frame.

use crate::cx::{Cx, RecordError};
use crate::driver::{BufferBarrier, Object, Scope, Thing, TimelinePoint};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::imports::Imports;
use crate::lanes::{FrameSlot, Lanes};
use crate::layouts::{Layouts, parts};
use crate::prepared::Prepared;
use crate::views::Views;
use ash::vk;
use framegraph::{Counts, Entry, Format, Join, Kind, PassId, Placement, ResourceId, StepId};
use framegraph_queues::{Command, QueueId, Transfer};
use std::collections::BTreeMap;

/// A frame that is being recorded and submitted.
pub(crate) struct Run<'e> {
    pub(crate) gpu: &'e Gpu,
    pub(crate) lanes: &'e mut Lanes,
    pub(crate) slot: &'e mut FrameSlot,
    pub(crate) prepared: &'e mut Prepared,
    pub(crate) layouts: &'e mut Layouts,
    pub(crate) views: &'e mut Views,
    pub(crate) imports: &'e Imports,
    pub(crate) multiview: bool,
    pub(crate) executed: Counts,
    pub(crate) barriers: u64,
    /// Points that semaphores of the stream stand for.
    pub(crate) points: BTreeMap<u32, TimelinePoint>,
    /// Step that each queue records, and its next pass.
    pub(crate) open: Vec<Option<(StepId, usize)>>,
}

/// Function that records a pass.
pub(crate) type Recorder<'r> = &'r mut dyn FnMut(&mut Cx<'_>) -> Result<(), RecordError>;

impl Run<'_> {
    /// Records and submits the frame.
    pub(crate) fn all(&mut self, record: Recorder<'_>) -> Result<(), Error> {
        self.start()?;
        let commands = std::mem::take(&mut self.prepared.commands);
        let (mut started, mut result) = (false, Ok(()));
        for command in &commands {
            let first = matches!(command, Command::Heap { .. } | Command::Create { .. }) || self.is_initial(command);
            if !first && !started {
                started = true;
                result = self.begin_other_queues();
            }
            result = result.and_then(|()| self.command(command, &mut *record));
            if result.is_err() {
                break;
            }
        }
        self.prepared.commands = commands;
        result?;
        self.end()
    }

    fn transfer(&self, transfer: u32) -> Transfer {
        let schedule = self.prepared.schedule.as_ref().expect("streams with transfers have a schedule");
        schedule.transfers[transfer as usize]
    }

    /// Returns `true` for a release at the start of the frame.
    fn is_initial(&self, command: &Command) -> bool {
        matches!(*command, Command::Release { transfer, .. } if self.transfer(transfer).from.1.is_none())
    }

    pub(crate) fn thing(&self, id: ResourceId) -> Option<Thing> {
        self.imports.rows.get(&id).map(|row| row.thing).or_else(|| self.prepared.resources.of(id))
    }

    fn commands(&mut self, lane: usize) -> Result<vk::CommandBuffer, Error> {
        self.lanes.commands(self.gpu, self.slot, lane)
    }

    /// Waits for earlier frames, sets the layouts of imports, and clears new histories.
    fn start(&mut self) -> Result<(), Error> {
        if !self.imports.waits.is_empty() {
            self.lanes.submit(self.gpu, self.slot, 0, &self.imports.waits, &[])?;
        }
        self.lanes.rows[0].pending.memory.push(Scope::ALL);
        self.commands(0)?;
        let plan = &self.prepared.plan;
        for (id, row) in plan.graph().resource_ids().zip(plan.graph().resources()) {
            let (Some(import), Some(desc)) = (self.imports.rows.get(&id), row.desc.texture()) else { continue };
            let left = match row.kind {
                Kind::Imported { entry: Entry::Left { state, .. }, .. } => Some(state),
                _ => None,
            };
            for part in 0..parts(desc, plan.frame(), desc.format) {
                let number = part / (desc.mip_count(plan.frame()) * desc.tracked_layers());
                let state = left.map(|state| crate::convert::layout(state, desc.format, number));
                self.layouts.set(import.thing, part, state.unwrap_or(import.layout));
            }
        }
        let fresh: Vec<usize> = (0..self.prepared.resources.rings.len()).collect();
        for at in fresh {
            self.clear_ring(at)?;
        }
        Ok(())
    }

    /// Lets other queues begin when the first one has finished earlier frames and released resources.
    fn begin_other_queues(&mut self) -> Result<(), Error> {
        let queues = self.prepared.schedule.as_ref().map_or(1, |schedule| schedule.layout.queues.len());
        let used =
            |lane: &usize| self.prepared.schedule.as_ref().is_some_and(|s| s.lanes.contains(&QueueId(*lane as u8)));
        let others: Vec<usize> = (1..queues).filter(used).collect();
        if others.is_empty() {
            return Ok(());
        }
        let point = self.lanes.submit(self.gpu, self.slot, 0, &[], &[])?;
        others.into_iter().try_for_each(|lane| self.lanes.wait(self.gpu, self.slot, lane, point))
    }

    fn command(&mut self, command: &Command, record: Recorder<'_>) -> Result<(), Error> {
        match *command {
            Command::Heap { .. } | Command::Create { .. } => Ok(()),
            Command::Signal { queue, semaphore } => {
                let point = self.lanes.submit(self.gpu, self.slot, queue.index(), &[], &[])?;
                self.points.insert(semaphore, point);
                Ok(())
            }
            Command::Wait { queue, semaphore } => match self.points.get(&semaphore).copied() {
                Some(point) => self.lanes.wait(self.gpu, self.slot, queue.index(), point),
                None => Ok(()),
            },
            Command::Release { queue, transfer } => self.pass_on(queue, transfer, false),
            Command::Acquire { queue, transfer } => self.pass_on(queue, transfer, true),
            Command::AliasingBarrier { queue, .. } => {
                self.lanes.rows[queue.index()].pending.memory.push(Scope::ALL);
                self.commands(queue.index()).map(drop)
            }
            Command::Barrier { queue, barrier, behind_semaphore } => {
                self.barriers += 1;
                let row = self.prepared.plan.barriers()[barrier as usize];
                let Some(thing) = self.thing(row.resource) else { return Ok(()) };
                let pending = &mut self.lanes.rows[queue.index()].pending;
                self.layouts.barrier(&self.prepared.plan, &row, thing, behind_semaphore, pending);
                Ok(())
            }
            Command::Begin { queue, step } => self.begin(queue.index(), step),
            Command::Pass { queue, pass, join } => self.pass(queue.index(), pass, join, record),
            Command::End { queue, step } => self.end_step(queue.index(), step),
        }
    }

    /// Records one half of an ownership transfer, if the queues are of different families.
    fn pass_on(&mut self, queue: QueueId, transfer: u32, acquires: bool) -> Result<(), Error> {
        let row = self.transfer(transfer);
        let family = |queue: QueueId| self.lanes.rows[queue.index()].queue.family;
        let families = [family(row.from.0), family(row.to.0)];
        let Some(thing) = self.thing(row.resource) else { return Ok(()) };
        if families[0] == families[1] {
            return Ok(());
        }
        let mut scope = Scope { families: Some(families), ..Scope::default() };
        scope.from = vk::PipelineStageFlags2::ALL_COMMANDS;
        if acquires {
            scope.to = vk::PipelineStageFlags2::ALL_COMMANDS;
            scope.to_access = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
        } else {
            scope.from_access = vk::AccessFlags2::MEMORY_WRITE;
        }
        let plan = &self.prepared.plan;
        let pending = &mut self.lanes.rows[queue.index()].pending;
        match thing {
            Thing::Buffer(buffer) => pending.buffers.push(BufferBarrier { scope, buffer }),
            Thing::Image(_) => {
                let desc = plan.graph().resources()[row.resource.index()].desc;
                let Some(desc) = desc.texture() else { return Ok(()) };
                let format = plan.format(row.resource).unwrap_or(desc.format);
                for part in 0..parts(desc, plan.frame(), format) {
                    let layout = self.layouts.get(thing, part);
                    // Undefined contents need no owner.
                    if layout != vk::ImageLayout::UNDEFINED {
                        let one = part..part + 1;
                        let same = |_: &Layouts, _, _, _| layout;
                        self.layouts.transition(plan, row.resource, thing, one, scope, pending, same, |_, _| layout);
                    }
                }
            }
        }
        // Barriers of the resource follow.
        self.commands(queue.index()).map(drop)
    }

    fn pass(&mut self, lane: usize, pass: PassId, join: Join, record: Recorder<'_>) -> Result<(), Error> {
        let commands = self.commands(lane)?;
        let Some((step, at)) = self.open[lane] else { return Ok(()) };
        let Prepared { plan, resources, steps, .. } = &mut *self.prepared;
        let members = plan.passes_of(step);
        // Inlined passes have no command.
        let at = (at..members.len()).find(|at| members[*at].pass == pass).unwrap_or(at);
        let prepared = &steps[step.index()];
        if prepared.render_pass.is_some() && at > 0 {
            let (before, now) = (prepared.subpass_of[at - 1], prepared.subpass_of[at]);
            (before..now).for_each(|_| self.gpu.shared.driver.next_subpass(commands));
        }
        self.open[lane] = Some((step, at + 1));
        self.executed.passes += u32::from(join != Join::Resolve);
        let name = plan.graph().pass_name(pass);
        self.gpu.shared.driver.begin_label(commands, name);
        let mut cx = Cx {
            gpu: self.gpu,
            plan,
            resources,
            imports: self.imports,
            layouts: self.layouts,
            views: self.views,
            prepared,
            commands,
            step,
            at,
            queue: lane,
        };
        record(&mut cx).map_err(|source| Error::Record { pass: name.to_owned(), source })?;
        self.gpu.shared.driver.end_label(commands);
        Ok(())
    }

    fn end_step(&mut self, lane: usize, step: StepId) -> Result<(), Error> {
        let commands = self.commands(lane)?;
        if self.prepared.steps[step.index()].render_pass.is_some() {
            self.gpu.shared.driver.end_render_pass(commands);
        }
        if let Some((pool, ..)) = self.slot.queries {
            self.gpu.shared.driver.timestamp(commands, pool, 2 * step.index() as u32 + 1);
        }
        self.gpu.shared.driver.end_label(commands);
        self.open[lane] = None;
        Ok(())
    }

    /// Leaves imports in their final layouts and submits what is recorded.
    fn end(&mut self) -> Result<(), Error> {
        for (id, import) in &self.imports.rows {
            let (Some(leave), plan) = (import.leave, &self.prepared.plan) else { continue };
            // The identifier may be that of another graph.
            let Some(desc) = plan.graph().resources().get(id.index()).and_then(|row| row.desc.texture()) else {
                continue;
            };
            let all = 0..parts(desc, plan.frame(), desc.format);
            let old = |layouts: &Layouts, _: u32, _: Format, part: u32| layouts.get(import.thing, part);
            let pending = &mut self.lanes.rows[0].pending;
            self.layouts.transition(plan, *id, import.thing, all, Scope::ALL, pending, old, |_, _| leave);
        }
        for lane in 1..self.lanes.rows.len() {
            if self.lanes.has_work(lane) {
                self.lanes.submit(self.gpu, self.slot, lane, &[], &[])?;
            }
        }
        // The first queue has waited for the others, so that this covers their writes too.
        self.lanes.rows[0].pending.memory.push(Scope::TO_HOST);
        self.lanes.submit(self.gpu, self.slot, 0, &[], &self.imports.signals)?;
        let rows = self.prepared.plan.resources();
        self.executed.memoryless = rows.iter().filter(|row| row.placement == Placement::Memoryless).count() as u32;
        self.executed.culled = self.prepared.plan.pass_steps().iter().filter(|step| step.is_none()).count() as u32;
        let views = self.views.take_imported();
        // Framebuffers, which are destroyed first, are behind the views.
        let framebuffers = std::mem::replace(&mut self.slot.garbage, views);
        self.slot.garbage.extend(framebuffers);
        Ok(())
    }
}

/// An object that is destroyed when the frame has ended.
pub(crate) fn until_the_end(slot: &mut FrameSlot, framebuffer: vk::Framebuffer) {
    slot.garbage.push(Object::Framebuffer(framebuffer));
}
