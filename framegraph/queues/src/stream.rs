//! A plan as a sequence of commands in terms of Vulkan, for a back end without knowledge of graphs.

use crate::aliasing::aliasing_barriers;
use crate::layout::QueueId;
use crate::memory::SharedMemory;
use crate::schedule::{Schedule, Wait};
use framegraph::{Join, PassId, Placement, Plan, ResourceId, SlotId, StepId};

/// The origin of a resource's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// A range of the heap of its kind ([`Command::Heap`]).
    Heap {
        /// Offset in the heap, in bytes.
        offset: u64,
    },
    /// A texture or buffer of the pool ([`framegraph::Plan::slots`]), used by several resources one after another.
    Slot(SlotId),
    /// A separate allocation that outlives the frame.
    Own,
    /// Tile memory only: lazily allocated, or none.
    Tile,
    /// Memory of the caller: the resource is imported.
    External,
}

/// One command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Allocates a heap.
    Heap {
        /// The heap is for buffers. A plan with one heap for everything uses `false`; memory shared by a schedule has
        /// one heap of each kind.
        of_buffers: bool,
        /// Size in bytes.
        bytes: u64,
    },
    /// Creates a texture or buffer with the usage and the descriptor of the plan ([`framegraph::Plan::resources`]).
    Create {
        /// The resource.
        resource: ResourceId,
        /// Its memory.
        memory: Memory,
        /// Several queues use it concurrently, so none owns it (Vulkan's `VK_SHARING_MODE_CONCURRENT` for queues of
        /// different families). Otherwise ownership is transferred.
        concurrent: bool,
    },
    /// Waits for a semaphore.
    Wait {
        /// The waiting queue.
        queue: QueueId,
        /// Index of the semaphore.
        semaphore: u32,
    },
    /// Acquires a resource that another queue released: the second half of an ownership transfer.
    Acquire {
        /// The acquiring queue.
        queue: QueueId,
        /// Index into [`Schedule::transfers`].
        transfer: u32,
    },
    /// Waits for all previous work of the queue on a resource, and flushes its writes, because another resource reuses
    /// its memory. Barriers of the other resource follow; its contents are undefined.
    AliasingBarrier {
        /// The queue.
        queue: QueueId,
        /// The previous resource.
        from: ResourceId,
        /// The new resource.
        to: ResourceId,
    },
    /// Records a barrier: a layout transition, an aliasing barrier, or an execution dependency.
    Barrier {
        /// The queue.
        queue: QueueId,
        /// Index into [`framegraph::Plan::barriers`].
        barrier: u32,
        /// A semaphore or a [`AliasingBarrier`](Command::AliasingBarrier) already waits for the barrier's source. The barrier must
        /// use the waiting stages as source stages, so that it is ordered after that wait. Also set for each first use
        /// of a part in memory shared by a schedule.
        behind_semaphore: bool,
    },
    /// Begins a render pass with the step's attachments, or compute or copy work.
    Begin {
        /// The queue.
        queue: QueueId,
        /// The step.
        step: StepId,
    },
    /// Records a pass.
    Pass {
        /// The queue.
        queue: QueueId,
        /// The pass.
        pass: PassId,
        /// The pass's join. [Inlined](Join::Inlined) passes are part of the previous shader and have no command.
        join: Join,
    },
    /// Ends what [`Begin`](Command::Begin) began.
    End {
        /// The queue.
        queue: QueueId,
        /// The step.
        step: StepId,
    },
    /// Releases a resource: the first half of an ownership transfer.
    Release {
        /// The releasing queue.
        queue: QueueId,
        /// Index into [`Schedule::transfers`].
        transfer: u32,
    },
    /// Signals a semaphore after all previous work of the queue.
    Signal {
        /// The signaling queue.
        queue: QueueId,
        /// Index of the semaphore.
        semaphore: u32,
    },
}

/// Returns the commands of a frame, on one queue or on those of `schedule`.
///
/// Commands of one queue must be recorded in this order; only semaphores order those of different queues. Barriers are
/// included if the plan was compiled with explicit barriers ([`framegraph::Caps::explicit_barriers`]).
///
/// # Panics
/// Panics if `schedule` belongs to another plan.
#[must_use]
pub fn stream(plan: &Plan, schedule: Option<&Schedule>) -> Vec<Command> {
    commands(plan, schedule, None)
}

fn commands(plan: &Plan, schedule: Option<&Schedule>, shared: Option<&SharedMemory>) -> Vec<Command> {
    let mut commands = memory(plan, schedule.map_or(&[], |schedule| &schedule.concurrent), shared);
    let handed =
        schedule.zip(shared).map_or_else(Vec::new, |(schedule, shared)| aliasing_barriers(plan, schedule, shared));
    let queue_of = |step: StepId| schedule.map_or(QueueId::MAIN, |schedule| schedule.lanes[step.index()]);
    // One semaphore per wait, and one for the end of each other queue.
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
        commands.extend(handed.map(|row| Command::AliasingBarrier { queue, from: row.from, to: row.to }));
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

/// Returns a plan as commands, as methods of [`Plan`].
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
    /// Returns the commands of [`stream()`] for one queue.
    fn stream(&self) -> Vec<Command>;

    /// Returns the commands of [`stream()`] for the queues of a schedule.
    ///
    /// # Panics
    /// Panics if `schedule` belongs to another plan.
    fn stream_on(&self, schedule: &Schedule) -> Vec<Command>;

    /// Returns the commands for the queues of a schedule, with memory shared by [`share_memory`](crate::share_memory).
    ///
    /// Contains a [`Command::AliasingBarrier`] wherever a queue reuses memory that it has used before.
    ///
    /// # Panics
    /// Panics if `schedule` or `shared` belongs to another plan.
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

/// Returns the commands that create heaps and resources.
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
