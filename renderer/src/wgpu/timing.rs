//! GPU and CPU time of each step, without ever waiting.
//!
//! The GPU writes a timestamp at the begin and end of each step; they are copied out, mapped when the frame is done, and
//! read some frames later. A few frames are in flight at once; when all are still busy, a frame goes unmeasured. The
//! first frames after a change of the steps compile shaders and are left out. Stamps that are zero or run backwards (a
//! counter that wrapped, a driver that gave up) are dropped.

use super::device::Gpu;
use super::hash::fnv;
use super::samples::{Samples, Summary};
use framegraph::{PassKind, Plan, StepId};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, Instant};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Features, MapMode, QuerySet, QuerySetDescriptor, QueryType,
};

/// Frames whose stamps are on their way.
const IN_FLIGHT: usize = 4;
/// Frames left out after the steps change.
const WARM_UP: u32 = 4;

const IDLE: u8 = 0;
const WAITING: u8 = 1;
const READY: u8 = 2;
const FAILED: u8 = 3;

/// Times of the steps of the plan that was executed last, in a ring of a few frames that are still on their way.
#[derive(Debug)]
pub struct Timing {
    slots: Vec<Slot>,
    /// The slot of the frame that is being recorded.
    current: Option<usize>,
    /// The first of the two queries of each step; none for a step that cannot be stamped.
    queries: Vec<Option<u32>>,
    steps: Vec<StepSamples>,
    frame: StepSamples,
    generation: u64,
    warm_up_left: u32,
    opened: Option<Instant>,
    begun: Option<Instant>,
    enabled: bool,
}

#[derive(Debug, Default)]
struct StepSamples {
    gpu: Samples,
    cpu: Samples,
}

#[derive(Debug)]
struct Slot {
    queries: QuerySet,
    resolved: Buffer,
    read: Buffer,
    state: Arc<AtomicU8>,
    generation: u64,
    used: u32,
    counted: bool,
}

/// Times of one step, or of the whole frame; `None` while there are no measurements, or none are possible.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// On the GPU.
    pub gpu: Option<Summary>,
    /// Recording on the CPU; for the whole frame, from realizing to submitting.
    pub cpu: Option<Summary>,
}

/// Where a step writes its stamps.
#[derive(Debug)]
pub(crate) struct Stamps {
    pub(crate) queries: QuerySet,
    pub(crate) begin: u32,
    pub(crate) end: u32,
}

impl Timing {
    /// Measures where the device can, if `enabled`; CPU times are taken in any case.
    pub(crate) fn new(enabled: bool) -> Self {
        Self {
            slots: Vec::new(),
            current: None,
            queries: Vec::new(),
            steps: Vec::new(),
            frame: StepSamples::default(),
            generation: 0,
            warm_up_left: WARM_UP,
            opened: None,
            begun: None,
            enabled,
        }
    }

    /// Times of one step of the plan that was executed last.
    pub fn step(&self, step: StepId) -> Times {
        self.steps.get(step.index()).map(StepSamples::times).unwrap_or_default()
    }

    /// Times of the whole frame; on the GPU, from the first stamp to the last.
    pub fn frame(&self) -> Times {
        self.frame.times()
    }

    /// Forgets all measurements and warms up again.
    pub fn reset(&mut self) {
        self.steps.iter_mut().for_each(StepSamples::clear);
        self.frame.clear();
        self.warm_up_left = WARM_UP;
        // Frames in flight are of before.
        self.slots.iter_mut().for_each(|s| s.counted = false);
    }

    /// Begins a frame: reads what has arrived, and takes an idle slot if there is one.
    pub(crate) fn begin_frame(&mut self, gpu: &Gpu, plan: &Plan) {
        self.begun = Some(Instant::now());
        self.current = None;
        let generation = fingerprint(plan);
        if generation != self.generation {
            self.generation = generation;
            self.steps.clear();
            self.steps.resize_with(plan.steps().len(), StepSamples::default);
            self.reset();
        }
        self.collect(f64::from(gpu.queue.get_timestamp_period()));
        if !self.enabled || !gpu.device.features().contains(Features::TIMESTAMP_QUERY) {
            return;
        }
        let copies = gpu.device.features().contains(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);
        let mut used = 0;
        self.queries.clear();
        self.queries.extend(plan.steps().iter().map(|step| {
            let query = (step.kind != PassKind::Copy || copies).then_some(used);
            used += if query.is_some() { 2 } else { 0 };
            query
        }));
        let idle = |s: &Slot| s.state.load(Ordering::Acquire) == IDLE;
        let free =
            self.slots.iter().position(idle).or_else(|| (self.slots.len() < IN_FLIGHT).then_some(self.slots.len()));
        let (Some(index), 1..=4096) = (free, used) else {
            return;
        };
        if self.slots.get(index).is_none_or(|s| s.queries.count() < used) {
            let slot = Slot::new(gpu, used.next_power_of_two().max(32));
            match self.slots.get_mut(index) {
                Some(old) => *old = slot,
                None => self.slots.push(slot),
            }
        }
        let slot = &mut self.slots[index];
        (slot.generation, slot.used, slot.counted) = (generation, used, self.warm_up_left == 0);
        self.current = Some(index);
    }

    /// Begins a step and says where it writes its stamps.
    pub(crate) fn begin_step(&mut self, step: StepId) -> Option<Stamps> {
        self.opened = Some(Instant::now());
        let begin = (*self.queries.get(step.index())?)?;
        let queries = self.slots[self.current?].queries.clone();
        Some(Stamps { queries, begin, end: begin + 1 })
    }

    /// Ends a step.
    pub(crate) fn end_step(&mut self, step: StepId) {
        if let (Some(opened), 0, Some(samples)) =
            (self.opened.take(), self.warm_up_left, self.steps.get_mut(step.index()))
        {
            samples.cpu.push(ms(opened.elapsed()));
        }
    }

    /// Copies the stamps of the frame to where they can be read.
    pub(crate) fn resolve(&self, encoder: &mut CommandEncoder) {
        if let Some(slot) = self.current.map(|c| &self.slots[c]) {
            let bytes = u64::from(slot.used) * 8;
            encoder.resolve_query_set(&slot.queries, 0..slot.used, &slot.resolved, 0);
            encoder.copy_buffer_to_buffer(&slot.resolved, 0, &slot.read, 0, bytes);
        }
    }

    /// Ends a frame that was submitted.
    pub(crate) fn submitted(&mut self) {
        if let Some(slot) = self.current.take().map(|c| &self.slots[c]) {
            slot.state.store(WAITING, Ordering::Release);
            let state = slot.state.clone();
            slot.read.map_async(MapMode::Read, ..u64::from(slot.used) * 8, move |mapped| {
                state.store(if mapped.is_ok() { READY } else { FAILED }, Ordering::Release);
            });
        }
        if let (Some(begun), 0) = (self.begun.take(), self.warm_up_left) {
            self.frame.cpu.push(ms(begun.elapsed()));
        }
        self.warm_up_left = self.warm_up_left.saturating_sub(1);
    }

    /// Reads the stamps that have arrived.
    fn collect(&mut self, period_ns: f64) {
        let Self { slots, queries, steps, frame, generation, .. } = self;
        for slot in slots.iter_mut() {
            match slot.state.load(Ordering::Acquire) {
                READY => {
                    if slot.counted && slot.generation == *generation {
                        read(slot, period_ns, queries, steps, frame);
                    }
                    slot.read.unmap();
                    slot.state.store(IDLE, Ordering::Release);
                }
                FAILED => slot.state.store(IDLE, Ordering::Release),
                _ => {}
            }
        }
    }

    /// Waits for nothing, but reads what has arrived since the last frame: call it before a report.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn catch_up(&mut self, gpu: &Gpu) -> Result<(), super::trouble::DeviceError> {
        gpu.poll()?;
        self.collect(f64::from(gpu.queue.get_timestamp_period()));
        Ok(())
    }
}

impl Slot {
    fn new(gpu: &Gpu, count: u32) -> Self {
        let size = u64::from(count) * 8;
        let buffer = |label, usage| {
            gpu.device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        Self {
            queries: gpu.device.create_query_set(&QuerySetDescriptor {
                label: Some("stamps"),
                ty: QueryType::Timestamp,
                count,
            }),
            resolved: buffer("stamps resolved", BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            read: buffer("stamps read", BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            state: Arc::new(AtomicU8::new(IDLE)),
            generation: 0,
            used: 0,
            counted: false,
        }
    }
}

impl StepSamples {
    fn times(&self) -> Times {
        Times { gpu: self.gpu.summary(), cpu: self.cpu.summary() }
    }

    fn clear(&mut self) {
        self.gpu.clear();
        self.cpu.clear();
    }
}

fn read(slot: &Slot, period_ns: f64, queries: &[Option<u32>], steps: &mut [StepSamples], frame: &mut StepSamples) {
    let Ok(mapped) = slot.read.get_mapped_range(..u64::from(slot.used) * 8) else {
        return;
    };
    let stamps: Vec<u64> =
        mapped.chunks_exact(8).map(|b| u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]])).collect();
    for (query, samples) in queries.iter().zip(steps) {
        let pair = query.and_then(|q| Some((*stamps.get(q as usize)?, *stamps.get(q as usize + 1)?)));
        if let Some(ms) = pair.and_then(|(begin, end)| elapsed_ms(begin, end, period_ns)) {
            samples.gpu.push(ms);
        }
    }
    let (first, last) = (stamps.iter().min(), stamps.iter().max());
    if let Some(ms) = first.zip(last).and_then(|(begin, end)| elapsed_ms(*begin, *end, period_ns)) {
        frame.gpu.push(ms);
    }
}

/// Milliseconds between two stamps; `None` when one was not written or they run backwards.
fn elapsed_ms(begin: u64, end: u64, period_ns: f64) -> Option<f64> {
    (begin != 0 && end > begin).then(|| (end - begin) as f64 * period_ns * 1e-6)
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

    #[test]
    fn bad_stamps_are_dropped() {
        assert_eq!(elapsed_ms(1_000_000, 3_000_000, 1.0), Some(2.0));
        assert_eq!(elapsed_ms(0, 3_000_000, 1.0), None, "not written");
        assert_eq!(elapsed_ms(5, 5, 1.0), None, "no time passed");
        assert_eq!(elapsed_ms(u64::MAX - 5, 10, 1.0), None, "wrapped");
    }
}
