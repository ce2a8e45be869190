//! Column headers of passes in execution order under brackets of steps, for the timeline and the memory map.

use super::format::bytes;
use crate::drawing::{Drawing, Ink, Item, shortened, text_width};
use crate::plan_data::{Pass, PlanData, Step};

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

/// Draws the names and step brackets of columns of a width from `x`; returns the bottom.
pub(super) fn draw(plan: &PlanData, columns: &[Column], drawing: &mut Drawing, [x, y]: [f32; 2], width: f32) -> f32 {
    let label = |column: &Column| {
        let pass = &plan.form.passes[column.pass];
        format!("{}{}", sign(pass, column), shortened(&pass.name, LETTERS))
    };
    let longest = columns.iter().map(|c| text_width(&label(c), SIZE)).fold(0.0, f32::max);
    let base = y + longest * TURNED.to_radians().sin() + 8.0;
    let bracket = base + 24.0;
    for (index, column) in columns.iter().enumerate() {
        let pass = &plan.form.passes[column.pass];
        let left = x + width * index as f32;
        let ink = if column.step.is_some() { Ink::Text } else { Ink::Ghost };
        drawing.slanted([left + width / 2.0, base - 6.0], SIZE, ink, TURNED, label(column));
        drawing.hit([left, base - 24.0, left + width, base], Item::Pass(column.pass), tip(pass));
    }
    let mut first = 0;
    while first < columns.len() {
        let step = columns[first].step;
        let count = columns[first..].iter().take_while(|c| c.step == step).count();
        let bounds = [x + width * first as f32 + 1.0, base, x + width * (first + count) as f32 - 1.0, bracket - 4.0];
        let middle = [(bounds[0] + bounds[2]) / 2.0, (bounds[1] + bounds[3]) / 2.0];
        let center = crate::drawing::Align::Center;
        match step.map(|step| &plan.form.steps[step]) {
            Some(row) => {
                // Passes under one bracket share a step.
                drawing.rect(bounds, Ink::Step, if count > 1 { Ink::Text } else { Ink::Faint });
                drawing.aligned(middle, 11.0, center, Ink::Text, row.index.to_string());
                drawing.hit(bounds, Item::Step(row.index), step_tip(row));
            }
            None => {
                drawing.ghost(bounds, Ink::Ghost);
                let word = if text_width("culled", 11.0) < bounds[2] - bounds[0] { "culled" } else { "-" };
                drawing.aligned(middle, 11.0, center, Ink::Ghost, word);
                drawing.hit(bounds, None, "culled passes: do not run");
            }
        }
        first += count;
    }
    bracket
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
