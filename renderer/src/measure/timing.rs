//! GPU and CPU time of each step, measured without waiting.
//!
//! The GPU writes a timestamp at the begin and end of each step. They are resolved with the frame and read back some
//! frames later. Up to four frames are in flight; if all are busy, a frame is not measured.
//!
//! The first frames after the steps change compile shaders and are ignored. Timestamps that are zero or run backwards
//! are dropped.

use crate::clock::Instant;
use crate::device::gpu::Gpu;
use crate::execute::recording::{Recording, StepTime};
use crate::hash::fnv;
use crate::measure::statistics::{Durations, Summary};
use crate::measure::timestamp_queries::{FrameTimestamps, StepSpans};
use crate::measure::trace::{Recorder, Trace};
use framegraph::{PassKind, Plan, StepId};
use std::time::Duration;
use wgpu::{CommandEncoder, Features, QuerySet};

/// Maximum number of frames with timestamps in flight.
const IN_FLIGHT: usize = 4;

/// Times of the steps of the last executed plan.
#[derive(Debug)]
pub struct Timing {
    slots: Vec<FrameTimestamps>,
    /// Slot of the frame that is being recorded.
    current: Option<usize>,
    /// Index of the first of two queries of each step; `None` for steps that cannot be measured.
    queries: Vec<Option<u32>>,
    steps: Vec<StepDurations>,
    frame: StepDurations,
    generation: u64,
    /// Compilation number of the last executed plan.
    compilation: u64,
    warm_up_left: u32,
    begun: Option<Instant>,
    wgpu: Durations,
    trace: Option<Recorder>,
    enabled: bool,
}

#[derive(Debug, Default)]
struct StepDurations {
    gpu: Durations,
    cpu: Durations,
}

/// Times of one step or of the whole frame. `None` without measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// GPU time.
    pub gpu: Option<Summary>,
    /// CPU time of recording. For the whole frame, from resource creation until submission.
    pub cpu: Option<Summary>,
}

/// Queries that a step writes at its begin and end.
#[derive(Debug)]
pub(crate) struct TimestampWrites {
    pub(crate) queries: QuerySet,
    pub(crate) begin: u32,
    pub(crate) end: u32,
}

impl Timing {
    /// Number of frames ignored after the steps change, since they compile shaders and fill caches.
    pub const WARM_UP: u32 = 4;

    /// Returns whether step times are measured.
    pub(crate) fn is_enabled(&self) -> bool {
        self.enabled || self.trace.is_some()
    }

    /// Creates a timing. `enabled` turns on step times; CPU times of whole frames are always measured. `trace` stores
    /// the times of every frame.
    pub(crate) fn new(enabled: bool, trace: bool) -> Self {
        Self {
            slots: Vec::new(),
            current: None,
            queries: Vec::new(),
            steps: Vec::new(),
            frame: StepDurations::default(),
            generation: 0,
            compilation: 0,
            warm_up_left: Self::WARM_UP,
            begun: None,
            wgpu: Durations::default(),
            trace: trace.then(Recorder::new),
            enabled,
        }
    }

    /// Turns step times on or off, and removes all measurements.
    pub(crate) fn set_enabled(&mut self, enabled: bool) {
        self.enabled = enabled;
        self.reset();
    }

    /// Returns the times of one step of the last executed plan.
    pub fn step(&self, step: StepId) -> Times {
        self.steps.get(step.index()).map(StepDurations::times).unwrap_or_default()
    }

    /// Returns the last GPU and CPU time of a step, in milliseconds.
    #[cfg(feature = "remote")]
    pub(crate) fn last_of_step(&self, step: StepId) -> [Option<f64>; 2] {
        self.steps.get(step.index()).map_or([None; 2], StepDurations::last)
    }

    /// Returns the last GPU and CPU time of the frame, in milliseconds.
    #[cfg(feature = "remote")]
    pub(crate) fn last_of_frame(&self) -> [Option<f64>; 2] {
        self.frame.last()
    }

    /// Returns the times of the whole frame. GPU time spans the first to the last timestamp.
    pub fn frame(&self) -> Times {
        self.frame.times()
    }

    /// Returns the CPU time per frame spent in wgpu calls of the executor: begin and end passes, finish, submit, poll
    /// and upload. Calls of recorders are not included. `None` if step times are not measured.
    pub fn wgpu(&self) -> Option<Summary> {
        self.wgpu.summary()
    }

    /// Returns the trace of stored frames; `None` if tracing is off.
    pub fn trace(&self) -> Option<&Trace> {
        self.trace.as_ref().map(Recorder::trace)
    }

    /// Removes all measurements and starts the warm-up again.
    pub fn reset(&mut self) {
        self.steps.iter_mut().for_each(StepDurations::clear);
        self.frame.clear();
        self.wgpu.clear();
        self.warm_up_left = Self::WARM_UP;
        // Frames in flight started before the reset.
        self.slots.iter_mut().for_each(|s| s.counted = false);
    }

    /// Begins a frame: reads timestamps that have arrived, and reserves an idle slot if there is one.
    pub(crate) fn begin_frame(&mut self, gpu: &Gpu, plan: &Plan) {
        self.begun = Some(Instant::now());
        self.current = None;
        if plan.compilation() == 0 || plan.compilation() != self.compilation {
            self.compilation = plan.compilation();
            let generation = fingerprint(plan);
            if generation != self.generation {
                self.generation = generation;
                self.steps.clear();
                self.steps.resize_with(plan.steps().len(), StepDurations::default);
                self.reset();
            }
        }
        let generation = self.generation;
        self.collect(f64::from(gpu.queue.get_timestamp_period()));
        if let Some(trace) = &mut self.trace {
            trace.begin_frame(plan, generation, self.warm_up_left > 0);
        }
        if !self.is_enabled() || !gpu.device.features().contains(Features::TIMESTAMP_QUERY) {
            return;
        }
        let copies = gpu.device.features().contains(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);
        let used = assign(plan, copies, &mut self.queries);
        let idle = self.slots.iter().position(FrameTimestamps::is_idle);
        let free = idle.or_else(|| (self.slots.len() < IN_FLIGHT).then_some(self.slots.len()));
        let (Some(index), 1..=4096) = (free, used) else {
            return;
        };
        if self.slots.get(index).is_none_or(|s| s.capacity() < used) {
            let slot = FrameTimestamps::new(gpu, used.next_power_of_two().max(32));
            match self.slots.get_mut(index) {
                Some(old) => *old = slot,
                None => self.slots.push(slot),
            }
        }
        let slot = &mut self.slots[index];
        (slot.generation, slot.used, slot.counted) = (generation, used, self.warm_up_left == 0);
        slot.frame = self.trace.as_ref().map(Recorder::frame);
        self.current = Some(index);
    }

    /// Returns a number that identifies the plan's steps. It changes with the frame size and the passes of the steps.
    pub(crate) fn plan(&self) -> u64 {
        self.generation
    }

    /// Returns the queries that a step writes; `None` if it is not measured.
    pub(crate) fn writes(&self, step: StepId) -> Option<TimestampWrites> {
        let begin = (*self.queries.get(step.index())?)?;
        let queries = self.slots[self.current?].queries().clone();
        Some(TimestampWrites { queries, begin, end: begin + 1 })
    }

    /// Resolves the timestamps of the frame.
    pub(crate) fn resolve(&self, encoder: &mut CommandEncoder) {
        if let Some(slot) = self.current.map(|c| &self.slots[c]) {
            slot.resolve(encoder);
        }
    }

    /// Ends a frame that was submitted.
    pub(crate) fn submitted(&mut self, recording: &Recording) {
        if let Some(slot) = self.current.take().map(|c| &self.slots[c]) {
            slot.map();
        }
        if let Some(trace) = &mut self.trace {
            trace.end_frame(&recording.steps);
        }
        let measured = self.warm_up_left == 0 && self.is_enabled();
        for StepTime { step, begun, ended } in recording.steps.iter().filter(|_| measured) {
            if let Some(samples) = self.steps.get_mut(step.index()) {
                samples.cpu.push(ms(ended.duration_since(*begun)));
            }
        }
        if let (Some(begun), 0) = (self.begun.take(), self.warm_up_left) {
            self.frame.cpu.push(ms(begun.elapsed()));
            if self.is_enabled() {
                self.wgpu.push(ms(recording.in_wgpu));
            }
        }
        self.warm_up_left = self.warm_up_left.saturating_sub(1);
    }

    /// Reads the timestamps that have arrived.
    fn collect(&mut self, period_ns: f64) {
        for slot in 0..self.slots.len() {
            if let Some(timestamps) = self.slots[slot].take() {
                self.credit(slot, &timestamps, period_ns);
            }
        }
    }

    /// Adds the timestamps of the frame in `slot` to the statistics of its steps.
    fn credit(&mut self, slot: usize, timestamps: &[u64], period_ns: f64) {
        let Self { slots, queries, steps, frame, generation, trace, .. } = self;
        let slot = &slots[slot];
        if slot.generation != *generation {
            return;
        }
        let spans = StepSpans::new(timestamps, queries, period_ns);
        if let (Some(trace), Some(number)) = (trace.as_mut(), slot.frame) {
            trace.measured(number, &spans);
        }
        if slot.counted {
            for (samples, span) in steps.iter_mut().zip(&spans.steps) {
                span.iter().for_each(|span| samples.gpu.push(span.ms()));
            }
            spans.frame().iter().for_each(|span| frame.gpu.push(span.ms()));
        }
    }

    /// Reads measurements that have arrived since the last frame, without waiting. Call it before a report.
    ///
    /// # Errors
    /// Fails if the device is lost.
    pub fn catch_up(&mut self, gpu: &Gpu) -> Result<(), crate::device::error::DeviceError> {
        gpu.poll()?;
        self.collect(f64::from(gpu.queue.get_timestamp_period()));
        Ok(())
    }
}

impl StepDurations {
    fn times(&self) -> Times {
        Times { gpu: self.gpu.summary(), cpu: self.cpu.summary() }
    }

    #[cfg(feature = "remote")]
    fn last(&self) -> [Option<f64>; 2] {
        [self.gpu.last(), self.cpu.last()]
    }

    fn clear(&mut self) {
        self.gpu.clear();
        self.cpu.clear();
    }
}

/// Assigns two queries to each step of `plan` and returns the number of queries. `copies` says whether copy steps can
/// be measured.
fn assign(plan: &Plan, copies: bool, queries: &mut Vec<Option<u32>>) -> u32 {
    let mut used = 0;
    queries.clear();
    queries.extend(plan.steps().iter().map(|step| {
        let query = (step.kind != PassKind::Copy || copies).then_some(used);
        used += if query.is_some() { 2 } else { 0 };
        query
    }));
    used
}

fn ms(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

/// Returns a hash of the frame size and the pass names of all steps.
fn fingerprint(plan: &Plan) -> u64 {
    let size = plan.frame().into_iter().flat_map(u32::to_le_bytes);
    let names = plan.step_ids().flat_map(|step| {
        let members = plan.passes_of(step).iter();
        members.flat_map(|m| plan.graph().pass_name(m.pass).bytes().chain([0])).chain([1])
    });
    fnv(size.chain(names))
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Caps, Extent, Format, Graph, Intent, Options, Scratch, TextureDesc, compile};

    type TestResult = Result<(), Box<dyn std::error::Error>>;

    /// Creates a plan with a raster, a copy, a compute and a raster step.
    fn four_steps() -> Result<Plan, Box<dyn std::error::Error>> {
        let mut graph = Graph::new();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| graph.texture(name, desc));
        let a = graph.add_fn("draw", |p| p.color(a, Intent::Overwrite))?;
        let b = graph.add_fn("copy", |p| {
            p.copy_source(a)?;
            p.copy_target(b, Intent::Overwrite)
        })?;
        let c = graph.add_fn("compute", |p| {
            p.sampled(b)?;
            p.storage_write(c, Intent::Overwrite)
        })?;
        let d = graph.add_fn("last", |p| {
            p.sampled(c)?;
            p.color(d, Intent::Overwrite)
        })?;
        graph.export(d)?;
        let mut plan = Plan::new();
        compile(&graph, &Caps::wgpu(), &Options::for_frame(4, 4), &mut Scratch::new(), &mut plan)?;
        Ok(plan)
    }

    /// Writes timestamps of a different duration for each step, and checks that each step gets its own duration.
    #[test]
    fn every_step_gets_its_own_duration() -> TestResult {
        let (gpu, plan) = (Gpu::noop()?, four_steps()?);
        let mut timing = Timing::new(true, true);
        timing.begin_frame(&gpu, &plan);
        let current = timing.current.ok_or("no slot")?;
        let mut stamps = vec![0; timing.slots[current].used as usize];
        for (step, nanoseconds) in plan.step_ids().zip([1_000_000, 20_000_000, 300_000_000, 4_000_000_000]) {
            let TimestampWrites { begin, end, .. } = timing.writes(step).ok_or("not measured")?;
            let after = stamps.iter().copied().max().unwrap_or(0) + 500;
            (stamps[begin as usize], stamps[end as usize]) = (after, after + nanoseconds);
        }
        assert!(!stamps.contains(&0), "steps do not share queries: {stamps:?}");
        timing.slots[current].counted = true;
        timing.credit(current, &stamps, 1.0);
        let found: Vec<_> = plan.step_ids().map(|step| timing.step(step).gpu.map(|s| s.median_ms)).collect();
        assert_eq!(found, [1.0, 20.0, 300.0, 4000.0].map(Some));
        let whole = timing.frame().gpu.ok_or("no time of the frame")?.median_ms;
        assert!((whole - 4321.0015).abs() < 1e-9, "{whole} is not the sum with three pauses");
        Ok(())
    }

    #[test]
    fn copies_without_timestamps_have_no_queries() -> TestResult {
        let (plan, mut queries) = (four_steps()?, Vec::new());
        assert_eq!(assign(&plan, true, &mut queries), 8);
        assert_eq!(queries, [Some(0), Some(2), Some(4), Some(6)]);
        assert_eq!(assign(&plan, false, &mut queries), 6);
        assert_eq!(queries, [Some(0), None, Some(2), Some(4)]);
        Ok(())
    }
}
