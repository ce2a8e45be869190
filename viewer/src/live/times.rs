//! Times of the live frame for the views.

use crate::trace_data::{TraceData, TracedFrame, TracedStep};
use framegraph_wgpu::Trace;
use std::collections::VecDeque;
use std::time::Instant;

/// Number of frames in the views.
const SHOWN: usize = 240;

/// Returns the latest frames, with the steps of those that executed the last plan.
pub(super) fn of(trace: &Trace) -> TraceData {
    let mut data = TraceData::default();
    let frames: Vec<_> = trace.latest(SHOWN).collect();
    let names = |frame: &framegraph_wgpu::FrameTimes<'_>| -> Vec<String> {
        frame.steps.iter().map(|step| step.name.to_owned()).collect()
    };
    let last = frames.last().map(names).unwrap_or_default();
    for name in &last {
        let earlier = data.steps.iter().filter(|step: &&TracedStep| step.name == *name).count();
        data.steps.push(TracedStep { name: name.clone(), earlier, ..TracedStep::default() });
    }
    let first = frames.iter().rposition(|frame| names(frame) != last).map_or(0, |other| other + 1);
    for (index, frame) in frames.iter().enumerate() {
        let (cpu_ms, gpu_ms) = (frame.cpu_ms, frame.gpu_ms);
        data.frames.push(TracedFrame { number: frame.number, warm_up: frame.warm_up, cpu_ms, gpu_ms });
        if index >= first && !frame.warm_up {
            for (step, times) in data.steps.iter_mut().zip(&frame.steps) {
                step.cpu_ms.extend(times.cpu_ms);
                step.gpu_ms.extend(times.gpu_ms);
            }
        }
    }
    for step in &mut data.steps {
        step.cpu_ms.sort_unstable_by(f64::total_cmp);
        step.gpu_ms.sort_unstable_by(f64::total_cmp);
    }
    data
}

/// Times of the latest frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Clock(VecDeque<Instant>);

impl Clock {
    /// Records a drawn frame.
    pub fn tick(&mut self, now: Instant) {
        // A pause must not count as a slow frame.
        if self.0.back().is_some_and(|last| now.duration_since(*last).as_secs_f32() > 2.0) {
            self.0.clear();
        }
        self.0.push_back(now);
        if self.0.len() > 32 {
            self.0.pop_front();
        }
    }

    /// Returns frames per second; `None` for fewer than four frames.
    pub fn frames_per_s(&self) -> Option<f32> {
        let (first, last) = (self.0.front()?, self.0.back()?);
        let passed = last.duration_since(*first).as_secs_f32();
        (self.0.len() >= 4 && passed > 0.0).then(|| (self.0.len() - 1) as f32 / passed)
    }
}
