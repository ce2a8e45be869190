//! A plan as a stream of commands, in the terms of Vulkan: what a back end that knows nothing of graphs does, in order.

use crate::hand_over::hand_overs;
use crate::layout::QueueId;
use crate::memory::SharedMemory;
use crate::schedule::{Schedule, Wait};
use framegraph::{Join, PassId, Placement, Plan, ResourceId, SlotId, StepId};

/// Where the memory of a resource comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// In the heap of its kind ([`Command::Heap`]), at this offset in bytes.
    Heap {
        /// Bytes from the begin of the heap.
        offset: u64,
    },
    /// It is this texture or buffer of the pool ([`framegraph::Plan::slots`]), which other resources are at other times.
    Slot(SlotId),
    /// Memory of its own that outlives the frame.
    Own,
    /// In the tile alone: lazily allocated, or none.
    Tile,
    /// It is there before the frame: imported.
    External,
}

/// One thing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Allocate a heap.
    Heap {
        /// It is that of buffers; of a plan with one heap for all, both are that of textures. Memory that is shared by a schedule
        /// has one of each.
        of_buffers: bool,
        /// Its size.
        bytes: u64,
    },
    /// Make a texture or buffer, with the usage and the shape that the plan says ([`framegraph::Plan::resources`]).
    Create {
        /// Which.
        resource: ResourceId,
        /// From what.
        memory: Memory,
        /// Several queues read it at once, so none owns it (Vulkan's `VK_SHARING_MODE_CONCURRENT`, if they are of different families);
        /// else it is handed over by transfers.
        concurrent: bool,
    },
    /// The queue waits until a semaphore is signalled.
    Wait {
        /// The queue that waits.
        queue: QueueId,
        /// Counted from 0.
        semaphore: u32,
    },
    /// The queue gets a resource that another released: the second half of a transfer of ownership.
    Acquire {
        /// The queue that gets it.
        queue: QueueId,
        /// Index into [`Schedule::transfers`].
        transfer: u32,
    },
    /// All that the queue did so far to a resource is over, and written, before it goes on: another gets memory that this one had.
    /// The other's own barriers come next, and its contents are undefined.
    HandOver {
        /// Where it is recorded.
        queue: QueueId,
        /// Who had the memory.
        from: ResourceId,
        /// Who gets it.
        to: ResourceId,
    },
    /// A barrier: layout transition, hand-over of memory, or wait.
    Barrier {
        /// Where it is recorded.
        queue: QueueId,
        /// Index into [`framegraph::Plan::barriers`].
        barrier: u32,
        /// What it waits for is waited for in front of all stages already, by a semaphore or a
        /// [`HandOver`](Command::HandOver): in the place of stages before it names those that wait, so that it comes behind.
        /// So does each first use of a part in memory that a schedule shares.
        behind_semaphore: bool,
    },
    /// Begin a render pass with the step's attachments, or compute or copy work.
    Begin {
        /// Where it runs.
        queue: QueueId,
        /// The step.
        step: StepId,
    },
    /// Record a pass.
    Pass {
        /// Where it runs.
        queue: QueueId,
        /// The pass.
        pass: PassId,
        /// How it came into its step; what is [inlined](Join::Inlined) is part of the shader before it and not here.
        join: Join,
    },
    /// End what was begun.
    End {
        /// Where it runs.
        queue: QueueId,
        /// The step.
        step: StepId,
    },
    /// The first half of a transfer of ownership.
    Release {
        /// The queue that gives it.
        queue: QueueId,
        /// Index into [`Schedule::transfers`].
        transfer: u32,
    },
    /// Signal a semaphore behind everything that the queue was given.
    Signal {
        /// The queue that signals.
        queue: QueueId,
        /// Counted from 0.
        semaphore: u32,
    },
}

/// The commands of a frame: on one queue, or as `schedule` has it. Those of one queue are to be recorded in their order; semaphores
/// are all that orders those of different queues. Barriers are there if the plan was made for a device that asks for them
/// ([`framegraph::Caps::explicit_barriers`]).
///
/// # Panics
/// When `schedule` is of another plan.
#[must_use]
pub fn stream(plan: &Plan, schedule: Option<&Schedule>) -> Vec<Command> {
    commands(plan, schedule, None)
}

fn commands(plan: &Plan, schedule: Option<&Schedule>, shared: Option<&SharedMemory>) -> Vec<Command> {
    let mut commands = memory(plan, schedule.map_or(&[], |schedule| &schedule.concurrent), shared);
    let handed = schedule.zip(shared).map_or_else(Vec::new, |(schedule, shared)| hand_overs(plan, schedule, shared));
    let queue_of = |step: StepId| schedule.map_or(QueueId::MAIN, |schedule| schedule.lanes[step.index()]);
    // One semaphore a wait, and one for the end of each other queue.
    let waits: &[Wait] = schedule.map_or(&[], |schedule| &schedule.waits);
    let joins: &[StepId] = schedule.map_or(&[], |schedule| &schedule.joins);
    let transfers = schedule.map_or(&[][..], |schedule| &schedule.transfers);
    let numbered = || (0_u32..).zip(transfers);
    commands.extend(
        numbered()
            .filter(|(_, t)| t.from.1.is_none())
            .map(|(transfer, t)| Command::Release { queue: t.from.0, transfer }),
    );
    let mut barriers = (0_u32..).zip(plan.barriers()).peekable();
    for step in plan.step_ids() {
        let queue = queue_of(step);
        let waited = (0_u32..).zip(waits).filter(|(_, wait)| wait.before == step);
        commands.extend(waited.map(|(semaphore, _)| Command::Wait { queue, semaphore }));
        let acquired = numbered().filter(|(_, t)| t.to.1 == Some(step));
        commands.extend(acquired.map(|(transfer, _)| Command::Acquire { queue, transfer }));
        let handed = handed.iter().filter(|row| row.before == step);
        commands.extend(handed.map(|row| Command::HandOver { queue, from: row.from, to: row.to }));
        while let Some((barrier, row)) = barriers.next_if(|(_, row)| row.before == step) {
            let behind_semaphore = match row.after.is_none() {
                true => shared.is_some_and(|shared| shared.offset(row.resource).is_some()),
                false => queue_of(row.after) != queue,
            };
            commands.push(Command::Barrier { queue, barrier, behind_semaphore });
        }
        commands.push(Command::Begin { queue, step });
        let members = plan.passes_of(step).iter().filter(|member| member.join != Join::Inlined);
        commands.extend(members.map(|member| Command::Pass { queue, pass: member.pass, join: member.join }));
        commands.push(Command::End { queue, step });
        let released = numbered().filter(|(_, t)| t.from.1 == Some(step));
        commands.extend(released.map(|(transfer, _)| Command::Release { queue, transfer }));
        let signalled = (0_u32..).zip(waits).filter(|(_, wait)| wait.after == step);
        commands.extend(signalled.map(|(semaphore, _)| Command::Signal { queue, semaphore }));
    }
    let ends = (waits.len() as u32..).zip(joins);
    commands.extend(ends.clone().map(|(semaphore, last)| Command::Signal { queue: queue_of(*last), semaphore }));
    commands.extend(ends.map(|(semaphore, _)| Command::Wait { queue: QueueId::MAIN, semaphore }));
    let back = numbered().filter(|(_, t)| t.to.1.is_none());
    commands.extend(back.map(|(transfer, t)| Command::Acquire { queue: t.to.0, transfer }));
    commands
}

/// A plan as a stream, by a call on the plan.
///
/// ```
/// use framegraph::{Caps, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, compile};
/// use framegraph_queues::{Command, PlanStream};
///
/// let mut graph = Graph::new();
/// let sky = graph.texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
/// let sky = graph.add_fn("sky", |p| p.color(sky, Intent::Overwrite))?;
/// graph.export(sky)?;
/// let mut plan = Plan::new();
/// compile(&graph, &Caps::desktop(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan)?;
/// assert!(plan.stream().iter().any(|command| matches!(command, Command::Begin { .. })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait PlanStream {
    /// [`stream()`] of one queue.
    fn stream(&self) -> Vec<Command>;

    /// [`stream()`] of the queues of a schedule of this plan.
    ///
    /// # Panics
    /// When `schedule` is of another plan.
    fn stream_on(&self, schedule: &Schedule) -> Vec<Command>;

    /// The same with memory that is shared by the schedule: each resource lies where [`share_memory`](crate::share_memory) put it, and
    /// is handed over ([`Command::HandOver`]) where a queue gets memory that it has touched before.
    ///
    /// # Panics
    /// When `schedule` or `shared` is of another plan.
    fn stream_in(&self, schedule: &Schedule, shared: &SharedMemory) -> Vec<Command>;
}

impl PlanStream for Plan {
    fn stream(&self) -> Vec<Command> {
        stream(self, None)
    }

    fn stream_on(&self, schedule: &Schedule) -> Vec<Command> {
        stream(self, Some(schedule))
    }

    fn stream_in(&self, schedule: &Schedule, shared: &SharedMemory) -> Vec<Command> {
        commands(self, Some(schedule), Some(shared))
    }
}

/// Heaps, and everything that lies in them or elsewhere.
fn memory(plan: &Plan, concurrent: &[ResourceId], shared: Option<&SharedMemory>) -> Vec<Command> {
    let is_buffer = |resource: ResourceId| plan.graph().resources()[resource.index()].desc.texture().is_none();
    let of_plan = |of_buffers: bool| {
        let own = |resource: &ResourceId| (is_buffer(*resource) && plan.caps().separate_heaps) == of_buffers;
        let end = plan.graph().resource_ids().filter(own).filter_map(|resource| {
            let row = &plan.resources()[resource.index()];
            match row.placement {
                Placement::Heap { offset } => Some(offset + row.bytes),
                _ => None,
            }
        });
        end.max().unwrap_or_default()
    };
    let [of_textures, of_buffers] = shared.map_or_else(|| [false, true].map(of_plan), |shared| shared.heap_bytes);
    let heaps = [(false, of_textures), (true, of_buffers)].into_iter().filter(|(_, bytes)| *bytes > 0);
    let mut commands: Vec<_> = heaps.map(|(of_buffers, bytes)| Command::Heap { of_buffers, bytes }).collect();
    for resource in plan.graph().resource_ids() {
        let offset = shared.and_then(|shared| shared.offset(resource));
        let memory = match (plan.resources()[resource.index()].placement, offset) {
            (Placement::Unused | Placement::Inlined, _) => continue,
            (_, Some(offset)) | (Placement::Heap { offset }, None) => Memory::Heap { offset },
            (Placement::Memoryless, None) => Memory::Tile,
            (Placement::Slot(slot), None) => Memory::Slot(slot),
            (Placement::External, None) => Memory::External,
            (Placement::Own, None) => Memory::Own,
        };
        commands.push(Command::Create { resource, memory, concurrent: concurrent.contains(&resource) });
    }
    commands
}
