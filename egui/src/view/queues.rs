//! Schedule on devices with several queues: one lane per queue, steps by duration, semaphores, and the time saved.

use super::format::{bytes, title};
use crate::drawing::{Align, Drawing, Ink, Item, letters_in, shortened};
use crate::plan_data::PlanData;
use crate::trace_data::{TraceData, quartiles};
use framegraph::{PassKind, Plan};
use framegraph_queues::{QueueLayout, Schedule, estimate_us, replan, schedule, share_memory};

/// Height of a lane.
const LANE: f32 = 40.0;
/// Width of the lane names.
const NAMES: f32 = 90.0;
/// Width of the longest frame.
const WIDTH: f32 = 1100.0;
/// Font size.
const SIZE: f32 = 12.0;
/// Memory bandwidth for estimated times: 100 GB/s, in bytes per microsecond.
const BYTES_PER_US: f64 = 100_000.0;
/// Maximum number of steps to schedule interactively; `plan --queues` has no limit.
const MAX_STEPS: usize = 400;

/// Draws the schedules with one and with two additional queues. Costs are the medians of the trace if every step has one.
pub fn drawing(data: &PlanData, trace: Option<&TraceData>) -> Drawing {
    let mut drawing = Drawing::default();
    let mut y = title(&mut drawing, "queues", data);
    let mut say = |words: &str| {
        drawing.text([0.0, y], SIZE, Ink::Faint, words);
        y += 20.0;
    };
    let Some(plan) = &data.plan else {
        say("A saved plan contains no graph: open the graph (FRAME.ron) to schedule it on several queues");
        return drawing;
    };
    if plan.steps().len() > MAX_STEPS {
        say(&format!("More than {MAX_STEPS} steps: schedule them with `plan FRAME.ron --queues async-compute`"));
        return drawing;
    }
    let own = match replan(plan) {
        Ok(own) => own,
        Err(error) => {
            say(&error.to_string());
            return drawing;
        }
    };
    let measured = trace.and_then(|trace| medians_us(data, &own, trace));
    say(match measured {
        Some(_) => "step times: medians of the trace",
        None => "step times: estimated from bytes at 100 GB/s; open a trace for measured times",
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
    drawing.text([0.0, y + 8.0], 11.0, Ink::Faint, "wgpu has a single queue; these schedules are not executed");
    drawing
}

/// Returns the median time of each step on the GPU, or else on the CPU; `None` if a step has no time.
fn medians_us(data: &PlanData, plan: &Plan, trace: &TraceData) -> Option<Vec<f64>> {
    // The steps of both plans correspond, since only memory differs.
    let traced = trace.steps_of(data);
    let of = |step: framegraph::StepId| {
        let times = (*traced.get(step.index())?)?;
        let [_, median_ms, _] = quartiles(&times.gpu_ms).or_else(|| quartiles(&times.cpu_ms))?;
        Some(median_ms * 1000.0)
    };
    plan.step_ids().map(of).collect()
}

/// Draws one layout and returns the bottom.
fn lanes(data: &PlanData, plan: &Plan, found: &Schedule, drawing: &mut Drawing, y: f32) -> f32 {
    let Schedule { layout, lanes, waits, transfers, times_us, total_us, alone_us, .. } = found;
    let names: Vec<_> = layout.queues.iter().map(|queue| queue.name.as_str()).collect();
    let memory = share_memory(plan, found, plan.caps().texture_alignment_bytes.max(1));
    let head = format!(
        "{}: {total_us:.0} µs, {alone_us:.0} µs on one queue; {} semaphores, {} transfers; {} memory",
        names.join(" + "),
        waits.len() + found.joins.len(),
        transfers.len(),
        bytes(memory.bytes())
    );
    drawing.text([0.0, y], 13.0, Ink::Text, head);
    // All layouts use one scale.
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
        // The steps of both plans correspond, since only memory differs.
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
