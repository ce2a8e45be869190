//! A frame whose steps are recorded on several threads: each records a part of them, in order, into command buffers of its
//! own. They are submitted in the order of the steps, so the device sees what it sees of one thread.

use crate::device::error::{DeviceError, ErrorScopes};
use crate::execute::error::ExecuteError;
use crate::execute::prepared::Prepared;
use crate::execute::recording::Recording;
use crate::execute::segments::Segments;
use crate::execute::share::Share;
use crate::execute::steps::{Passes, record_step};
use crate::placed::arenas::Arenas;
use crate::workers::Workers;
use framegraph::{Placement, Plan, StepId, StoreOp, Usage};
use std::ops::Range;
use std::time::Instant;
#[cfg(feature = "threads")]
use wgpu::Device;
use wgpu::{CommandBuffer, Queue};

/// Who records beside the thread that submits, and what.
#[derive(Debug, Default)]
pub(crate) struct Threads {
    workers: Option<Workers>,
    /// What the other threads write.
    others: Vec<Recording>,
    share: Share,
    begun: Option<Instant>,
    /// Threads that recorded the frame.
    recorded: usize,
    /// By step, kept for its memory.
    may_begin: Vec<bool>,
}

/// What one thread records of a frame.
struct Part<'a> {
    steps: Range<u32>,
    recording: &'a mut Recording,
    commands: Result<Vec<CommandBuffer>, ExecuteError>,
    caught: Result<(), DeviceError>,
}

impl Threads {
    #[cfg(feature = "threads")]
    pub(crate) fn workers(&self) -> Option<&Workers> {
        self.workers.as_ref()
    }

    /// Those of `workers` from the next frame on; without, the submitting thread records alone.
    #[cfg(feature = "threads")]
    pub(crate) fn set(&mut self, workers: Option<Workers>, device: &Device, timed: bool) {
        let others = workers.as_ref().map_or(0, |workers| workers.threads() - 1);
        self.others.truncate(others);
        self.others.resize_with(others, || Recording::new(device, timed));
        (self.workers, self.share) = (workers, Share::default());
    }

    /// Shares all frames out, whatever it costs: for tests.
    #[cfg(all(feature = "threads", any(test, feature = "testing")))]
    pub(crate) fn always(&mut self) {
        self.share.always();
    }

    /// Begins a frame of `plan`, told apart by its number; returns whether its steps are to be timed.
    pub(crate) fn begin_frame(&mut self, plan: &Plan, number: u64, max_age: u64) -> bool {
        self.recorded = 1;
        let Some(workers) = &self.workers else { return false };
        self.others.iter_mut().for_each(|other| other.begin_frame(false, max_age));
        if self.share.rests(number, plan.steps().len()) {
            return false;
        }
        self.begun = Some(Instant::now());
        may_begin(plan, &mut self.may_begin);
        self.share.begin_frame(number, &self.may_begin, workers.threads())
    }

    /// Ends the recording of a frame, of which `recording` was written by the submitting thread.
    pub(crate) fn end_frame(&mut self, recording: &Recording) {
        if let Some(begun) = self.begun.take() {
            let steps = recording.steps.iter().map(|time| (time.step.index(), time.ended - time.begun));
            self.share.end_frame(begun.elapsed(), steps);
        }
    }

    /// How many threads recorded the frame.
    #[cfg(feature = "threads")]
    pub(crate) fn recording(&self) -> usize {
        self.recorded
    }

    /// Uniform buffers made by the other threads, since the beginning.
    pub(crate) fn uniform_buffers(&self) -> u64 {
        self.others.iter().map(|other| other.uniforms.created()).sum()
    }

    /// Views that the other threads found as they were, since the beginning.
    pub(crate) fn views_found(&self) -> u64 {
        self.others.iter().map(|other| other.remembered.views_found).sum()
    }

    /// Lets go of all views that the other threads keep.
    pub(crate) fn let_go(&mut self) {
        self.others.iter_mut().for_each(|other| other.remembered.let_go());
    }

    /// Sends the constants of all other threads to the device.
    pub(crate) fn upload(&self, queue: &Queue) {
        self.others.iter().for_each(|other| other.uniforms.upload(queue));
    }

    /// Records the frame in parts, if it is to be, and adds what all threads counted to `first`, which is the submitting
    /// thread's. What wgpu refused on the others is put into `caught`.
    pub(crate) fn record<W: ?Sized + Sync + 'static>(
        &mut self,
        frame: &Prepared<'_>,
        arenas: &Arenas,
        passes: &Passes<'_, W>,
        first: &mut Recording,
        caught: &mut Result<(), DeviceError>,
    ) -> Option<Result<Vec<CommandBuffer>, ExecuteError>> {
        let Self { workers, others, share, recorded, .. } = self;
        let workers = workers.as_ref().filter(|_| share.parts().len() > 1)?;
        let recordings = std::iter::once(&mut *first).chain(others.iter_mut());
        let mut parts: Vec<Part<'_>> = share
            .parts()
            .iter()
            .zip(recordings)
            .map(|(steps, recording)| Part {
                steps: steps.clone(),
                recording,
                commands: Ok(Vec::new()),
                caught: Ok(()),
            })
            .collect();
        *recorded = parts.len();
        workers.for_each(&mut parts, |part| {
            let begun = part.recording.now();
            let scopes = ErrorScopes::open(&frame.gpu.device);
            part.recording.took_in_wgpu(begun);
            part.commands = record_part(frame, arenas, passes, part.steps.clone(), part.recording, None);
            let begun = part.recording.now();
            part.caught = scopes.close("a frame");
            part.recording.took_in_wgpu(begun);
        });
        let mut commands = Ok(Vec::new());
        for part in parts {
            // What stands first in the frame is told, as where one thread records it.
            *caught = std::mem::replace(caught, Ok(())).and(part.caught);
            commands = commands.and_then(|mut all: Vec<_>| {
                all.extend(part.commands?);
                Ok(all)
            });
        }
        others.iter_mut().for_each(|other| first.add(other));
        Some(commands)
    }
}

/// Of each step, whether a command buffer may begin with it. wgpu notes a discard when the command buffer is submitted, and
/// looked before at what later ones write: a texture that is discarded and then stored in another command buffer would be
/// taken for missing, and filled with zero. So the two stay in one.
fn may_begin(plan: &Plan, may: &mut Vec<bool>) {
    may.clear();
    may.resize(plan.steps().len(), true);
    // By texture, the first step that discards it.
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
    // What is written other than as an attachment is kept in any case.
    for (resource, row) in plan.resources().iter().enumerate() {
        let written = row.usage.contains(Usage::STORAGE) || row.usage.contains(Usage::COPY_TARGET);
        let Some((list, at)) = texture(resource).filter(|_| written && !row.last.is_none()) else { continue };
        if let Some(Some(discarded)) = discarded[list].get(at) {
            may[(discarded + 1).min(row.last.index())..=row.last.index()].fill(false);
        }
    }
}

/// Records these steps on this thread. `recorded` is told each that is done, and how many pipelines were made until then.
pub(crate) fn record_part<W: ?Sized + 'static>(
    frame: &Prepared<'_>,
    arenas: &Arenas,
    passes: &Passes<'_, W>,
    steps: Range<u32>,
    recording: &mut Recording,
    mut recorded: Option<&mut dyn FnMut(StepId, u64)>,
) -> Result<Vec<CommandBuffer>, ExecuteError> {
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
