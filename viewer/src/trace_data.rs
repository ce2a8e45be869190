//! Trace of many frames: times of each step on CPU and GPU with quartiles, and stuttering frames.
//!
//! `render --trace` and `framegraph_wgpu::Trace` write the file in Chrome's Trace Event Format. CPU and GPU are processes,
//! each with a track of frames and a track of steps.

use serde::Deserialize;

/// Ratio to the median time from which a frame counts as a stutter.
pub const STUTTER: f64 = 2.0;

/// Frames of a trace.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TraceData {
    /// Frames in the order of the file.
    pub frames: Vec<TracedFrame>,
    /// Steps in the order of their first appearance.
    pub steps: Vec<TracedStep>,
}

/// Traced frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TracedFrame {
    /// Frame number.
    pub number: u64,
    /// Warm-up frame, during which pipelines are created.
    pub warm_up: bool,
    /// Time on the CPU from resource creation to submission, in milliseconds.
    pub cpu_ms: f64,
    /// Time on the GPU from the first step to the last, in milliseconds; `None` if it was not measured.
    pub gpu_ms: Option<f64>,
}

/// Times of a step over all frames after warm-up, in milliseconds, sorted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TracedStep {
    /// Names of its passes, joined by ` + `.
    pub name: String,
    /// Recording times on the CPU.
    pub cpu_ms: Vec<f64>,
    /// Execution times on the GPU.
    pub gpu_ms: Vec<f64>,
}

/// Returns first quartile, median and third quartile of sorted numbers by nearest rank; `None` for an empty slice.
pub fn quartiles(sorted: &[f64]) -> Option<[f64; 3]> {
    let last = sorted.len().checked_sub(1)?;
    Some([1, 2, 3].map(|quarter| sorted[(last * quarter + 2) / 4]))
}

impl TraceData {
    /// Returns the step with these passes.
    pub fn step(&self, passes: &[String]) -> Option<&TracedStep> {
        // Plans number passes of equal names, traces do not.
        let plain = |name: &String| match name.rsplit_once('#') {
            Some((plain, number)) if number.parse::<u32>().is_ok() => plain.to_owned(),
            _ => name.clone(),
        };
        let name = passes.iter().map(plain).collect::<Vec<_>>().join(" + ");
        self.steps.iter().find(|step| step.name == name)
    }

    /// Returns the frames after warm-up.
    pub fn warm(&self) -> impl Iterator<Item = &TracedFrame> {
        self.frames.iter().filter(|frame| !frame.warm_up)
    }

    /// Returns the median frame time in milliseconds, on the GPU if measured, else on the CPU.
    pub fn median_ms(&self) -> Option<f64> {
        let mut times: Vec<f64> = self.warm().map(TracedFrame::time_ms).collect();
        times.sort_unstable_by(f64::total_cmp);
        quartiles(&times).map(|[_, median, _]| median)
    }

    /// Returns the frames that took at least [`STUTTER`] times the median.
    pub fn stutters(&self) -> Vec<&TracedFrame> {
        let limit = self.median_ms().map_or(f64::INFINITY, |median| median * STUTTER);
        self.warm().filter(|frame| frame.time_ms() >= limit && frame.time_ms() > 0.0).collect()
    }
}

impl TracedFrame {
    /// Returns the time in milliseconds, on the GPU if measured, else on the CPU.
    pub fn time_ms(&self) -> f64 {
        self.gpu_ms.unwrap_or(self.cpu_ms)
    }
}

#[derive(Deserialize)]
struct Form {
    #[serde(rename = "traceEvents")]
    events: Vec<Event>,
}

#[derive(Deserialize)]
struct Event {
    name: String,
    ph: String,
    #[serde(default)]
    pid: u64,
    #[serde(default)]
    tid: u64,
    #[serde(default)]
    dur: f64,
    #[serde(default)]
    args: Arguments,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Arguments {
    /// Name of the process or thread, in metadata events.
    name: Option<String>,
    warm_up: Option<bool>,
    frame: Option<u64>,
}

/// Parses a trace.
///
/// # Errors
/// A sentence: invalid JSON, or no events of this library.
pub fn read(text: &[u8]) -> Result<TraceData, String> {
    let form: Form = serde_json::from_slice(text).map_err(|e| format!("invalid trace: {e}"))?;
    // Metadata, not numbers, identifies processes and threads.
    let mut gpus = Vec::new();
    let mut frame_tracks = Vec::new();
    for event in form.events.iter().filter(|e| e.ph == "M") {
        match (event.name.as_str(), event.args.name.as_deref()) {
            ("process_name", Some("GPU")) => gpus.push(event.pid),
            ("thread_name", Some("frames")) => frame_tracks.push((event.pid, event.tid)),
            _ => {}
        }
    }
    let mut trace = TraceData::default();
    let complete = || form.events.iter().filter(|e| e.ph == "X" && e.dur.is_finite());
    for event in complete().filter(|e| frame_tracks.contains(&(e.pid, e.tid))) {
        let Some(number) = event.name.strip_prefix("frame ").and_then(|n| n.parse().ok()) else { continue };
        let ms = event.dur / 1e3;
        let on_gpu = gpus.contains(&event.pid);
        match trace.frames.iter_mut().rev().find(|f: &&mut TracedFrame| f.number == number) {
            Some(frame) if on_gpu => frame.gpu_ms = Some(ms),
            Some(frame) => frame.cpu_ms = ms,
            None => {
                let warm_up = event.args.warm_up.unwrap_or(false);
                let (cpu_ms, gpu_ms) = if on_gpu { (0.0, Some(ms)) } else { (ms, None) };
                trace.frames.push(TracedFrame { number, warm_up, cpu_ms, gpu_ms });
            }
        }
    }
    if trace.frames.is_empty() {
        return Err("no frames of this library in the trace; write one with `render SCENE --trace FILE.json`".into());
    }
    let warm: std::collections::HashSet<u64> = trace.warm().map(|frame| frame.number).collect();
    for event in complete().filter(|e| !frame_tracks.contains(&(e.pid, e.tid))) {
        if event.args.frame.is_none_or(|frame| !warm.contains(&frame)) {
            continue;
        }
        let index = trace.steps.iter().position(|step| step.name == event.name).unwrap_or_else(|| {
            trace.steps.push(TracedStep { name: event.name.clone(), ..TracedStep::default() });
            trace.steps.len() - 1
        });
        let step = &mut trace.steps[index];
        let times = if gpus.contains(&event.pid) { &mut step.gpu_ms } else { &mut step.cpu_ms };
        times.push(event.dur / 1e3);
    }
    for step in &mut trace.steps {
        step.cpu_ms.sort_unstable_by(f64::total_cmp);
        step.gpu_ms.sort_unstable_by(f64::total_cmp);
    }
    Ok(trace)
}
