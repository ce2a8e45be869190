//! Error over cost, one plot per technique, with a line through the Pareto-optimal choices.

use crate::accuracy_data::{AccuracyData, Technique, Unit};
use crate::drawing::{Align, Drawing, Ink, letters_in, shortened, wrapped};

/// Size of a plot without its text.
const PLOT: [f32; 2] = [230.0, 130.0];
/// Distance between plots.
const STEP: [f32; 2] = [320.0, 264.0];
/// Number of plots per row.
const COLUMNS: usize = 3;
/// Top of the first plot without a chosen frame, and the height of each line of a chosen frame.
const TOP: f32 = 44.0;
const LINE: f32 = 15.0;
/// Half the side of a mark.
const MARK: f32 = 4.0;

/// Draws the techniques below the most accurate frame within `budget_ms`.
pub fn drawing(data: Option<&AccuracyData>, budget_ms: f64) -> Drawing {
    let mut drawing = Drawing::default();
    let Some(data) = data else {
        let text = "No accuracy record: open one written by `accuracy`, such as docs/measurements/accuracy.json";
        drawing.text([0.0, 10.0], 12.0, Ink::Faint, text);
        return drawing;
    };
    let [width, height] = data.size_px;
    let head = format!(
        "{} techniques, error over cost; frames of {width}x{height} on {}",
        data.techniques.len(),
        data.adapter
    );
    drawing.text([0.0, 10.0], 14.0, Ink::Text, head);
    drawing.text([0.0, 28.0], 11.0, Ink::Faint, "line: choices with the best trade-off between error and cost");
    let top = frame(&mut drawing, data, budget_ms);
    for (index, technique) in data.techniques.iter().enumerate() {
        let at = [STEP[0] * (index % COLUMNS) as f32, top + STEP[1] * (index / COLUMNS) as f32];
        plot(&mut drawing, technique, at);
    }
    drawing
}

/// Draws the frame chosen within a time budget, one option per line; returns the bottom.
fn frame(drawing: &mut Drawing, data: &AccuracyData, budget_ms: f64) -> f32 {
    let Some(chosen) = data.within(budget_ms) else {
        let text = "No frame can be chosen within a time budget: measure one with `accuracy --technique budget`";
        drawing.text([0.0, TOP + 2.0], 11.0, Ink::Faint, text);
        return TOP + 1.5 * LINE;
    };
    let head = format!(
        "most accurate frame within {budget_ms:.1} ms: {:.1} ms, error {:.2} 8-bit steps:",
        chosen.ms, chosen.error
    );
    drawing.text([0.0, TOP + 2.0], 12.0, Ink::Text, head);
    let rows = chosen.options.len().div_ceil(COLUMNS);
    for (index, [group, option]) in chosen.options.iter().enumerate() {
        let at = [STEP[0] * (index / rows) as f32, TOP + 2.0 + LINE * (index % rows + 1) as f32];
        let text = shortened(&format!("{group}: {option}"), letters_in(STEP[0] - 10.0, 11.0));
        drawing.text(at, 11.0, Ink::Text, text);
    }
    TOP + LINE * (rows as f32 + 1.5)
}

/// Draws the plot of a technique at its top left.
fn plot(drawing: &mut Drawing, technique: &Technique, [left, top]: [f32; 2]) {
    drawing.text([left, top + 8.0], 13.0, Ink::Text, technique.name.clone());
    for (line, text) in wrapped(&technique.what, letters_in(STEP[0] - 20.0, 10.0)).into_iter().take(3).enumerate() {
        drawing.text([left, top + 24.0 + 12.0 * line as f32], 10.0, Ink::Faint, text);
    }
    let (x0, y0) = (left + 20.0, top + 76.0);
    let (x1, y1) = (x0 + PLOT[0], y0 + PLOT[1]);
    drawing.rect([x0, y0, x1, y1], None, Ink::Grid);
    let (unit, cost_of) = (technique.unit_of_cost(), |choice| technique.cost(choice));
    let costs: Vec<f64> = technique.choices.iter().map(cost_of).collect();
    let max_error = technique.choices.iter().map(|choice| choice.error).fold(0.0, f64::max);
    let (low, high) = (costs.iter().copied().fold(f64::INFINITY, f64::min), costs.iter().copied().fold(0.0, f64::max));
    // A margin of a tenth on both sides keeps marks off the edge.
    let span = if high > low { high - low } else { 1.0 };
    let x_of = |cost: f64| x0 + PLOT[0] * (0.1 + 0.8 * (cost - low) / span) as f32;
    let y_of = |error: f64| y1 - PLOT[1] * (0.08 + 0.84 * error / max_error.max(f64::MIN_POSITIVE)) as f32;
    let front = technique.front();
    let mut joined: Vec<[f32; 2]> = technique
        .choices
        .iter()
        .zip(&front)
        .filter(|(_, kept)| **kept)
        .map(|(choice, _)| [x_of(technique.cost(choice)), y_of(choice.error)])
        .collect();
    joined.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if joined.len() > 1 {
        drawing.line(joined, Ink::Flow, 1.5);
    }
    for (index, choice) in technique.choices.iter().enumerate() {
        let (x, y) = (x_of(technique.cost(choice)), y_of(choice.error));
        if let Some(ms) = choice.ms.filter(|_| unit == Unit::Ms) {
            let ends = [ms.low, ms.high].map(|ms| x_of(ms).clamp(x0, x1));
            drawing.line(vec![[ends[0], y], [ends[1], y]], Ink::Faint, 1.0);
        }
        if front[index] {
            drawing.rect([x - MARK, y - MARK, x + MARK, y + MARK], Ink::Store, Ink::Text);
        } else {
            drawing.triangle([[x - MARK, y + MARK], [x + MARK, y + MARK], [x, y - MARK]], Ink::Ghost);
        }
        let right = x > x0 + 0.6 * PLOT[0];
        let (align, beside) = if right { (Align::Right, x - 10.0) } else { (Align::Left, x + 10.0) };
        let letters = letters_in(if right { beside - x0 } else { x1 - beside }, 9.0);
        // Alternate labels above and below adjacent marks.
        let above = [-8.0, 8.0, -18.0, 18.0][index % 4];
        let beside_y = (y + above).clamp(y0 + 6.0, y1 - 6.0);
        drawing.aligned([beside, beside_y], 9.0, align, Ink::Text, shortened(&choice.name, letters));
        let cost = match unit {
            Unit::Ms => format!("{:.2} ms", technique.cost(choice)),
            Unit::Operations => format!("{:.0} operations", technique.cost(choice)),
            Unit::Unknown => "unknown cost".into(),
        };
        let presets =
            if choice.presets.is_empty() { String::new() } else { format!("; {}", choice.presets.join(", ")) };
        let tip = format!("{}: {:.4} {}, {cost}{presets}", choice.name, choice.error, technique.unit);
        drawing.hit([x - 8.0, y - 8.0, x + 8.0, y + 8.0], None, tip);
    }
    drawing.text([x0, y0 - 7.0], 9.0, Ink::Faint, format!("{max_error:.3} {}", technique.unit));
    let (name, from, to) = match unit {
        Unit::Ms => ("ms", format!("{low:.1}"), format!("{high:.1} ms")),
        Unit::Operations => ("operations", format!("{low:.0}"), format!("{high:.0} operations")),
        Unit::Unknown => ("unknown cost", String::new(), String::new()),
    };
    drawing.aligned(
        [x_of(low), y1 + 9.0],
        9.0,
        Align::Center,
        Ink::Faint,
        if from.is_empty() { name.into() } else { from },
    );
    if high > low {
        drawing.aligned([x_of(high), y1 + 9.0], 9.0, Align::Center, Ink::Faint, to);
    }
}
