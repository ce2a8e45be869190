//! Runs command streams of random plans on a simulated device that knows only the stream and the tables. Checks states
//! of parts, aliasing barriers, semaphores, and ownership.

use framegraph::{
    Access, AccessKind, Alias, Caps, Join, Options, PassKind, Placement, Plan, ResourceId, Scratch, State, compile,
};
use framegraph_check::generate::{self, Entropy, Profile};
use framegraph_queues::{
    Command, Memory, PlanStream, QueueId, QueueLayout, Schedule, Transfer, schedule, share_memory,
};
use std::collections::{BTreeMap, BTreeSet};

type TestResult = Result<(), Box<dyn std::error::Error>>;

/// The state of the simulated device.
struct Machine<'a> {
    plan: &'a Plan,
    schedule: Option<&'a Schedule>,
    created: BTreeMap<ResourceId, Memory>,
    concurrent: BTreeSet<ResourceId>,
    /// Owner of each resource with contents; `None` during a transfer.
    owners: BTreeMap<ResourceId, Option<QueueId>>,
    /// The state of each part of each resource.
    states: BTreeMap<(ResourceId, u32), State>,
    /// Aliasing barriers: queue, previous resource, new resource.
    handed: BTreeSet<(QueueId, ResourceId, ResourceId)>,
    /// The queues that used each resource.
    accessed: BTreeMap<ResourceId, BTreeSet<QueueId>>,
    /// Memory is shared by the schedule, not by the plan.
    shared: bool,
    /// Resources whose memory another resource reuses.
    gone: BTreeSet<ResourceId>,
    signalled: BTreeSet<u32>,
    open: BTreeMap<QueueId, u32>,
    ran: Vec<u32>,
}

impl Machine<'_> {
    fn run(&mut self, command: &Command) -> Result<(), String> {
        match *command {
            Command::Heap { bytes: 0, .. } => Err("empty heap".into()),
            Command::Heap { .. } => Ok(()),
            Command::Create { resource, memory, concurrent } => {
                if concurrent {
                    self.concurrent.insert(resource);
                }
                if matches!(memory, Memory::Own | Memory::External) {
                    self.owners.insert(resource, Some(QueueId::MAIN));
                }
                match self.created.insert(resource, memory) {
                    None => Ok(()),
                    Some(_) => Err(format!("resource {} is created twice", resource.index())),
                }
            }
            Command::Signal { semaphore, .. } => match self.signalled.insert(semaphore) {
                true => Ok(()),
                false => Err(format!("semaphore {semaphore} is signaled twice")),
            },
            Command::Wait { semaphore, .. } => match self.signalled.contains(&semaphore) {
                true => Ok(()),
                false => Err(format!("semaphore {semaphore} is waited for before it is signaled")),
            },
            Command::Release { queue, transfer } => {
                let transfer = self.transfer(transfer, |transfer| transfer.from.0 == queue)?;
                match self.owners.insert(transfer, None) {
                    None | Some(None) => Err(format!("resource {} is released without being owned", transfer.index())),
                    Some(Some(owner)) if owner != queue => {
                        Err(format!("queue {queue:?} releases a resource of {owner:?}"))
                    }
                    Some(Some(_)) => Ok(()),
                }
            }
            Command::Acquire { queue, transfer } => {
                let transfer = self.transfer(transfer, |transfer| transfer.to.0 == queue)?;
                match self.owners.insert(transfer, Some(queue)) {
                    Some(None) => Ok(()),
                    _ => Err(format!("resource {} is acquired, but was not released", transfer.index())),
                }
            }
            Command::Barrier { barrier, behind_semaphore, .. } => {
                let row = &self.plan.barriers()[barrier as usize];
                let in_heap = matches!(self.created.get(&row.resource), Some(Memory::Heap { .. }));
                if self.shared && in_heap && row.after.is_none() && !behind_semaphore {
                    return Err(format!("barrier {barrier} may precede the end of the previous resource"));
                }
                for part in row.first_part..row.first_part + row.parts {
                    let state = self.states.entry((row.resource, part)).or_insert(row.from);
                    if row.from != State::Undefined && *state != row.from {
                        return Err(format!("barrier {barrier} is from {}, but the part is {}", row.from, *state));
                    }
                    *state = row.to;
                }
                Ok(())
            }
            Command::AliasingBarrier { queue, from, to } => match self.open.contains_key(&queue) {
                true => Err(format!("queue {queue:?} waits within a step")),
                false => {
                    self.handed.insert((queue, from, to));
                    Ok(())
                }
            },
            Command::Begin { queue, step } => {
                self.ran.push(step.index() as u32);
                match self.open.insert(queue, step.index() as u32) {
                    None => Ok(()),
                    Some(other) => Err(format!("step {other} is still open")),
                }
            }
            Command::End { queue, step } => match self.open.remove(&queue) {
                Some(open) if open == step.index() as u32 => Ok(()),
                other => Err(format!("step {} ends, but {other:?} is open", step.index())),
            },
            Command::Pass { queue, pass, join } => {
                let step = *self.open.get(&queue).ok_or("pass outside of a step")?;
                if self.plan.pass_steps()[pass.index()].index() as u32 != step && join != Join::Resolve {
                    return Err(format!("pass {} does not belong to step {step}", pass.index()));
                }
                if self.schedule.is_some_and(|schedule| schedule.lanes[step as usize] != queue) {
                    return Err(format!("step {step} is on another queue"));
                }
                let kind = self.plan.steps()[step as usize].kind;
                let (plan, accesses) = (self.plan, self.plan.graph().accesses_of(pass));
                accesses.iter().try_for_each(|access| self.touch(access, kind, join))?;
                let lives = |access: &&Access| {
                    let placement = plan.resources()[access.resource.index()].placement;
                    !matches!(placement, Placement::Inlined | Placement::Unused | Placement::Memoryless)
                };
                accesses.iter().filter(lives).try_for_each(|access| {
                    self.own(access, queue)?;
                    self.lie(access.resource, queue)
                })
            }
        }
    }

    /// Checks a use of a resource in shared memory. The queue must have waited for its own uses of previous resources,
    /// and they must not be used again. Uses on other queues are ordered by semaphores, which have their own checker.
    fn lie(&mut self, resource: ResourceId, queue: QueueId) -> Result<(), String> {
        let is_texture = |id: ResourceId| self.plan.graph().resources()[id.index()].desc.texture().is_some();
        let span = |id: ResourceId| match self.created.get(&id) {
            Some(Memory::Heap { offset }) => Some((*offset, offset + self.plan.resources()[id.index()].bytes)),
            _ => None,
        };
        let known = self.accessed.contains_key(&resource);
        if let Some((begin, end)) = span(resource).filter(|_| self.shared && !known) {
            for (other, queues) in &self.accessed {
                let Some((other_begin, other_end)) = span(*other) else { continue };
                let overlap = is_texture(*other) == is_texture(resource) && other_begin < end && begin < other_end;
                if overlap && queues.contains(&queue) && !self.handed.contains(&(queue, *other, resource)) {
                    return Err(format!(
                        "resource {} reuses memory of {} without a wait",
                        resource.index(),
                        other.index()
                    ));
                }
                if overlap {
                    self.gone.insert(*other);
                }
            }
        }
        if self.gone.contains(&resource) {
            return Err(format!("the memory of resource {} was reused", resource.index()));
        }
        self.accessed.entry(resource).or_default().insert(queue);
        Ok(())
    }

    /// Returns the resource of a transfer of this queue.
    fn transfer(&self, index: u32, is_of: impl Fn(&Transfer) -> bool) -> Result<ResourceId, String> {
        let transfers = self.schedule.map_or(&[][..], |schedule| &schedule.transfers);
        let found = transfers.get(index as usize).filter(|transfer| is_of(transfer));
        found.map(|transfer| transfer.resource).ok_or_else(|| format!("transfer {index} belongs to another queue"))
    }

    /// Checks ownership: a queue must own what it reads and gets what it writes, except for concurrent resources.
    fn own(&mut self, access: &Access, queue: QueueId) -> Result<(), String> {
        if self.concurrent.contains(&access.resource) {
            return Ok(());
        }
        let owner = self.owners.get(&access.resource).copied();
        if access.mode.needs_contents() && owner.is_some_and(|owner| owner != Some(queue)) {
            return Err(format!("queue {queue:?} reads resource {}, which {owner:?} owns", access.resource.index()));
        }
        self.owners.insert(access.resource, Some(queue));
        Ok(())
    }

    /// Checks a use of a resource by a pass: it exists, and its first part has the state of the access.
    fn touch(&self, access: &Access, kind: PassKind, join: Join) -> Result<(), String> {
        let placement = self.plan.resources()[access.resource.index()].placement;
        if matches!(placement, Placement::Inlined | Placement::Unused) || join != Join::First {
            return Ok(());
        }
        if !self.created.contains_key(&access.resource) {
            return Err(format!("resource {} does not exist", access.resource.index()));
        }
        let is_texture = self.plan.graph().resources()[access.resource.index()].desc.texture().is_some();
        // Full-screen resolves and memoryless attachments have no state here.
        if !is_texture || access.kind == AccessKind::Resolve || placement == Placement::Memoryless {
            return Ok(());
        }
        let wanted: &[State] = match access.kind {
            AccessKind::Color => &[State::ColorAttachment],
            AccessKind::Depth => &[State::DepthAttachment],
            AccessKind::DepthReadOnly => &[State::DepthReadOnly, State::DepthAttachment],
            AccessKind::SamePixel => &[
                State::InputAttachment,
                State::Sampled,
                State::Storage,
                State::ColorAttachment,
                State::DepthReadOnly,
                State::DepthAttachment,
            ],
            AccessKind::Sampled => &[State::Sampled, State::DepthReadOnly, State::Storage],
            AccessKind::StorageRead | AccessKind::StorageWrite => &[State::Storage],
            AccessKind::CopySource => &[State::CopySource],
            AccessKind::CopyTarget => &[State::CopyTarget],
            _ => return Ok(()),
        };
        let found: Vec<State> = self
            .states
            .iter()
            .filter(|((resource, _), _)| *resource == access.resource)
            .map(|(_, state)| *state)
            .collect();
        if !found.iter().any(|state| wanted.contains(state)) {
            return Err(format!(
                "resource {} is accessed as {} by {kind:?} work in {found:?}",
                access.resource.index(),
                access.kind
            ));
        }
        Ok(())
    }
}

fn run(plan: &Plan, schedule: Option<&Schedule>, commands: &[Command]) -> Result<Vec<u32>, String> {
    let in_heap = |command: &Command| matches!(command, Command::Create { memory: Memory::Heap { .. }, .. });
    let mut machine = Machine {
        plan,
        schedule,
        created: BTreeMap::new(),
        concurrent: BTreeSet::new(),
        owners: BTreeMap::new(),
        states: BTreeMap::new(),
        handed: BTreeSet::new(),
        accessed: BTreeMap::new(),
        shared: schedule.is_some() && commands.iter().any(in_heap),
        gone: BTreeSet::new(),
        signalled: BTreeSet::new(),
        open: BTreeMap::new(),
        ran: Vec::new(),
    };
    for (number, command) in commands.iter().enumerate() {
        machine.run(command).map_err(|error| format!("command {number}: {error}"))?;
    }
    Ok(machine.ran)
}

fn planned(seed: u64, alias: Alias) -> Option<Plan> {
    let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
    let mut plan = Plan::new();
    let options = Options { alias, ..generate::options_of(seed as u32 % 64) };
    let caps = [Caps::desktop(), Caps::tiler()].map(generate::capable);
    compile(&graph, &caps[seed as usize % 2], &options, &mut Scratch::new(), &mut plan).ok()?;
    Some(plan)
}

#[test]
fn a_machine_runs_streams_on_one_queue() -> TestResult {
    let (mut ran, mut barriers, mut heaps, mut noticed) = (0, 0, 0, 0);
    for seed in 0..400 {
        let Some(plan) = planned(seed, Alias::Heap) else { continue };
        let commands = plan.stream();
        let steps =
            run(&plan, None, &commands).map_err(|e| format!("seed {seed}: {e}\n{}", framegraph::dump::text(&plan)))?;
        assert!(steps.iter().copied().eq(0..plan.steps().len() as u32), "seed {seed}");
        let count = |is: fn(&Command) -> bool| commands.iter().filter(|command| is(command)).count();
        assert_eq!(count(|c| matches!(c, Command::Barrier { .. })), plan.barriers().len(), "seed {seed}");
        assert_eq!(count(|c| matches!(c, Command::Wait { .. } | Command::Signal { .. })), 0);
        barriers += plan.barriers().len();
        heaps += count(|c| matches!(c, Command::Heap { .. }));
        ran += 1;
        // Negative control: fails without barriers.
        let bare: Vec<_> = commands.iter().copied().filter(|c| !matches!(c, Command::Barrier { .. })).collect();
        noticed += usize::from(run(&plan, None, &bare).is_err());
    }
    println!("{ran} streams, {barriers} barriers, {heaps} heaps; {noticed} fail without barriers");
    assert!(ran > 200 && barriers > 1000 && heaps > 50 && noticed > 150, "{ran} {barriers} {heaps} {noticed}");
    Ok(())
}

#[test]
fn a_machine_runs_streams_on_several_queues() -> TestResult {
    let (mut semaphores, mut moved, mut late) = (0, 0, 0);
    let (mut kept, mut alone) = (0, 0);
    for seed in 0..400 {
        let Some(plan) = planned(seed, Alias::Off) else { continue };
        let costs: Vec<f64> =
            (0..plan.steps().len()).map(|step| (seed as usize * 37 + step * 101) as f64 % 400.0).collect();
        let found = schedule(&plan, &QueueLayout::async_compute(), &costs)?;
        let commands = plan.stream_on(&found);
        run(&plan, Some(&found), &commands).map_err(|e| format!("seed {seed}: {e}"))?;
        let count = |is: fn(&Command) -> bool| commands.iter().filter(|command| is(command)).count();
        let waits = count(|c| matches!(c, Command::Wait { .. }));
        assert_eq!(waits, found.waits.len() + found.joins.len(), "seed {seed}");
        assert_eq!(
            waits,
            count(|c| matches!(c, Command::Signal { .. })),
            "seed {seed}: each is signaled once and waited for once"
        );
        let halves = [count(|c| matches!(c, Command::Release { .. })), count(|c| matches!(c, Command::Acquire { .. }))];
        assert_eq!(halves, [found.transfers.len(); 2], "seed {seed}");
        late += count(|c| matches!(c, Command::Barrier { behind_semaphore: true, .. }));
        semaphores += waits;
        // Negative controls: fails without transfers, and without concurrent resources.
        let is_half = |c: &&Command| matches!(c, Command::Release { .. } | Command::Acquire { .. });
        let bare: Vec<_> = commands.iter().filter(|c| !is_half(c)).copied().collect();
        kept += usize::from(!found.transfers.is_empty() && run(&plan, Some(&found), &bare).is_err());
        let owned = commands.iter().map(|command| match *command {
            Command::Create { resource, memory, concurrent: true } => {
                Command::Create { resource, memory, concurrent: false }
            }
            command => command,
        });
        alone += usize::from(run(&plan, Some(&found), &owned.collect::<Vec<_>>()).is_err());
        moved += found.lanes.iter().filter(|lane| **lane != QueueId::MAIN).count();
    }
    println!("{semaphores} semaphores, {moved} steps on the second queue, {late} barriers after semaphores");
    assert!(semaphores > 50 && moved > 50 && late > 10, "{semaphores} {moved} {late}");
    assert!(kept > 20 && alone > 5, "{kept} streams need their transfers, {alone} their concurrent resources");
    Ok(())
}

/// Memory shared by a schedule has aliasing barriers within each queue; other memory has none.
#[test]
fn a_machine_runs_streams_that_share_memory() -> TestResult {
    let (mut ran, mut noticed, mut handed, mut elsewhere) = (0, 0, 0, 0);
    for seed in 0..400 {
        let Some(plan) = planned(seed, Alias::Off) else { continue };
        let costs: Vec<f64> =
            (0..plan.steps().len()).map(|step| (seed as usize * 37 + step * 101) as f64 % 400.0).collect();
        let found = schedule(&plan, &QueueLayout::async_compute(), &costs)?;
        let memory = share_memory(&plan, &found, 256);
        let commands = plan.stream_in(&found, &memory);
        run(&plan, Some(&found), &commands).map_err(|e| format!("seed {seed}: {e}"))?;
        let heaps: u64 = commands.iter().map(|c| if let Command::Heap { bytes, .. } = c { *bytes } else { 0 }).sum();
        assert_eq!(heaps, memory.bytes(), "seed {seed}");
        let is_hand_over = |c: &&Command| matches!(c, Command::AliasingBarrier { .. });
        let rest: Vec<_> = commands.iter().filter(|c| !is_hand_over(c)).copied().collect();
        let count = commands.len() - rest.len();
        elsewhere += commands
            .iter()
            .filter(|c| matches!(c, Command::AliasingBarrier { queue, .. } if *queue != QueueId::MAIN))
            .count();
        assert!(!plan.stream_on(&found).iter().any(|c| is_hand_over(&c)), "seed {seed}");
        ran += usize::from(count > 0);
        handed += count;
        // Every missing aliasing barrier is noticed.
        for left_out in 0..count {
            let mut index = 0;
            let kept = commands.iter().copied().filter(|c| {
                let own = is_hand_over(&c);
                index += usize::from(own);
                !own || index != left_out + 1
            });
            noticed += usize::from(run(&plan, Some(&found), &kept.collect::<Vec<_>>()).is_err());
        }
    }
    println!(
        "{ran} streams with {handed} aliasing barriers, {elsewhere} of them on the second queue; {noticed} are required"
    );
    assert!(ran > 50 && handed > 200 && elsewhere > 2 && noticed == handed, "{ran} {handed} {elsewhere} {noticed}");
    Ok(())
}
