//! The frame on devices with several queues: a lane a queue with steps as long as they take, semaphores between lanes, and what it wins.

use super::words::{bytes, title};
use crate::drawing::{Align, Drawing, Ink, Item, letters_in, shortened};
use crate::plan_data::PlanData;
use crate::trace_data::{TraceData, quartiles};
use framegraph::{PassKind, Plan};
use framegraph_queues::{QueueLayout, Schedule, estimate_us, replan, schedule, share_memory};

/// Height of a lane.
const LANE: f32 = 40.0;
/// Width of the names of lanes.
const NAMES: f32 = 90.0;
/// Width of the longest frame.
const WIDTH: f32 = 1100.0;
/// Height of letters.
const SIZE: f32 = 12.0;
/// Bytes a microsecond where no times are at hand: 100 GB/s.
const BYTES_PER_US: f64 = 100_000.0;
/// Steps of a frame that is scheduled while one looks; `plan --queues` takes its time for more.
const MOST_STEPS: usize = 400;

/// Draws the frame on one queue more and on two more. Costs are the medians of the trace where each step has one.
pub fn drawing(data: &PlanData, trace: Option<&TraceData>) -> Drawing {
    let mut drawing = Drawing::default();
    let mut y = title(&mut drawing, "queues", data);
    let mut say = |words: &str| {
        drawing.text([0.0, y], SIZE, Ink::Faint, words);
        y += 20.0;
    };
    let Some(plan) = &data.plan else {
        say("a saved plan holds no graph, so it cannot be planned for several queues: open the graph (FRAME.ron)");
        return drawing;
    };
    if plan.steps().len() > MOST_STEPS {
        say(&format!("more than {MOST_STEPS} steps: `plan FRAME.ron --queues async-compute` schedules them"));
        return drawing;
    }
    let own = match replan(plan) {
        Ok(own) => own,
        Err(error) => {
            say(&error.to_string());
            return drawing;
        }
    };
    let measured = trace.and_then(|trace| medians_us(&own, trace));
    say(match measured {
        Some(_) => "steps take what the trace has as the median of each",
        None => "steps take what the bytes that they touch take at 100 GB/s; a trace has their times",
    });
    let costs_us = measured.unwrap_or_else(|| estimate_us(&own, BYTES_PER_US));
    for layout in [QueueLayout::async_compute(), QueueLayout::async_compute_and_copy()] {
        y = match schedule(&own, &layout, &costs_us) {
            Ok(found) => lanes(data, &own, &found, &mut drawing, y + 14.0),
            Err(error) => {
                drawing.text([0.0, y], SIZE, Ink::Worse, error.to_string());
                y + 20.0
            }
        };
    }
    drawing.text([0.0, y + 8.0], 11.0, Ink::Faint, "wgpu has one queue: no back end here runs more");
    drawing
}

/// The median time of each step on the GPU, or on the CPU where the GPU's are not known; none where a step has no time.
fn medians_us(plan: &Plan, trace: &TraceData) -> Option<Vec<f64>> {
    let of = |step| {
        let names = plan.passes_of(step).iter().map(|member| plan.graph().pass_name(member.pass).to_owned());
        let times = trace.step(&names.collect::<Vec<_>>())?;
        let [_, median_ms, _] = quartiles(&times.gpu_ms).or_else(|| quartiles(&times.cpu_ms))?;
        Some(median_ms * 1000.0)
    };
    plan.step_ids().map(of).collect()
}

/// One layout; the bottom of what was drawn.
fn lanes(data: &PlanData, plan: &Plan, found: &Schedule, drawing: &mut Drawing, y: f32) -> f32 {
    let Schedule { layout, lanes, waits, transfers, times_us, total_us, alone_us, .. } = found;
    let names: Vec<_> = layout.queues.iter().map(|queue| queue.name.as_str()).collect();
    let memory = share_memory(plan, found, plan.caps().texture_alignment_bytes.max(1));
    let head = format!(
        "{}: {total_us:.0} µs, {alone_us:.0} µs on one queue; {} semaphores, {} transfers; {} of memory",
        names.join(" + "),
        waits.len() + found.joins.len(),
        transfers.len(),
        bytes(memory.bytes())
    );
    drawing.text([0.0, y], 13.0, Ink::Text, head);
    // Both layouts have one scale.
    let scale = WIDTH / alone_us.max(1e-3) as f32;
    let (x, top) = (|us: f64| NAMES + us as f32 * scale, |lane: usize| y + 18.0 + LANE * lane as f32);
    for (lane, name) in names.iter().enumerate() {
        drawing.text([0.0, top(lane) + LANE / 2.0], SIZE, Ink::Text, *name);
        let below = top(lane) + LANE;
        drawing.line(vec![[NAMES, below], [NAMES + WIDTH, below]], Ink::Grid, 1.0);
    }
    for step in plan.step_ids() {
        let ([begin, end], lane) = (times_us[step.index()], lanes[step.index()].index());
        let bounds = [x(begin), top(lane) + 4.0, x(end).max(x(begin) + 1.0), top(lane) + LANE - 4.0];
        let ink = match plan.steps()[step.index()].kind {
            PassKind::Raster => Ink::Raster,
            PassKind::Compute => Ink::Compute,
            PassKind::Copy => Ink::Copy,
        };
        drawing.rect(bounds, ink, Ink::Faint);
        let first = plan.passes_of(step)[0].pass;
        let name = plan.graph().pass_name(first);
        // Steps of the plan that is shown are those of this one, as long as memory alone differs.
        let item = data.form.steps.get(step.index()).map(|shown| Item::Step(shown.index));
        if let Some(item) = item {
            drawing.mark(item);
        }
        let letters = letters_in(bounds[2] - bounds[0] - 4.0, 11.0);
        if letters >= 2 {
            let at = [bounds[0] + 2.0, top(lane) + LANE / 2.0];
            drawing.text(at, 11.0, Ink::Text, shortened(name, letters));
        }
        drawing.hit(bounds, item, format!("step {} {name}\n{begin:.1} to {end:.1} µs", step.index()));
    }
    for wait in waits {
        let place = |step: framegraph::StepId| (times_us[step.index()], top(lanes[step.index()].index()) + LANE / 2.0);
        let ((after, from), (before, to)) = (place(wait.after), place(wait.before));
        drawing.line(vec![[x(after[1]), from], [x(before[0]), to]], Ink::Peak, 1.5);
    }
    let end = x(*total_us);
    drawing.line(vec![[end, top(0)], [end, top(names.len())]], Ink::Peak, 1.0);
    let below = top(names.len()) + 10.0;
    drawing.aligned([end, below], 11.0, Align::Right, Ink::Peak, format!("{total_us:.0} µs"));
    below + 14.0
}
