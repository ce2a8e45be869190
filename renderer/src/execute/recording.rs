//! Mutable state of recording: uniforms, counts and times of the steps that one thread records.

use crate::clock::Instant;
use crate::execute::error::RecordError;
use crate::execute::request_cache::RequestCache;
use crate::execute::uniforms::Uniforms;
use framegraph::{Counts, PassId, StepId};
use std::time::Duration;
use wgpu::Device;

/// State of one recording thread. Reused in every frame.
#[derive(Debug)]
pub(crate) struct Recording {
    pub(crate) uniforms: Uniforms,
    /// Requests of the last frame and their results.
    pub(crate) requests: RequestCache,
    /// True if times are measured.
    measured: bool,
    /// True if this frame is measured. Reading the clock costs as much as beginning a pass.
    timed: bool,
    /// Steps, passes and operations recorded so far.
    pub(crate) executed: Counts,
    /// Number of fills added by poisoning.
    pub(crate) poisoned: u32,
    /// Times of the steps, if measured.
    pub(crate) steps: Vec<StepTime>,
    /// Time spent in wgpu calls that begin, end and finish passes, if measured.
    pub(crate) in_wgpu: Duration,
    /// Passes inlined into the current step.
    pub(crate) inlined: Vec<PassId>,
    /// First error of the current pass in a call that returns no `Result`.
    pub(crate) refused: Option<RecordError>,
}

/// CPU interval in which a step was recorded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepTime {
    pub(crate) step: StepId,
    pub(crate) begun: Instant,
    pub(crate) ended: Instant,
}

impl Recording {
    /// Creates the state for a device. `measured` turns on time measurements.
    pub(crate) fn new(device: &Device, measured: bool) -> Self {
        let (executed, in_wgpu, requests) = (Counts::default(), Duration::ZERO, RequestCache::default());
        let (uniforms, steps, inlined) = (Uniforms::new(device), Vec::new(), Vec::new());
        let (timed, poisoned, refused) = (measured, 0, None);
        Self { uniforms, requests, measured, timed, executed, poisoned, steps, in_wgpu, inlined, refused }
    }

    /// Turns time measurements on or off, from the next frame on.
    pub(crate) fn set_measured(&mut self, measured: bool) {
        self.measured = measured;
    }

    /// Begins a frame and resets counts and times. `timed` measures steps even if measurements are off. Cached views
    /// are released every `max_age` frames.
    pub(crate) fn begin_frame(&mut self, timed: bool, max_age: u64) {
        self.uniforms.begin_frame();
        self.requests.begin_frame(max_age);
        self.timed = self.measured || timed;
        (self.executed, self.poisoned, self.in_wgpu) = (Counts::default(), 0, Duration::ZERO);
        self.steps.clear();
        self.inlined.clear();
        self.refused = None;
    }

    /// Adds counts and times of another thread, whose steps follow.
    pub(crate) fn add(&mut self, other: &mut Self) {
        self.executed += other.executed;
        self.poisoned += other.poisoned;
        self.in_wgpu += other.in_wgpu;
        self.steps.append(&mut other.steps);
    }

    /// Runs `call` and counts its duration as time in wgpu.
    pub(crate) fn in_wgpu<T>(&mut self, call: impl FnOnce() -> T) -> T {
        let begun = self.now();
        let out = call();
        self.took_in_wgpu(begun);
        out
    }

    /// Returns the current time, if measured.
    pub(crate) fn now(&self) -> Option<Instant> {
        self.timed.then(Instant::now)
    }

    /// Counts the time since `begun` as time in wgpu.
    pub(crate) fn took_in_wgpu(&mut self, begun: Option<Instant>) {
        self.in_wgpu += begun.map_or(Duration::ZERO, |begun| begun.elapsed());
    }

    /// Ends a step that began at `begun`. The time since `closing` counts as time in wgpu.
    pub(crate) fn end_step(&mut self, step: StepId, begun: Option<Instant>, closing: Option<Instant>) {
        let (Some(begun), Some(closing), Some(ended)) = (begun, closing, self.now()) else { return };
        self.in_wgpu += ended.duration_since(closing);
        self.steps.push(StepTime { step, begun, ended });
    }
}
