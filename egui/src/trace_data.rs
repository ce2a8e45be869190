//! Trace of many frames: times of each step on CPU and GPU with quartiles, and stuttering frames.
//!
//! `render --trace` and `framegraph_wgpu::Trace` write the file in Chrome's Trace Event Format. CPU and GPU are processes,
//! each with a track of frames and a track of steps.

#[cfg(feature = "wgpu")]
mod executor;

use crate::plan_data::{PlanData, Step};
use serde::Deserialize;
use std::collections::HashMap;

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
    /// Number of earlier steps of the frame with an equal name, such as the cascades of a shadow map.
    pub earlier: usize,
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
    /// Returns the times of every step of a plan, by index.
    pub fn steps_of(&self, plan: &PlanData) -> Vec<Option<&TracedStep>> {
        let traced: HashMap<(&str, usize), &TracedStep> =
            self.steps.iter().map(|step| ((step.name.as_str(), step.earlier), step)).collect();
        let mut counts: HashMap<String, usize> = HashMap::new();
        let of = |step| {
            let name = traced_name(plan, step);
            let earlier = counts.entry(name.clone()).or_default();
            *earlier += 1;
            traced.get(&(name.as_str(), *earlier - 1)).copied()
        };
        plan.form.steps.iter().map(of).collect()
    }

    /// Returns a sentence if the steps of the trace differ from those of a plan.
    pub fn mismatch(&self, plan: &PlanData) -> Option<String> {
        let found = self.steps_of(plan);
        let missing = found.iter().filter(|step| step.is_none()).count();
        let more = self.steps.len().saturating_sub(found.len() - missing);
        let first = || {
            let index = found.iter().position(Option::is_none);
            let of_plan = index.map(|index| traced_name(plan, &plan.form.steps[index]));
            let is_found = |step: &&TracedStep| found.iter().flatten().any(|known| std::ptr::eq(*known, *step));
            of_plan.or_else(|| self.steps.iter().find(|step| !is_found(step)).map(|step| step.name.clone()))
        };
        (missing + more > 0).then(|| {
            format!(
                "the trace is of another frame: {missing} of {} steps of the plan have no times, {more} steps of the \
                 trace are not in the plan, such as `{}`",
                found.len(),
                first().unwrap_or_default()
            )
        })
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

/// Returns the name of a step in traces: its passes, without the numbers that plans give to passes of equal names.
pub fn traced_name(plan: &PlanData, step: &Step) -> String {
    let plain = |name: &String| {
        let own = match name.rsplit_once('#') {
            Some((plain, number)) if number.parse::<u32>().is_ok() => plain,
            _ => name.as_str(),
        };
        // A full-screen resolve is a pass of its own, named after the pass whose samples it resolves.
        let elsewhere = || plan.pass(name).is_some_and(|pass| plan.form.passes[pass].step != Some(step.index));
        let resolves = step.full_screen_resolve && elsewhere();
        format!("{own}{}", if resolves { " (resolve)" } else { "" })
    };
    step.passes.iter().map(plain).collect::<Vec<_>>().join(" + ")
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
    // Steps of one frame may have equal names; their events follow in the order of execution.
    let mut counts: HashMap<(u64, u64, &str), usize> = HashMap::new();
    let mut indices: HashMap<(&str, usize), usize> = HashMap::new();
    for event in complete().filter(|e| !frame_tracks.contains(&(e.pid, e.tid))) {
        let Some(frame) = event.args.frame.filter(|frame| warm.contains(frame)) else { continue };
        let count = counts.entry((frame, event.pid, event.name.as_str())).or_default();
        let earlier = std::mem::replace(count, *count + 1);
        let index = *indices.entry((event.name.as_str(), earlier)).or_insert_with(|| {
            trace.steps.push(TracedStep { name: event.name.clone(), earlier, ..TracedStep::default() });
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
