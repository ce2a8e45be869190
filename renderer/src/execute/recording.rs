//! What recording writes, beside commands: the constants, counts and times of the steps that one thread records.

use crate::execute::error::RecordError;
use crate::execute::remembered::Remembered;
use crate::execute::uniforms::Uniforms;
use framegraph::{Counts, PassId, StepId};
use std::time::{Duration, Instant};
use wgpu::Device;

/// Kept from frame to frame, for its memory. One thread records into it at a time.
#[derive(Debug)]
pub(crate) struct Recording {
    pub(crate) uniforms: Uniforms,
    /// What its steps asked of the caches, for the next frame.
    pub(crate) remembered: Remembered,
    /// Whether times are asked for.
    measured: bool,
    /// Whether times are taken in this frame: reading the clock costs as much as opening a pass.
    timed: bool,
    /// Steps, passes and operations recorded so far.
    pub(crate) executed: Counts,
    /// Fills that poisoning added.
    pub(crate) poisoned: u32,
    /// When each step was recorded, where times are taken.
    pub(crate) steps: Vec<StepTime>,
    /// Time spent inside of wgpu's calls to open, close and finish, where times are taken.
    pub(crate) in_wgpu: Duration,
    /// The passes of the open step that became part of the shader of another one.
    pub(crate) inlined: Vec<PassId>,
    /// The first thing that the pass which records was refused by a call that returns no error.
    pub(crate) refused: Option<RecordError>,
}

/// When a step was recorded, on the CPU.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepTime {
    pub(crate) step: StepId,
    pub(crate) begun: Instant,
    pub(crate) ended: Instant,
}

impl Recording {
    /// For a device; times are taken in each frame if they are `measured`.
    pub(crate) fn new(device: &Device, measured: bool) -> Self {
        let (executed, in_wgpu, remembered) = (Counts::default(), Duration::ZERO, Remembered::default());
        let (uniforms, steps, inlined) = (Uniforms::new(device), Vec::new(), Vec::new());
        let (timed, poisoned, refused) = (measured, 0, None);
        Self { uniforms, remembered, measured, timed, executed, poisoned, steps, in_wgpu, inlined, refused }
    }

    /// Begins a frame: everything recorded before is forgotten. Its steps are `timed` even if nobody asks for times. Views are
    /// asked for anew every `max_age` frames.
    pub(crate) fn begin_frame(&mut self, timed: bool, max_age: u64) {
        self.uniforms.begin_frame();
        self.remembered.begin_frame(max_age);
        self.timed = self.measured || timed;
        (self.executed, self.poisoned, self.in_wgpu) = (Counts::default(), 0, Duration::ZERO);
        self.steps.clear();
        self.inlined.clear();
        self.refused = None;
    }

    /// Adds what another thread counted and timed, whose steps come behind these.
    pub(crate) fn add(&mut self, other: &mut Self) {
        self.executed += other.executed;
        self.poisoned += other.poisoned;
        self.in_wgpu += other.in_wgpu;
        self.steps.append(&mut other.steps);
    }

    /// Runs `call`, whose time is wgpu's.
    pub(crate) fn in_wgpu<T>(&mut self, call: impl FnOnce() -> T) -> T {
        let begun = self.now();
        let out = call();
        self.took_in_wgpu(begun);
        out
    }

    /// What the clock says, where times are taken.
    pub(crate) fn now(&self) -> Option<Instant> {
        self.timed.then(Instant::now)
    }

    /// The time since `begun` is wgpu's.
    pub(crate) fn took_in_wgpu(&mut self, begun: Option<Instant>) {
        self.in_wgpu += begun.map_or(Duration::ZERO, |begun| begun.elapsed());
    }

    /// Ends a step, or the part of one, that was begun then and spent its time since `closing` inside of wgpu.
    pub(crate) fn end_step(&mut self, step: StepId, begun: Option<Instant>, closing: Option<Instant>) {
        let (Some(begun), Some(closing), Some(ended)) = (begun, closing, self.now()) else { return };
        self.in_wgpu += ended.duration_since(closing);
        self.steps.push(StepTime { step, begun, ended });
    }
}
