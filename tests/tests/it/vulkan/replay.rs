//! A replayer that knows a plan's tables and its stream, but no graph: each command becomes Vulkan calls.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use crate::vulkan::device::{Device, Object, Trouble};
use crate::vulkan::memory::{Objects, Thing};
use crate::vulkan::states::{accesses, layout, planes, stages};
use crate::vulkan::work::Works;
use ash::vk;
use framegraph::{Barrier, Desc, Dimension, Entry, Format, Kind, Plan, ResourceId, State};
use framegraph_queues::{Command, QueueId};
use std::collections::BTreeMap;

/// Commands being recorded for one queue.
struct Lane {
    commands: vk::CommandBuffer,
    waits: Vec<vk::Semaphore>,
    /// True if nothing is recorded yet.
    fresh: bool,
}

/// A stream being executed. All queues of the plan map to one device queue; semaphores are still submitted, signaled
/// and waited for as in the stream.
pub struct Replay<'a> {
    device: &'a Device,
    plan: &'a Plan,
    objects: Objects,
    works: Works,
    /// Current layout of each part of each image.
    layouts: BTreeMap<(Thing, u32), vk::ImageLayout>,
    lanes: BTreeMap<QueueId, Lane>,
    semaphores: BTreeMap<u32, vk::Semaphore>,
    pool: vk::CommandPool,
    /// Open step of each queue.
    open: BTreeMap<QueueId, usize>,
    /// Numbers of passes, barriers and submissions so far.
    pub passes: usize,
    pub barriers: usize,
    pub submissions: usize,
}

impl<'a> Replay<'a> {
    pub fn new(device: &'a Device, plan: &'a Plan) -> Result<Self, Trouble> {
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(device.family);
        // SAFETY: the family is the device's.
        let pool = unsafe { device.raw.create_command_pool(&info, None)? };
        device.keep(Object::Commands(pool));
        Ok(Self {
            device,
            plan,
            objects: Objects::default(),
            works: Works::default(),
            layouts: BTreeMap::new(),
            lanes: BTreeMap::new(),
            semaphores: BTreeMap::new(),
            pool,
            open: BTreeMap::new(),
            passes: 0,
            barriers: 0,
            submissions: 0,
        })
    }

    /// Executes a frame and waits for it. The first frame creates the stream's objects.
    pub fn frame(&mut self, commands: &[Command]) -> Result<(), Trouble> {
        let is_made = |command: &Command| matches!(command, Command::Heap { .. } | Command::Create { .. });
        if self.objects.frame == 0 {
            commands.iter().filter(|c| is_made(c)).try_for_each(|c| self.run(c))?;
        }
        self.enter()?;
        commands.iter().filter(|c| !is_made(c)).try_for_each(|c| self.run(c))?;
        let lanes: Vec<_> = self.lanes.keys().copied().collect();
        lanes.into_iter().try_for_each(|queue| self.submit(queue, None))?;
        // SAFETY: the device is open.
        unsafe { self.device.raw.device_wait_idle()? };
        self.objects.frame += 1;
        self.semaphores.clear();
        Ok(())
    }

    fn run(&mut self, command: &Command) -> Result<(), Trouble> {
        match *command {
            Command::Heap { of_buffers, bytes } => self.objects.heap(self.device, self.plan, of_buffers, bytes),
            // All queues belong to one family, so concurrent use needs nothing.
            Command::Create { resource, memory, concurrent: _ } => {
                self.objects.create(self.device, self.plan, resource, memory)
            }
            Command::Signal { queue, semaphore } => {
                self.lane(queue)?;
                let signal = self.semaphore(semaphore)?;
                self.submit(queue, Some(signal))
            }
            Command::Wait { queue, semaphore } => {
                let wait = self.semaphore(semaphore)?;
                if self.lanes.get(&queue).is_some_and(|lane| !lane.fresh) {
                    self.submit(queue, None)?;
                }
                self.lane(queue)?;
                self.lanes.entry(queue).and_modify(|lane| lane.waits.push(wait));
                Ok(())
            }
            // All queues belong to one family, so ownership needs no transfer.
            Command::Release { .. } | Command::Acquire { .. } => Ok(()),
            Command::AliasingBarrier { queue, .. } => self.wait_for_all(queue),
            Command::Barrier { queue, barrier, behind_semaphore } => {
                self.barriers += 1;
                self.barrier(queue, &self.plan.barriers()[barrier as usize], behind_semaphore)
            }
            Command::Begin { queue, step } => {
                self.open.insert(queue, step.index());
                let commands = self.record(queue)?;
                let layouts = &self.layouts;
                let of = |thing, part| layouts.get(&(thing, part)).copied().unwrap_or_default();
                self.works.begin(self.device, self.plan, &self.objects, step, commands, of)
            }
            Command::Pass { queue, pass, join } => {
                self.passes += 1;
                let step = *self.open.get(&queue).ok_or("a pass outside of a step")?;
                let commands = self.record(queue)?;
                let layouts = &self.layouts;
                let of = |thing, part| layouts.get(&(thing, part)).copied().unwrap_or_default();
                self.works.pass(self.device, self.plan, &self.objects, (step, pass, join), commands, of)
            }
            Command::End { queue, step } => {
                let commands = self.record(queue)?;
                if self.works.ends(self.plan, step) {
                    // SAFETY: `begin` began a render pass in these commands.
                    unsafe { self.device.raw.cmd_end_render_pass(commands) };
                }
                Ok(())
            }
        }
    }

    /// Acts as the owner of imported resources: puts defined contents into the layout that the plan expects on entry.
    fn enter(&mut self) -> Result<(), Trouble> {
        let graph = self.plan.graph();
        for id in graph.resource_ids() {
            let resource = &graph.resources()[id.index()];
            let wanted = match resource.kind {
                Kind::Imported { entry: Entry::Left { state, .. }, .. } if state != State::Undefined => layout(state),
                kind if kind.defined_on_entry() => vk::ImageLayout::GENERAL,
                _ => continue,
            };
            let Ok(Thing::Image(image)) = self.objects.of(self.plan, id) else { continue };
            let is_left = matches!(resource.kind, Kind::Imported { entry: Entry::Left { .. }, .. });
            for part in 0..resource.desc.subresources(self.plan.frame()) {
                let had = self.layouts.get(&(Thing::Image(image), part)).copied();
                if had.is_some() && !is_left {
                    continue;
                }
                let all = vk::PipelineStageFlags::ALL_COMMANDS;
                let range = self.part(id, part)?;
                let barrier = moved(image, range, had.unwrap_or_default(), wanted);
                let commands = self.record(QueueId::MAIN)?;
                // SAFETY: the image is of this device, and nothing uses it: the frame before is over.
                unsafe {
                    let none = vk::DependencyFlags::empty();
                    self.device.raw.cmd_pipeline_barrier(commands, all, all, none, &[], &[], &[barrier]);
                }
                self.layouts.insert((Thing::Image(image), part), wanted);
            }
        }
        if self.lanes.contains_key(&QueueId::MAIN) {
            self.submit(QueueId::MAIN, None)?;
        }
        // SAFETY: the device is open.
        unsafe { self.device.raw.device_wait_idle()? };
        Ok(())
    }

    /// Returns level, layer and plane of a part.
    fn part(&self, id: ResourceId, part: u32) -> Result<vk::ImageSubresourceRange, Trouble> {
        let Desc::Texture(desc) = self.plan.graph().resources()[id.index()].desc else {
            return Err("a buffer has no parts in a layout".into());
        };
        let (format, mips): (Format, u32) =
            (self.plan.format(id).unwrap_or(desc.format), desc.mip_count(self.plan.frame()));
        if format.planes() > 1 {
            return Err("planes apart are not replayed".into());
        }
        let layer = if desc.dimension == Dimension::D3 { 0 } else { part / mips };
        Ok(vk::ImageSubresourceRange {
            aspect_mask: planes(format, framegraph::Aspect::All),
            base_mip_level: part % mips,
            level_count: 1,
            base_array_layer: layer,
            layer_count: 1,
        })
    }

    fn barrier(&mut self, queue: QueueId, row: &Barrier, behind_semaphore: bool) -> Result<(), Trouble> {
        let thing = self.objects.of(self.plan, row.resource)?;
        let to_stages = stages(row.to_stages, vk::PipelineStageFlags::BOTTOM_OF_PIPE);
        let (reads, writes) = accesses(row.to_stages, row.to);
        let from = if row.aliases.is_none() { row.from } else { State::Undefined };
        // A semaphore wait at all stages precedes, so the barrier depends on the stages that it names.
        let (from_stages, (_, from_writes)) = match behind_semaphore {
            true => (to_stages, Default::default()),
            false => (stages(row.from_stages, vk::PipelineStageFlags::TOP_OF_PIPE), accesses(row.from_stages, from)),
        };
        let mut images = Vec::new();
        if let Thing::Image(image) = thing {
            for part in row.first_part..row.first_part + row.parts {
                let was = match row.from {
                    State::Entry => self.layouts.get(&(thing, part)).copied().unwrap_or_default(),
                    state => layout(state),
                };
                let change = moved(image, self.part(row.resource, part)?, was, layout(row.to));
                images.push(change.src_access_mask(from_writes).dst_access_mask(reads | writes));
                self.layouts.insert((thing, part), layout(row.to));
            }
        }
        let mut buffers = Vec::new();
        if let Thing::Buffer(buffer) = thing {
            let change = vk::BufferMemoryBarrier::default().buffer(buffer).size(vk::WHOLE_SIZE);
            buffers.push(change.src_access_mask(from_writes).dst_access_mask(reads | writes));
        }
        // Writes of other resources in this memory.
        let memory = [vk::MemoryBarrier::default().src_access_mask(from_writes).dst_access_mask(reads | writes)];
        let memory = if row.aliases.is_none() { &[] } else { &memory[..] };
        let commands = self.record(queue)?;
        // SAFETY: the images are of this device and live until it is cleared.
        unsafe {
            let none = vk::DependencyFlags::empty();
            self.device.raw.cmd_pipeline_barrier(commands, from_stages, to_stages, none, memory, &buffers, &images);
        }
        Ok(())
    }

    /// Waits until the queue has finished and its writes are visible.
    fn wait_for_all(&mut self, queue: QueueId) -> Result<(), Trouble> {
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let (reads, writes) = (vk::AccessFlags::MEMORY_READ, vk::AccessFlags::MEMORY_WRITE);
        let memory = [vk::MemoryBarrier::default().src_access_mask(writes).dst_access_mask(reads | writes)];
        let commands = self.record(queue)?;
        // SAFETY: the commands are being recorded, outside of a render pass.
        unsafe {
            let none = vk::DependencyFlags::empty();
            self.device.raw.cmd_pipeline_barrier(commands, all, all, none, &memory, &[], &[]);
        }
        Ok(())
    }

    fn semaphore(&mut self, number: u32) -> Result<vk::Semaphore, Trouble> {
        if let Some(known) = self.semaphores.get(&number) {
            return Ok(*known);
        }
        // SAFETY: nothing is asked of the device but that it is open.
        let made = unsafe { self.device.raw.create_semaphore(&vk::SemaphoreCreateInfo::default(), None)? };
        self.device.keep(Object::Semaphore(made));
        self.semaphores.insert(number, made);
        Ok(made)
    }

    /// Returns the command buffer of a queue.
    fn record(&mut self, queue: QueueId) -> Result<vk::CommandBuffer, Trouble> {
        let commands = self.lane(queue)?;
        self.lanes.entry(queue).and_modify(|lane| lane.fresh = false);
        Ok(commands)
    }

    fn lane(&mut self, queue: QueueId) -> Result<vk::CommandBuffer, Trouble> {
        if let Some(lane) = self.lanes.get(&queue) {
            return Ok(lane.commands);
        }
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: the pool is of this device, and goes when it is cleared; the buffer is new.
        let commands = unsafe {
            let made = self.device.raw.allocate_command_buffers(&info)?[0];
            let once = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            self.device.raw.begin_command_buffer(made, &once)?;
            made
        };
        self.lanes.insert(queue, Lane { commands, waits: Vec::new(), fresh: true });
        Ok(commands)
    }

    /// Submits the recorded commands of a queue.
    fn submit(&mut self, queue: QueueId, signal: Option<vk::Semaphore>) -> Result<(), Trouble> {
        let lane = self.lanes.remove(&queue).ok_or("nothing was recorded")?;
        let (commands, signals): (_, Vec<_>) = ([lane.commands], signal.into_iter().collect());
        let all = vec![vk::PipelineStageFlags::ALL_COMMANDS; lane.waits.len()];
        let info = vk::SubmitInfo::default()
            .command_buffers(&commands)
            .wait_semaphores(&lane.waits)
            .wait_dst_stage_mask(&all)
            .signal_semaphores(&signals);
        // SAFETY: the buffer was begun in `lane` and has not been submitted.
        unsafe {
            self.device.raw.end_command_buffer(lane.commands)?;
            self.device.raw.queue_submit(self.device.queue, &[info], vk::Fence::null())?;
        }
        self.submissions += 1;
        Ok(())
    }
}

/// Records a layout transition of some parts, without dependencies of its own.
fn moved(
    image: vk::Image,
    range: vk::ImageSubresourceRange,
    from: vk::ImageLayout,
    to: vk::ImageLayout,
) -> vk::ImageMemoryBarrier<'static> {
    vk::ImageMemoryBarrier::default()
        .old_layout(from)
        .new_layout(to)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image)
        .subresource_range(range)
}
