//! Schedules as text and as SVG.

use crate::schedule::Schedule;
use framegraph::sanitize::escape_controls;
use framegraph::{Plan, StepId};
use std::borrow::Cow;
use std::fmt::Write;

fn name(plan: &Plan, step: StepId) -> Cow<'_, str> {
    escape_controls(plan.passes_of(step).first().map_or("", |member| plan.graph().pass_name(member.pass)))
}

/// Returns the schedule as text: totals, the steps of each queue with their times and waits, transfers and concurrent
/// resources.
#[must_use]
pub fn text(plan: &Plan, schedule: &Schedule) -> String {
    let Schedule { layout, lanes, waits, joins, transfers, concurrent, times_us, total_us, alone_us, .. } = schedule;
    let mut out = format!(
        "queues: {layout}\nframe: {total_us:.1} µs, {alone_us:.1} µs on one queue; {} semaphores, {} joins, {} transfers\n",
        waits.len(),
        joins.len(),
        transfers.len()
    );
    for (queue, id) in layout.queues.iter().zip(layout.ids()) {
        let _ = writeln!(out, "\n{}:", escape_controls(&queue.name));
        for step in plan.step_ids().filter(|step| lanes[step.index()] == id) {
            let [begin, end] = times_us[step.index()];
            let _ = write!(out, "  {begin:9.1} … {end:9.1}  step {} {}", step.index(), name(plan, step));
            for wait in waits.iter().filter(|wait| wait.before == step) {
                let _ = write!(out, ", waits for step {} {}", wait.after.index(), name(plan, wait.after));
            }
            out.push('\n');
        }
    }
    if !transfers.is_empty() {
        out.push_str("\ntransfers:\n");
    }
    for transfer in transfers {
        let place = |(queue, step): (crate::QueueId, Option<StepId>), edge: &str| {
            let queue = escape_controls(&layout.queues[queue.index()].name);
            match step {
                Some(step) => format!("{queue} ({edge} step {})", step.index()),
                None => format!("{queue} ({edge} the frame)"),
            }
        };
        let resource = escape_controls(plan.graph().resource_name(transfer.resource));
        let _ = writeln!(out, "  {resource}: {} to {}", place(transfer.from, "after"), place(transfer.to, "before"));
    }
    if !concurrent.is_empty() {
        let names: Vec<_> =
            concurrent.iter().map(|resource| escape_controls(plan.graph().resource_name(*resource))).collect();
        let _ = writeln!(out, "\nconcurrent: {}", names.join(", "));
    }
    out
}

/// Returns the schedule as SVG: a lane per queue, a box per step with its duration, and a line per semaphore.
#[must_use]
pub fn svg(plan: &Plan, schedule: &Schedule) -> String {
    const LANE: f64 = 44.0;
    const LEFT: f64 = 90.0;
    const WIDTH: f64 = 1000.0;
    let Schedule { layout, lanes, waits, times_us, total_us, .. } = schedule;
    let scale = WIDTH / total_us.max(1e-9);
    let x = |us: f64| LEFT + us * scale;
    let top = |lane: usize| 20.0 + LANE * lane as f64;
    let height = top(layout.queues.len()) + 20.0;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0}\" height=\"{height:.0}\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        LEFT + WIDTH + 20.0
    );
    for (lane, queue) in layout.queues.iter().enumerate() {
        let y = top(lane) + 20.0;
        let _ = writeln!(out, "<text x=\"8\" y=\"{y:.0}\">{}</text>", escaped(&escape_controls(&queue.name)));
    }
    for step in plan.step_ids() {
        let ([begin, end], lane) = (times_us[step.index()], lanes[step.index()].index());
        let (left, width) = (x(begin), ((end - begin) * scale).max(1.0));
        let color = ["#7aa6d8", "#e0a15a", "#8bc48a"][lane % 3];
        let shown = escaped(&name(plan, step));
        let _ = write!(
            out,
            "<rect x=\"{left:.1}\" y=\"{:.0}\" width=\"{width:.1}\" height=\"30\" fill=\"{color}\" stroke=\"#333333\">\
             <title>{shown}: {begin:.1} … {end:.1} µs</title></rect>",
            top(lane)
        );
        // Only the characters that fit.
        let fits = (width / 6.5) as usize;
        if fits >= 2 {
            let short: String = name(plan, step).chars().take(fits).collect();
            let _ =
                write!(out, "<text x=\"{:.1}\" y=\"{:.0}\">{}</text>", left + 3.0, top(lane) + 19.0, escaped(&short));
        }
        out.push('\n');
    }
    for wait in waits {
        let [after, before] =
            [wait.after, wait.before].map(|step| (times_us[step.index()], lanes[step.index()].index()));
        let _ = writeln!(
            out,
            "<line x1=\"{:.1}\" y1=\"{:.0}\" x2=\"{:.1}\" y2=\"{:.0}\" stroke=\"#b03030\"/>",
            x(after.0[1]),
            top(after.1) + 15.0,
            x(before.0[0]),
            top(before.1) + 15.0
        );
    }
    let _ = writeln!(out, "<text x=\"{LEFT}\" y=\"{:.0}\">{total_us:.1} µs</text>\n</svg>", height - 8.0);
    out
}

fn escaped(text: &str) -> String {
    let mut out = String::new();
    for letter in text.chars() {
        match letter {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            letter => out.push(letter),
        }
    }
    out
}
