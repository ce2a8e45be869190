//! Frame times: one bar per frame with stutters marked, and the quartiles of each step.

use crate::drawing::{Align, Drawing, Ink, letters_in, shortened};
use crate::plan_data::PlanData;
use crate::trace_data::{STUTTER, TraceData, TracedStep, quartiles};

/// Height of the bars.
const HEIGHT: f32 = 160.0;
/// Width of all bars.
const WIDTH: f32 = 900.0;
/// Font size.
const SIZE: f32 = 12.0;
/// Height of a row.
const ROW: f32 = 20.0;
/// Width of the names.
const NAMES: f32 = 380.0;
/// Maximum number of drawn frames, the latest ones.
const MAX_FRAMES: usize = 900;

/// Draws frames and steps, with a warning if the trace does not belong to the plan.
pub fn drawing(trace: Option<&TraceData>, plan: &PlanData) -> Drawing {
    let mut drawing = Drawing::default();
    let Some(trace) = trace else {
        drawing.text([0.0, 10.0], SIZE, Ink::Faint, "No trace: open one written by `render SCENE --trace FILE.json`");
        return drawing;
    };
    let frames = &trace.frames[trace.frames.len().saturating_sub(MAX_FRAMES)..];
    let max_ms = frames.iter().filter(|f| !f.warm_up).map(|f| f.time_ms()).fold(0.0, f64::max).max(1e-3);
    let stutters = trace.stutters();
    let head = format!(
        "{} frames, {} stutters (at least {STUTTER} times the median of {:.3} ms)",
        trace.frames.len(),
        stutters.len(),
        trace.median_ms().unwrap_or(0.0)
    );
    drawing.text([0.0, 10.0], 14.0, Ink::Text, head);
    let base = 34.0 + HEIGHT;
    let width = WIDTH / frames.len().max(1) as f32;
    for (index, frame) in frames.iter().enumerate() {
        let x = width * index as f32;
        let height = (f64::from(HEIGHT) * (frame.time_ms() / max_ms).min(1.0)) as f32;
        let stutter = stutters.iter().any(|s| s.number == frame.number);
        let ink = match (frame.warm_up, stutter) {
            (true, _) => Ink::Grid,
            (_, true) => Ink::Peak,
            _ => Ink::Store,
        };
        drawing.rect([x, base - height, x + (width - 0.5).max(0.5), base], ink, None);
        if stutter {
            // A marker in addition to the color, for color-blind users.
            drawing.triangle([[x, 28.0], [x + 8.0, 28.0], [x + 4.0, 34.0]], Ink::Peak);
        }
        let warm = if frame.warm_up { ", warm-up" } else { "" };
        let gpu = frame.gpu_ms.map(|ms| format!(", GPU {ms:.3} ms")).unwrap_or_default();
        let tip = format!("frame {}: CPU {:.3} ms{gpu}{warm}", frame.number, frame.cpu_ms);
        drawing.hit([x, 28.0, x + width, base], None, tip);
    }
    drawing.line(vec![[0.0, base], [WIDTH, base]], Ink::Text, 1.0);
    drawing.text([WIDTH + 8.0, base - HEIGHT], 11.0, Ink::Faint, format!("{max_ms:.3} ms"));
    drawing.text([WIDTH + 8.0, base], 11.0, Ink::Faint, "0 ms");
    let mut y = base + 30.0;
    if let Some(other) = trace.mismatch(plan).filter(|_| !plan.form.steps.is_empty()) {
        drawing.text([0.0, y], SIZE, Ink::Worse, other);
        y += ROW;
    }
    let columns = ["CPU 1/4", "median", "3/4 ms", "GPU 1/4", "median", "3/4 ms"];
    let right = |column: usize| NAMES + 90.0 * (column + 1) as f32;
    for (column, name) in columns.into_iter().enumerate() {
        drawing.aligned([right(column), y], SIZE, Align::Right, Ink::Faint, name);
    }
    let name = |step: &TracedStep| match step.earlier {
        0 => step.name.clone(),
        earlier => format!("{} #{}", step.name, earlier + 1),
    };
    for step in &trace.steps {
        y += ROW;
        drawing.text([0.0, y], SIZE, Ink::Text, shortened(&name(step), letters_in(NAMES, SIZE)));
        for (side, times) in [&step.cpu_ms, &step.gpu_ms].into_iter().enumerate() {
            for (at, ms) in quartiles(times).into_iter().flatten().enumerate() {
                drawing.aligned([right(side * 3 + at), y], SIZE, Align::Right, Ink::Text, format!("{ms:.3}"));
            }
        }
    }
    drawing
}
