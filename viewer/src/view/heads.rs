//! Columns of passes in the order in which they run, under brackets of steps: what timeline and memory map share.

use super::words::bytes;
use crate::drawing::{Drawing, Ink, Item, shortened, text_width};
use crate::plan_data::{Pass, PlanData, Step};

/// Letters of a name in a head.
const LETTERS: usize = 28;
/// Height of the letters.
const SIZE: f32 = 12.0;
/// Heads climb by so many degrees.
const TURNED: f32 = 55.0;

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// The pass, by its index; a full-screen resolve stands by the pass that declares it.
    pub pass: usize,
    /// Its step; none of what was culled.
    pub step: Option<usize>,
    /// The step resolves what its pass, of an earlier step, declares.
    pub resolve: bool,
}

/// The passes by step, then those that were culled.
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

/// How a pass came into its step, as a sign.
fn sign(pass: &Pass, column: &Column) -> &'static str {
    match pass.join.as_deref() {
        _ if column.resolve => "resolve ",
        Some("attachments" | "same_pixel") => "+ ",
        Some("inlined") => "» ",
        _ => "",
    }
}

/// Draws names over columns that begin at `x` and are `width` wide, and brackets around those of one step; returns where
/// they end.
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
                // A bracket over several passes: they share one step.
                drawing.rect(bounds, Ink::Step, if count > 1 { Ink::Text } else { Ink::Faint });
                drawing.aligned(middle, 11.0, center, Ink::Text, row.index.to_string());
                drawing.hit(bounds, Item::Step(row.index), step_tip(row));
            }
            None => {
                drawing.ghost(bounds, Ink::Ghost);
                let word = if text_width("culled", 11.0) < bounds[2] - bounds[0] { "culled" } else { "-" };
                drawing.aligned(middle, 11.0, center, Ink::Ghost, word);
                drawing.hit(bounds, None, "culled passes: they do not run");
            }
        }
        first += count;
    }
    bracket
}

/// What a pass is, in a few lines.
pub(super) fn tip(pass: &Pass) -> String {
    format!("{} ({})\n{}", pass.name, pass.kind, pass.reason)
}

/// What a step is, in a few lines.
pub(super) fn step_tip(step: &Step) -> String {
    let [w, h] = step.extent;
    format!(
        "step {}: {}\n{}, {w}x{h}, {} samples\nunresolves {}, loads {}\nresolves {}, stores {}",
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
