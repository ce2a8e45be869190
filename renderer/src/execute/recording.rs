//! What recording writes, beside commands: the constants, counts and times of the steps that one thread records.

use crate::execute::error::RecordError;
use crate::execute::uniforms::Uniforms;
use framegraph::{Counts, PassId, StepId};
use std::time::{Duration, Instant};
use wgpu::Device;

/// Kept from frame to frame, for its memory. One thread records into it at a time.
#[derive(Debug)]
pub(crate) struct Recording {
    pub(crate) uniforms: Uniforms,
    /// Steps, passes and operations recorded so far.
    pub(crate) executed: Counts,
    /// Fills that poisoning added.
    pub(crate) poisoned: u32,
    /// When each step was recorded.
    pub(crate) steps: Vec<StepTime>,
    /// Time spent inside of wgpu's calls to open, close and finish.
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
    pub(crate) fn new(device: &Device) -> Self {
        let (executed, in_wgpu) = (Counts::default(), Duration::ZERO);
        let (uniforms, steps, inlined) = (Uniforms::new(device), Vec::new(), Vec::new());
        Self { uniforms, executed, poisoned: 0, steps, in_wgpu, inlined, refused: None }
    }

    /// Begins a frame: everything recorded before is forgotten.
    pub(crate) fn begin_frame(&mut self) {
        self.uniforms.begin_frame();
        (self.executed, self.poisoned, self.in_wgpu) = (Counts::default(), 0, Duration::ZERO);
        self.steps.clear();
        self.inlined.clear();
        self.refused = None;
    }

    /// Runs `call`, whose time is wgpu's.
    pub(crate) fn in_wgpu<T>(&mut self, call: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let out = call();
        self.in_wgpu += begun.elapsed();
        out
    }
}
