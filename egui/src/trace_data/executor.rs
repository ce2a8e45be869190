//! Frame times of `framegraph-wgpu`.

use super::{TraceData, TracedFrame, TracedStep};
use framegraph_wgpu::Trace;

/// Number of frames in the views.
const SHOWN: usize = 240;

impl TraceData {
    /// Returns the latest frames of an executor, with the steps of those that executed the last plan.
    pub fn of_trace(trace: &Trace) -> Self {
        let mut data = Self::default();
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
}
