//! Column headers of passes in execution order under brackets of steps, for the timeline and the memory map.

use super::format::bytes;
use crate::drawing::{Drawing, Ink, Item, shortened, text_width};
use crate::plan_data::{Pass, PlanData, Step};
use std::ops::Range;

/// Maximum number of characters of a name.
const LETTERS: usize = 28;
/// Font size.
const SIZE: f32 = 12.0;
/// Slope of the names in degrees.
const TURNED: f32 = 55.0;

/// Column of a pass.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Pass by index; a full-screen resolve uses the pass that declares it.
    pub pass: usize,
    /// Step; `None` for a culled pass.
    pub step: Option<usize>,
    /// True if the step is a full-screen resolve of an earlier step.
    pub resolve: bool,
}

/// Returns the passes by step, then the culled passes.
pub(super) fn columns(plan: &PlanData) -> Vec<Column> {
    let mut columns = Vec::new();
    for step in &plan.form.steps {
        let passes = step.passes.iter().filter_map(|name| plan.pass(name));
        let resolve = step.full_screen_resolve;
        columns.extend(passes.map(|pass| Column { pass, step: Some(step.index), resolve }));
    }
    let culled = plan.form.passes.iter().enumerate().filter(|(_, pass)| pass.culled);
    columns.extend(culled.map(|(pass, _)| Column { pass, step: None, resolve: false }));
    columns
}

/// Returns the sign of how a pass joined its step.
fn sign(pass: &Pass, column: &Column) -> &'static str {
    match pass.join.as_deref() {
        _ if column.resolve => "resolve ",
        Some("attachments" | "same_pixel") => "+ ",
        Some("inlined") => "» ",
        _ => "",
    }
}

/// Returns one column per step, named after its first pass.
pub(super) fn steps(plan: &PlanData) -> Vec<Column> {
    let first = |step: &Step| step.passes.first().and_then(|name| plan.pass(name));
    let column = |step: &Step| Some(Column { pass: first(step)?, step: Some(step.index), resolve: false });
    plan.form.steps.iter().filter_map(column).collect()
}

/// Height of the brackets of steps.
const BRACKET: f32 = 24.0;

fn label(plan: &PlanData, column: &Column) -> String {
    let pass = &plan.form.passes[column.pass];
    format!("{}{}", sign(pass, column), shortened(&pass.name, LETTERS))
}

/// Returns the height of the names and step brackets of columns.
pub(super) fn height(plan: &PlanData, columns: &[Column]) -> f32 {
    let longest = columns.iter().map(|c| text_width(&label(plan, c), SIZE)).fold(0.0, f32::max);
    longest * TURNED.to_radians().sin() + 8.0 + BRACKET
}

/// Draws the names and step brackets of some columns of a width, with the first column at `x`, ending at `bottom`.
pub(super) fn draw(
    plan: &PlanData,
    columns: &[Column],
    range: Range<usize>,
    drawing: &mut Drawing,
    [x, bottom]: [f32; 2],
    width: f32,
) {
    let base = bottom - BRACKET;
    // Names of narrow columns would lie over each other.
    let stride = (SIZE * 1.2 / width).ceil().max(1.0) as usize;
    for index in range.clone() {
        let column = &columns[index];
        let pass = &plan.form.passes[column.pass];
        let left = x + width * index as f32;
        let ink = if column.step.is_some() { Ink::Text } else { Ink::Ghost };
        if index % stride == 0 {
            drawing.slanted([left + width / 2.0, base - 6.0], SIZE, ink, TURNED, label(plan, column));
        }
        drawing.hit([left, base - 24.0, left + width, base], Item::Pass(column.pass), tip(pass));
    }
    let mut first = range.start;
    while first > 0 && first < columns.len() && columns[first - 1].step == columns[first].step {
        first -= 1;
    }
    while first < range.end {
        let step = columns[first].step;
        let count = columns[first..].iter().take_while(|c| c.step == step).count();
        let bounds = [x + width * first as f32 + 1.0, base, x + width * (first + count) as f32 - 1.0, bottom - 4.0];
        let middle = [(bounds[0] + bounds[2]) / 2.0, (bounds[1] + bounds[3]) / 2.0];
        let center = crate::drawing::Align::Center;
        let fits = |word: &str| text_width(word, 11.0) < bounds[2] - bounds[0];
        match step.map(|step| &plan.form.steps[step]) {
            Some(row) => {
                // Passes under one bracket share a step.
                drawing.rect(bounds, Ink::Step, if count > 1 { Ink::Text } else { Ink::Faint });
                let number = row.index.to_string();
                if fits(&number) {
                    drawing.aligned(middle, 11.0, center, Ink::Text, number);
                }
                drawing.hit(bounds, Item::Step(row.index), step_tip(row));
            }
            None => {
                drawing.ghost(bounds, Ink::Ghost);
                drawing.aligned(middle, 11.0, center, Ink::Ghost, if fits("culled") { "culled" } else { "-" });
                drawing.hit(bounds, None, "culled passes: do not run");
            }
        }
        first += count;
    }
}

/// Returns the tooltip of a pass.
pub(super) fn tip(pass: &Pass) -> String {
    format!("{} ({})\n{}", pass.name, pass.kind, pass.reason)
}

/// Returns the tooltip of a step.
pub(super) fn step_tip(step: &Step) -> String {
    let [w, h] = step.extent;
    format!(
        "step {}: {}\n{}, {w}x{h}, {} samples\nloads: {}, {}\nstores: {}, {}",
        step.index,
        step.passes.join(" + "),
        step.kind,
        step.samples,
        step.unresolves,
        bytes(step.unresolve_bytes),
        step.resolves,
        bytes(step.resolve_bytes)
    )
}
