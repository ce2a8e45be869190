//! GPU and CPU time of each step, without ever waiting.
//!
//! The GPU writes a timestamp at the begin and end of each step; they are copied out, mapped when the frame is done, and
//! read some frames later. A few frames are in flight at once; when all are still busy, a frame goes unmeasured. The
//! first frames after a change of the steps compile shaders and are left out. Timestamps that are zero or run backwards (a
//! counter that wrapped, a driver that gave up) are dropped.

use crate::device::gpu::Gpu;
use crate::execute::recording::{Recording, StepTime};
use crate::hash::fnv;
use crate::measure::statistics::{Durations, Summary};
use crate::measure::timestamp_queries::{FrameTimestamps, StepSpans};
use crate::measure::trace::{Recorder, Trace};
use framegraph::{PassKind, Plan, StepId};
use std::time::{Duration, Instant};
use wgpu::{CommandEncoder, Features, QuerySet};

/// Frames whose timestamps are on their way.
const IN_FLIGHT: usize = 4;

/// Times of the steps of the plan that was executed last, in a ring of a few frames that are still on their way.
#[derive(Debug)]
pub struct Timing {
    slots: Vec<FrameTimestamps>,
    /// The slot of the frame that is being recorded.
    current: Option<usize>,
    /// The first of the two queries of each step; none for a step that cannot be measured.
    queries: Vec<Option<u32>>,
    steps: Vec<StepDurations>,
    frame: StepDurations,
    generation: u64,
    /// The compilation whose plan was executed last.
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

/// Times of one step, or of the whole frame; `None` while there are no measurements, or none are possible.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// On the GPU.
    pub gpu: Option<Summary>,
    /// Recording on the CPU; for the whole frame, from realizing to submitting.
    pub cpu: Option<Summary>,
}

/// Where a step writes the times of its begin and end.
#[derive(Debug)]
pub(crate) struct TimestampWrites {
    pub(crate) queries: QuerySet,
    pub(crate) begin: u32,
    pub(crate) end: u32,
}

impl Timing {
    /// Frames left out after the steps change: they compile shaders and fill caches.
    pub const WARM_UP: u32 = 4;

    /// Whether times are read back.
    pub(crate) fn is_enabled(&self) -> bool {
        self.enabled || self.trace.is_some()
    }

    /// Measures where the device can, if `enabled`; the CPU times of frames are taken in any case. With `trace`, every frame is
    /// written down.
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

    /// Times of one step of the plan that was executed last.
    pub fn step(&self, step: StepId) -> Times {
        self.steps.get(step.index()).map(StepDurations::times).unwrap_or_default()
    }

    /// Times of the whole frame; on the GPU, from the first timestamp to the last.
    pub fn frame(&self) -> Times {
        self.frame.times()
    }

    /// CPU time of a frame that was spent inside of wgpu's calls to open and close passes, to finish, submit and poll, and
    /// to upload; what recorders call themselves is not in it. None where the times of steps are not measured.
    pub fn wgpu(&self) -> Option<Summary> {
        self.wgpu.summary()
    }

    /// The frames that were written down; none unless that was asked for.
    pub fn trace(&self) -> Option<&Trace> {
        self.trace.as_ref().map(Recorder::trace)
    }

    /// Forgets all measurements and warms up again.
    pub fn reset(&mut self) {
        self.steps.iter_mut().for_each(StepDurations::clear);
        self.frame.clear();
        self.wgpu.clear();
        self.warm_up_left = Self::WARM_UP;
        // Frames in flight are of before.
        self.slots.iter_mut().for_each(|s| s.counted = false);
    }

    /// Begins a frame: reads what has arrived, and takes an idle slot if there is one.
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
        if !self.enabled || !gpu.device.features().contains(Features::TIMESTAMP_QUERY) {
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

    /// The number of the plan that is executed: another one where its frame's size or the passes of its steps are others.
    pub(crate) fn plan(&self) -> u64 {
        self.generation
    }

    /// Where a step writes its timestamps; none when it is not measured.
    pub(crate) fn writes(&self, step: StepId) -> Option<TimestampWrites> {
        let begin = (*self.queries.get(step.index())?)?;
        let queries = self.slots[self.current?].queries().clone();
        Some(TimestampWrites { queries, begin, end: begin + 1 })
    }

    /// Copies the timestamps of the frame to where they can be read.
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

    /// Gives the timestamps of the frame in `slot` to its steps.
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

    /// Waits for nothing, but reads what has arrived since the last frame: call it before a report.
    ///
    /// # Errors
    /// When the device is lost.
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

    fn clear(&mut self) {
        self.gpu.clear();
        self.cpu.clear();
    }
}

/// The first of the two queries of each step of `plan`, and how many queries that are; `copies` can be measured or not.
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

/// Equal for plans of one frame size whose steps have the same passes.
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

    /// A raster, a copy, a compute and a raster step.
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

    /// Each step writes stamps of its own length where it was told to; the lengths come back under the same steps.
    #[test]
    fn every_step_gets_the_time_between_its_own_stamps() -> TestResult {
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
        assert!((whole - 4321.0015).abs() < 1e-9, "{whole} is the sum, and three pauses");
        Ok(())
    }

    #[test]
    fn copies_take_no_queries_where_they_cannot_be_measured() -> TestResult {
        let (plan, mut queries) = (four_steps()?, Vec::new());
        assert_eq!(assign(&plan, true, &mut queries), 8);
        assert_eq!(queries, [Some(0), Some(2), Some(4), Some(6)]);
        assert_eq!(assign(&plan, false, &mut queries), 6);
        assert_eq!(queries, [Some(0), None, Some(2), Some(4)]);
        Ok(())
    }
}
