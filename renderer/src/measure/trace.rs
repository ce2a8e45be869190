//! Traces: times of individual frames, exported in the Trace Event Format of Chrome and Perfetto.

use crate::clock::Instant;
use crate::execute::recording::StepTime;
use crate::measure::timestamp_queries::StepSpans;
use framegraph::{Counts, Join, Plan, StepPass, Traffic};
use std::collections::VecDeque;
use std::fmt::Write;
use std::sync::Arc;

/// Maximum number of frames kept, more than `render --trace` draws.
const KEPT: usize = 1 << 14;

/// CPU and GPU times of the most recent frames and their steps.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    frames: VecDeque<Traced>,
}

/// Times of one frame.
#[derive(Clone, Debug)]
struct Traced {
    number: u64,
    warm_up: bool,
    described: Arc<Described>,
    /// CPU interval, in nanoseconds since the recorder was created.
    cpu: Between,
    cpu_steps: Vec<Between>,
    /// GPU intervals, in nanoseconds of the GPU's clock.
    gpu_steps: Vec<Option<Between>>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Between {
    begin_ns: f64,
    end_ns: f64,
}

impl Between {
    fn ms(&self) -> f64 {
        (self.end_ns - self.begin_ns) / 1e6
    }
}

/// Times of one frame ([`Trace::latest`]).
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTimes<'a> {
    /// Frame number, counted from the first traced frame.
    pub number: u64,
    /// True if this is a warm-up frame, which creates pipelines.
    pub warm_up: bool,
    /// CPU time from resource creation until submission, in milliseconds.
    pub cpu_ms: f64,
    /// GPU time from the begin of the first step to the end of the last, in milliseconds. `None` until it is known.
    pub gpu_ms: Option<f64>,
    /// Steps in order of execution.
    pub steps: Vec<StepTimes<'a>>,
}

/// Times of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepTimes<'a> {
    /// Names of the passes, joined by ` + `.
    pub name: &'a str,
    /// CPU time of recording, in milliseconds.
    pub cpu_ms: Option<f64>,
    /// GPU time, in milliseconds; `None` if it was not measured.
    pub gpu_ms: Option<f64>,
}

/// Names and counts of the steps of a plan.
#[derive(Debug)]
struct Described {
    generation: u64,
    steps: Vec<(String, &'static str, Counts, Traffic)>,
    counts: Counts,
    traffic: Traffic,
}

/// Stores the times of frames.
#[derive(Debug)]
pub(crate) struct Recorder {
    trace: Trace,
    epoch: Instant,
    next: u64,
    described: Option<Arc<Described>>,
    open: Option<Traced>,
}

impl Recorder {
    pub(crate) fn new() -> Self {
        let (trace, epoch) = (Trace::default(), Instant::now());
        Self { trace, epoch, next: 0, described: None, open: None }
    }

    pub(crate) fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Returns the number of the current frame.
    pub(crate) fn frame(&self) -> u64 {
        self.next
    }

    fn ns(&self, at: Instant) -> f64 {
        at.duration_since(self.epoch).as_secs_f64() * 1e9
    }

    pub(crate) fn begin_frame(&mut self, plan: &Plan, generation: u64, warm_up: bool) {
        let described = match self.described.take().filter(|d| d.generation == generation) {
            Some(known) => known,
            None => Arc::new(Described::new(plan, generation)),
        };
        self.described = Some(described.clone());
        let cpu = Between { begin_ns: self.ns(Instant::now()), end_ns: 0.0 };
        let (cpu_steps, gpu_steps) = (Vec::new(), vec![None; described.steps.len()]);
        self.open = Some(Traced { number: self.next, warm_up, described, cpu, cpu_steps, gpu_steps });
    }

    pub(crate) fn end_frame(&mut self, steps: &[StepTime]) {
        if let Some(mut open) = self.open.take() {
            open.cpu.end_ns = self.ns(Instant::now());
            let between = |s: &StepTime| Between { begin_ns: self.ns(s.begun), end_ns: self.ns(s.ended) };
            open.cpu_steps.extend(steps.iter().map(between));
            self.trace.frames.push_back(open);
            if self.trace.frames.len() > KEPT {
                self.trace.frames.pop_front();
            }
            self.next += 1;
        }
    }

    /// Stores GPU times of a frame that have arrived.
    pub(crate) fn measured(&mut self, number: u64, spans: &StepSpans) {
        if let Some(frame) = self.trace.frames.iter_mut().rev().find(|f| f.number == number) {
            let steps = spans.steps.iter().map(|s| s.map(|s| Between { begin_ns: s.begin_ns, end_ns: s.end_ns }));
            frame.gpu_steps = steps.collect();
        }
    }
}

impl Described {
    fn new(plan: &Plan, generation: u64) -> Self {
        let graph = plan.graph();
        let steps = plan.step_ids().map(|step| {
            let name = |m: &StepPass| match m.join {
                Join::Resolve => format!("{} (resolve)", graph.pass_name(m.pass)),
                _ => graph.pass_name(m.pass).to_owned(),
            };
            let names: Vec<_> = plan.passes_of(step).iter().map(name).collect();
            let kind = plan.steps()[step.index()].kind.word();
            (names.join(" + "), kind, plan.step_counts(step), plan.step_traffic(step, plan.frame()))
        });
        Self { generation, steps: steps.collect(), counts: plan.counts(), traffic: plan.traffic(plan.frame()) }
    }
}

/// Process and thread IDs of the tracks.
const CPU: u32 = 1;
const GPU: u32 = 2;
const FRAMES: u32 = 1;
const STEPS: u32 = 2;

impl Trace {
    /// Returns the number of stored frames.
    pub fn frames(&self) -> usize {
        self.frames.len()
    }

    /// Returns the times of up to `max` most recent frames, oldest first.
    pub fn latest(&self, max: usize) -> impl Iterator<Item = FrameTimes<'_>> {
        self.frames.iter().skip(self.frames.len().saturating_sub(max)).map(|frame| {
            let steps = frame.described.steps.iter().enumerate().map(|(index, (name, ..))| StepTimes {
                name,
                cpu_ms: frame.cpu_steps.get(index).map(Between::ms),
                gpu_ms: frame.gpu_steps.get(index).copied().flatten().map(|step| step.ms()),
            });
            let measured = || frame.gpu_steps.iter().flatten();
            let begin_ns = measured().map(|step| step.begin_ns).fold(f64::INFINITY, f64::min);
            let end_ns = measured().map(|step| step.end_ns).fold(f64::NEG_INFINITY, f64::max);
            FrameTimes {
                number: frame.number,
                warm_up: frame.warm_up,
                cpu_ms: frame.cpu.ms(),
                gpu_ms: (end_ns >= begin_ns).then(|| Between { begin_ns, end_ns }.ms()),
                steps: steps.collect(),
            }
        })
    }

    /// Exports the frames as JSON in the Trace Event Format (Google, 2016).
    ///
    /// There is one process for the CPU and one for the GPU, each with a track of frames and a track of steps. Events
    /// are named after passes; counts and bytes are arguments.
    ///
    /// CPU times cover recording; those of frames cover resource creation until submission. wgpu does not relate the
    /// GPU's clock to the CPU's. All GPU events are therefore shifted by one offset, the smallest for which no frame
    /// begins before its submission.
    pub fn chrome_json(&self) -> String {
        let mut events = Vec::new();
        for (process, name) in [(CPU, "CPU"), (GPU, "GPU")] {
            events.push(named("process_name", process, 0, name));
            events.push(named("thread_name", process, FRAMES, "frames"));
            events.push(named("thread_name", process, STEPS, "steps"));
        }
        let offset_ns = self.gpu_offset_ns();
        for frame in &self.frames {
            let Traced { number, warm_up, described, cpu, cpu_steps, gpu_steps } = frame;
            let title = format!("frame {number}");
            let about = format!(
                "{},\"passes\":{},\"culled\":{},\"memoryless\":{},\"warm_up\":{warm_up}",
                arguments(&described.counts, &described.traffic),
                described.counts.passes,
                described.counts.culled,
                described.counts.memoryless,
            );
            events.push(complete(&title, CPU, FRAMES, *cpu, 0.0, &about));
            let gpu = gpu_steps
                .iter()
                .flatten()
                .copied()
                .reduce(|a, b| Between { begin_ns: a.begin_ns.min(b.begin_ns), end_ns: a.end_ns.max(b.end_ns) });
            events.extend(gpu.map(|gpu| complete(&title, GPU, FRAMES, gpu, offset_ns, &about)));
            for (index, (name, kind, counts, traffic)) in described.steps.iter().enumerate() {
                let about = format!("{},\"kind\":\"{kind}\",\"frame\":{number}", arguments(counts, traffic));
                let on_cpu = cpu_steps.get(index).map(|step| complete(name, CPU, STEPS, *step, 0.0, &about));
                let measured = gpu_steps.get(index).copied().flatten();
                let on_gpu = measured.map(|step| complete(name, GPU, STEPS, step, offset_ns, &about));
                events.extend(on_cpu.into_iter().chain(on_gpu));
            }
        }
        format!("{{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n{}\n]}}\n", events.join(",\n"))
    }

    /// Returns the offset added to GPU times.
    fn gpu_offset_ns(&self) -> f64 {
        let offsets = self.frames.iter().filter_map(|frame| {
            let first = frame.gpu_steps.iter().flatten().map(|s| s.begin_ns).reduce(f64::min)?;
            Some(frame.cpu.end_ns - first)
        });
        offsets.reduce(f64::max).unwrap_or(0.0)
    }
}

fn arguments(counts: &Counts, traffic: &Traffic) -> String {
    format!(
        "\"unresolves\":{},\"resolves\":{},\"clears\":{},\"discards\":{},\"loaded_bytes\":{},\"stored_bytes\":{}",
        counts.unresolves, counts.resolves, counts.clears, counts.discards, traffic.loaded_bytes, traffic.stored_bytes
    )
}

fn named(what: &str, process: u32, thread: u32, name: &str) -> String {
    format!("{{\"name\":\"{what}\",\"ph\":\"M\",\"pid\":{process},\"tid\":{thread},\"args\":{{\"name\":\"{name}\"}}}}")
}

/// Formats a complete event. Times are in microseconds.
fn complete(name: &str, process: u32, thread: u32, span: Between, offset_ns: f64, arguments: &str) -> String {
    let (begin_us, length_us) = ((span.begin_ns + offset_ns) / 1e3, (span.end_ns - span.begin_ns) / 1e3);
    format!(
        "{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":{process},\"tid\":{thread},\"ts\":{begin_us:.3},\"dur\":{length_us:.3},\
         \"args\":{{{arguments}}}}}",
        escaped(name)
    )
}

/// Escapes a string for JSON.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if u32::from(c) < 0x20 => {
                let written = write!(out, "\\u{:04x}", u32::from(c));
                // Writing to a string does not fail.
                debug_assert!(written.is_ok());
            }
            c => out.push(c),
        }
    }
    out
}
