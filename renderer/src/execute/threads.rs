//! Recording on several threads. Each thread records a part of the steps into its own command buffers. They are
//! submitted in the order of the steps, so the result does not depend on the number of threads.

use crate::clock::Instant;
use crate::device::error::{DeviceError, ErrorScopes};
use crate::execute::commands::CommandList;
use crate::execute::error::ExecuteError;
use crate::execute::prepared::Prepared;
use crate::execute::recording::Recording;
use crate::execute::segments::Segments;
use crate::execute::steps::{Passes, record_step};
use crate::execute::thread_balancer::ThreadBalancer;
use crate::placed::arenas::Arenas;
use crate::spans::{here, span};
use crate::workers::{Job, Workers};
use framegraph::{Placement, Plan, StepId, StoreOp, Usage};
use std::ops::Range;
#[cfg(feature = "threads")]
use wgpu::Device;
use wgpu::{CommandEncoder, Queue};

/// State of multithreaded recording.
#[derive(Debug, Default)]
pub(crate) struct Threads {
    workers: Option<Workers>,
    /// Recording state of the other threads.
    others: Vec<Recording>,
    balancer: ThreadBalancer,
    begun: Option<Instant>,
    /// Number of threads that recorded the frame.
    recorded: usize,
    /// Reused memory for a flag per step.
    may_begin: Vec<bool>,
}

/// Part of a frame that one thread records.
struct Part<'a> {
    steps: Range<u32>,
    recording: &'a mut Recording,
    commands: Result<CommandList, ExecuteError>,
    caught: Result<(), DeviceError>,
}

impl Threads {
    pub(crate) fn workers(&self) -> Option<&Workers> {
        self.workers.as_ref()
    }

    /// Sets the worker threads from the next frame on. `None` records on the submitting thread only.
    #[cfg(feature = "threads")]
    pub(crate) fn set(&mut self, workers: Option<Workers>, device: &Device, timed: bool) {
        let others = workers.as_ref().map_or(0, |workers| workers.threads() - 1);
        self.others.truncate(others);
        self.others.resize_with(others, || Recording::new(device, timed));
        (self.workers, self.balancer) = (workers, ThreadBalancer::default());
    }

    /// Turns time measurements of the other threads on or off.
    pub(crate) fn set_measured(&mut self, measured: bool) {
        self.others.iter_mut().for_each(|other| other.set_measured(measured));
    }

    /// Splits all frames regardless of cost, for tests.
    #[cfg(all(feature = "threads", any(test, feature = "testing")))]
    pub(crate) fn always_split(&mut self) {
        self.balancer.always_split();
    }

    /// Begins a frame of the plan with this number. `may_split` says whether threads can share its world. Returns
    /// whether its steps must be timed.
    pub(crate) fn begin_frame(&mut self, plan: &Plan, number: u64, may_split: bool, max_age: u64) -> bool {
        self.recorded = 1;
        let Some(workers) = &self.workers else { return false };
        self.others.iter_mut().for_each(|other| other.begin_frame(false, max_age));
        if !may_split || self.balancer.begin_unmeasured(number, plan.steps().len()) {
            return false;
        }
        self.begun = Some(Instant::now());
        may_begin(plan, &mut self.may_begin);
        self.balancer.begin_frame(number, &self.may_begin, workers.threads())
    }

    /// Ends the recording of a frame. `recording` is the state of the submitting thread.
    pub(crate) fn end_frame(&mut self, recording: &Recording) {
        if let Some(begun) = self.begun.take() {
            let steps = recording.steps.iter().map(|time| (time.step.index(), time.ended - time.begun));
            self.balancer.end_frame(begun.elapsed(), steps);
        }
    }

    /// Returns the number of threads that recorded the frame.
    #[cfg(feature = "threads")]
    pub(crate) fn recording(&self) -> usize {
        self.recorded
    }

    /// Returns the number of uniform buffers that the other threads created.
    pub(crate) fn uniform_buffers(&self) -> u64 {
        self.others.iter().map(|other| other.uniforms.created()).sum()
    }

    /// Returns the number of view requests that the other threads answered from their caches.
    pub(crate) fn views_found(&self) -> u64 {
        self.others.iter().map(|other| other.requests.views_found).sum()
    }

    /// Releases all cached views of the other threads.
    pub(crate) fn release_views(&mut self) {
        self.others.iter_mut().for_each(|other| other.requests.release_views());
    }

    /// Uploads the uniforms of all other threads.
    pub(crate) fn upload(&self, queue: &Queue) {
        self.others.iter().for_each(|other| other.uniforms.upload(queue));
    }

    /// Records the frame in parts, if it should be split. Adds the counts of all threads to `first`, the state of the
    /// submitting thread. Errors on other threads are stored in `caught`. Returns `None` if the frame should be
    /// recorded on one thread.
    pub(crate) fn record<W: ?Sized>(
        &mut self,
        frame: &Prepared<'_>,
        arenas: &Arenas,
        passes: &Passes<'_, W>,
        first: &mut Recording,
        caught: &mut Result<(), DeviceError>,
    ) -> Option<Result<CommandList, ExecuteError>> {
        let Self { workers, others, balancer, recorded, .. } = self;
        let workers = workers.as_ref().filter(|_| balancer.parts().len() > 1)?;
        let Passes { frame: declared, world, extra } = *passes;
        let share = declared.share()?;
        let recordings = std::iter::once(&mut *first).chain(others.iter_mut());
        let mut parts: Vec<Part<'_>> = balancer
            .parts()
            .iter()
            .zip(recordings)
            .map(|(steps, recording)| Part {
                steps: steps.clone(),
                recording,
                commands: Ok(CommandList::default()),
                caught: Ok(()),
            })
            .collect();
        *recorded = parts.len();
        let parent = here();
        let record = |part: &mut Part<'_>, world: &W| {
            let _span = span!("part" in &parent);
            let passes = &Passes { frame: declared, world, extra };
            let begun = part.recording.now();
            let scopes = ErrorScopes::open(&frame.gpu.device);
            part.recording.took_in_wgpu(begun);
            part.commands = record_part(frame, arenas, passes, part.steps.clone(), part.recording, None);
            let begun = part.recording.now();
            part.caught = scopes.close("a frame");
            part.recording.took_in_wgpu(begun);
        };
        let record = &record;
        let mut jobs: Vec<_> = parts.iter_mut().map(|part| move |world: &W| record(part, world)).collect();
        let mut jobs: Vec<_> = jobs.iter_mut().map(|job| job as Job<'_, W>).collect();
        share(workers, &mut jobs, world);
        let mut commands = Ok(CommandList::default());
        for part in parts {
            // Reports the first error in the order of the steps, as with one thread.
            *caught = std::mem::replace(caught, Ok(())).and(part.caught);
            commands = commands.and_then(|mut all: CommandList| {
                part.commands?.into_iter().for_each(|buffer| all.push(buffer));
                Ok(all)
            });
        }
        others.iter_mut().for_each(|other| first.add(other));
        Some(commands)
    }
}

/// Computes for each step whether a command buffer may begin with it.
///
/// wgpu processes a discard when its command buffer is submitted, after it has checked the writes of later command
/// buffers. A texture that is discarded in one command buffer and stored in a later one would be zero-filled in
/// between. Both steps therefore stay in one command buffer.
fn may_begin(plan: &Plan, may: &mut Vec<bool>) {
    may.clear();
    may.resize(plan.steps().len(), true);
    // First step that discards each texture.
    let mut discarded: [Vec<Option<usize>>; 2] = [Vec::new(), Vec::new()];
    let texture = |resource: usize| match plan.resources()[resource].placement {
        Placement::Slot(slot) => Some((0, slot.index())),
        Placement::Own | Placement::External | Placement::Heap { .. } => Some((1, resource)),
        Placement::Unused | Placement::Memoryless | Placement::Inlined => None,
    };
    for step in plan.step_ids() {
        for attachment in plan.attachments_of(step) {
            let Some((list, at)) = texture(attachment.resource.index()) else { continue };
            let list = &mut discarded[list];
            if list.len() <= at {
                list.resize(at + 1, None);
            }
            let ops = [attachment.store, attachment.stencil_store];
            if let (Some(discarded), true) = (list[at], ops.contains(&StoreOp::Store)) {
                may[discarded + 1..=step.index()].fill(false);
            }
            if ops.contains(&StoreOp::Discard) {
                list[at] = list[at].or(Some(step.index()));
            }
        }
    }
    // Writes other than by attachments are always kept.
    for (resource, row) in plan.resources().iter().enumerate() {
        let written = row.usage.contains(Usage::STORAGE) || row.usage.contains(Usage::COPY_TARGET);
        let Some((list, at)) = texture(resource).filter(|_| written && !row.last.is_none()) else { continue };
        if let Some(Some(discarded)) = discarded[list].get(at) {
            may[(discarded + 1).min(row.last.index())..=row.last.index()].fill(false);
        }
    }
}

/// Records steps on this thread. `recorded` is called after each step with the number of pipelines created so far.
pub(crate) fn record_part<W: ?Sized>(
    frame: &Prepared<'_>,
    arenas: &Arenas,
    passes: &Passes<'_, W>,
    steps: Range<u32>,
    recording: &mut Recording,
    mut recorded: Option<&mut dyn FnMut(StepId, u64)>,
) -> Result<CommandList, ExecuteError> {
    let last = steps.end as usize == frame.plan.steps().len();
    let mut segments = recording.in_wgpu(|| Segments::new(frame, arenas, steps.clone()));
    for step in steps.map(|step| StepId::at(step as usize)) {
        segments.begin_step(step);
        record_step(frame, passes, step, recording, &mut segments.encoder)?;
        if let Some(recorded) = &mut recorded {
            recorded(step, frame.caches.pipelines.counts().created);
        }
    }
    Ok(recording.in_wgpu(|| {
        if last {
            frame.timing.resolve(&mut segments.encoder);
        }
        segments.finish()
    }))
}

/// Records all steps on this thread, into an encoder of the caller.
pub(crate) fn record_into<W: ?Sized>(
    frame: &Prepared<'_>,
    passes: &Passes<'_, W>,
    recording: &mut Recording,
    encoder: &mut CommandEncoder,
) -> Result<(), ExecuteError> {
    frame.plan.step_ids().try_for_each(|step| record_step(frame, passes, step, recording, encoder))?;
    recording.in_wgpu(|| frame.timing.resolve(encoder));
    Ok(())
}
