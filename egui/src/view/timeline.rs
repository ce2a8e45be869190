//! Timeline of resources over passes: lifetimes as bars, accesses, loads and stores.

use super::format::{bytes, title};
use super::heads;
use super::table::{Kind, Table};
use crate::drawing::{Align, Drawing, Ink, Item, letters_in, shortened, text_width};
use crate::plan_data::{PlanData, Resource};
use crate::trace_data::{TraceData, quartiles};
use std::ops::Range;

/// Height of a row.
pub const ROW: f32 = 22.0;
/// Width of a pass.
pub const COLUMN: f32 = 52.0;
/// Maximum width of the names.
const NAMES: f32 = 330.0;
/// Font size.
const SIZE: f32 = 12.0;
/// Minimum height of a row with text, and minimum width of a cell with letters and marks.
const MIN_TEXT: f32 = 11.0;
const MIN_CELL: f32 = 40.0;

/// Draws the matrix, with step times if a trace of the frame is open.
pub fn drawing(plan: &PlanData, trace: Option<&TraceData>) -> Drawing {
    let mut drawing = Drawing::default();
    let y = title(&mut drawing, "timeline", plan);
    let y = legend(&mut drawing, y);
    let table = Table::new(plan, Kind::Timeline);
    let columns = &table.columns;
    let names = names_width(plan);
    let mut y = y + heads::height(plan, columns);
    heads::draw(plan, columns, 0..columns.len(), &mut drawing, [names, y], COLUMN);
    if let Some(trace) = trace {
        if let Some(other) = trace.mismatch(plan) {
            drawing.text([0.0, y + 8.0], SIZE, Ink::Worse, other);
            y += ROW;
        }
        times(plan, &table, 0..columns.len(), trace, &mut drawing, [names, y], COLUMN);
        for (line, side) in SIDES.into_iter().enumerate() {
            let middle = y + ROW * (line as f32 + 0.5);
            drawing.aligned([names - 8.0, middle], SIZE, Align::Right, Ink::Text, format!("{side}, median"));
        }
        y += TIMES + 4.0;
    }
    let right = names + COLUMN * columns.len() as f32;
    let top = y;
    for index in 0..plan.form.resources.len() {
        drawing.line(vec![[0.0, y], [right, y]], Ink::Grid, 1.0);
        name(plan, table.kind, index, &mut drawing, [0.0, y, names, y + ROW]);
        row(plan, &table, index, 0..columns.len(), &mut drawing, [names, y], [COLUMN, ROW]);
        y += ROW;
    }
    drawing.line(vec![[0.0, y], [right, y]], Ink::Grid, 1.0);
    for index in (1..columns.len()).filter(|c| columns[*c].step != columns[c - 1].step) {
        let x = names + COLUMN * index as f32;
        drawing.line(vec![[x, top], [x, y]], Ink::Grid, 1.0);
    }
    drawing
}

/// Returns the width of the names of resources.
pub fn names_width(plan: &PlanData) -> f32 {
    let wide = |r: &Resource| text_width(&r.name, SIZE) + text_width(&place_of(r), 11.0) + 30.0;
    plan.form.resources.iter().map(wide).fold(150.0, f32::max).min(NAMES)
}

/// Legend as text.
pub const LEGEND: &str = "R read, W write, M modify; + merged into the step, » inlined\n\
    At the begin of a step: orange arrow load, filled box clear, empty box don't care\n\
    At its end: blue arrow store, double arrow multisample resolve, cross discard, dot none\n\
    Blue bar: shared memory; green: no memory; pink: outlives the frame\n\
    Narrow cells show reads in orange and writes in blue";

/// Draws the legend.
fn legend(drawing: &mut Drawing, y: f32) -> f32 {
    let mut x = 0.0;
    for (mark, words) in [("load", "load"), ("clear", "clear"), ("dont_care", "don't care")] {
        load_mark(drawing, mark, x, y);
        drawing.text([x + 14.0, y], 11.0, Ink::Faint, words);
        x += 30.0 + text_width(words, 11.0);
    }
    for (mark, words) in
        [("store", "store"), ("multisample", "multisample resolve"), ("discard", "discard"), ("none", "none")]
    {
        store_mark(drawing, mark, x + 8.0, y);
        drawing.text([x + 16.0, y], 11.0, Ink::Faint, words);
        x += 32.0 + text_width(words, 11.0);
    }
    let y = y + 20.0;
    x = 0.0;
    for (ink, words) in
        [(Ink::Shared, "shared memory"), (Ink::Memoryless, "no memory"), (Ink::Own, "outlives the frame")]
    {
        drawing.rect([x, y - 6.0, x + 14.0, y + 6.0], ink, Ink::Faint);
        drawing.text([x + 20.0, y], 11.0, Ink::Faint, words);
        x += 38.0 + text_width(words, 11.0);
    }
    drawing.text([x, y], 11.0, Ink::Faint, "R read, W write, M modify; + merged into the step, » inlined");
    y + 16.0
}

/// Devices whose times are shown.
pub const SIDES: [&str; 2] = ["CPU ms", "GPU ms"];
/// Height of the times.
pub const TIMES: f32 = 2.0 * ROW;

/// Draws medians and quartiles of step times on CPU and GPU for some columns of a width.
pub fn times(
    plan: &PlanData,
    table: &Table,
    range: Range<usize>,
    trace: &TraceData,
    drawing: &mut Drawing,
    [x, y]: [f32; 2],
    width: f32,
) {
    let columns = &table.columns;
    let traced = trace.steps_of(plan);
    for (line, side) in SIDES.into_iter().enumerate() {
        let middle = y + ROW * (line as f32 + 0.5);
        for index in range.clone() {
            let column = &columns[index];
            let first = index == 0 || columns[index - 1].step != column.step;
            let Some(step) = column.step.filter(|_| first).map(|s| &plan.form.steps[s]) else { continue };
            let Some(times) = traced[step.index] else { continue };
            let times = if line == 0 { &times.cpu_ms } else { &times.gpu_ms };
            let Some([low, median, high]) = quartiles(times) else { continue };
            let left = x + width * index as f32;
            let words = format!("{median:.2}");
            if text_width(&words, 11.0) < width {
                drawing.text([left + 2.0, middle], 11.0, Ink::Text, words);
            }
            let tip = format!(
                "step {}, {side} of {} frames: median {median:.3}, quartiles {low:.3} and {high:.3}",
                step.index,
                times.len()
            );
            drawing.hit([left, middle - ROW / 2.0, left + width, middle + ROW / 2.0], Item::Step(step.index), tip);
        }
    }
}

/// Returns the color of a placement.
pub(super) fn place_ink(resource: &Resource) -> Ink {
    match resource.placement.as_str() {
        "slot" | "heap" => Ink::Shared,
        "memoryless" | "inlined" => Ink::Memoryless,
        _ => Ink::Own,
    }
}

/// Returns the tooltip of a resource: name, shape, size and placement.
pub(super) fn tip(resource: &Resource) -> String {
    let mut tip = format!("{} ({})\n{}, {}\n", resource.name, resource.kind, resource.shape, bytes(resource.bytes));
    tip += &match (resource.placement.as_str(), resource.offset) {
        ("slot", _) => format!("slot {} of the pool", resource.slot.unwrap_or_default()),
        ("heap", Some(offset)) => format!("heap, offset {}", bytes(offset)),
        ("external", _) => "external memory".into(),
        (place, _) => place.into(),
    };
    tip
}

/// Returns the placement and size of a resource as a short label.
fn place_of(resource: &Resource) -> String {
    let history = matches!(resource.kind.as_str(), "history" | "previous");
    match resource.placement.as_str() {
        "memoryless" | "inlined" | "unused" => resource.placement.clone(),
        "external" => format!("import {}", bytes(resource.bytes)),
        _ if history => format!("history {}", bytes(resource.bytes)),
        _ => bytes(resource.bytes),
    }
}

/// Draws the name of a resource with its placement, or in the memory table with its offset and size.
pub fn name(plan: &PlanData, kind: Kind, index: usize, drawing: &mut Drawing, bounds: [f32; 4]) {
    let [left, top, right, bottom] = bounds;
    let resource = &plan.form.resources[index];
    let middle = (top + bottom) / 2.0;
    drawing.hit(bounds, Item::Resource(index), tip(resource));
    if bottom - top < MIN_TEXT {
        return;
    }
    let size = SIZE.min(0.72 * (bottom - top));
    let place = match (kind, resource.offset) {
        (Kind::Memory, Some(offset)) => format!("{} at {}", bytes(resource.bytes), bytes(offset)),
        _ => place_of(resource),
    };
    let note = size.min(11.0);
    let ink = if resource.first_step.is_none() { Ink::Ghost } else { Ink::Text };
    let letters = letters_in(right - left - 24.0 - text_width(&place, note), size);
    drawing.text([left, middle], size, ink, shortened(&resource.name, letters));
    drawing.aligned([right - 8.0, middle], note, Align::Right, Ink::Faint, place);
}

/// Draws lifetime and cells of a resource in some columns. `x` is the left end of the first column of the table.
pub fn row(
    plan: &PlanData,
    table: &Table,
    index: usize,
    range: Range<usize>,
    drawing: &mut Drawing,
    [x, y]: [f32; 2],
    [width, height]: [f32; 2],
) {
    let resource = &plan.form.resources[index];
    let (middle, pad) = (y + height / 2.0, 0.14 * height);
    let x_of = |column: usize| x + width * column as f32;
    if let Some([first, last]) = table.spans[index].filter(|[first, last]| *first < range.end && *last >= range.start) {
        let inset = 2.0f32.min(0.1 * width);
        let bounds = [x_of(first) + inset, y + pad, x_of(last + 1) - inset, y + height - pad];
        drawing.rect(bounds, place_ink(resource), None);
        drawing.hit([x_of(first), y, x_of(last + 1), y + height], Item::Resource(index), tip(resource));
    }
    let is_wide = width >= MIN_CELL && height >= MIN_TEXT;
    for (column, cell) in table.cells[index].range(range) {
        let [left, right] = [x_of(*column), x_of(column + 1)];
        let runs = table.step(*column).is_some();
        let [read, modify, write] = cell.accesses;
        let letters: String =
            [(read, 'R'), (modify, 'M'), (write, 'W')].iter().filter(|(is, _)| *is).map(|(_, c)| *c).collect();
        let ink = if runs { Ink::Text } else { Ink::Ghost };
        if is_wide {
            let size = SIZE.min(0.72 * height);
            drawing.aligned([(left + right) / 2.0, middle], size, Align::Center, ink, letters);
            if let Some(load) = cell.load {
                load_mark(drawing, load, left + 4.0, middle);
            }
            if let Some(store) = cell.store {
                store_mark(drawing, store, right - 8.0, middle);
            }
        } else if !letters.is_empty() {
            let half = 0.3 * width.min(height);
            let center = (left + right) / 2.0;
            let ink = match (runs, modify || write) {
                (false, _) => Ink::Ghost,
                (_, true) => Ink::Store,
                _ => Ink::Load,
            };
            drawing.rect([center - half, middle - half, center + half, middle + half], ink, None);
        }
        let item = if runs { Item::Resource(index) } else { Item::Pass(table.columns[*column].pass) };
        drawing.hit([left, y, right, y + height], item, cell_tip(plan, table, index, *column));
    }
}

/// Returns the tooltip of a cell: accesses, and loads and stores with their reasons.
fn cell_tip(plan: &PlanData, table: &Table, index: usize, column: usize) -> String {
    let name = &plan.form.resources[index].name;
    let column = &table.columns[column];
    let pass = &plan.form.passes[column.pass];
    let uses = pass.accesses.iter().filter(|a| a.resource == *name).map(|a| {
        let part = a.part.as_ref().map(|part| format!(", {part}")).unwrap_or_default();
        format!("{} {}{part}", a.mode, a.kind)
    });
    let Some(step) = column.step.map(|step| &plan.form.steps[step]) else {
        return format!("{} (culled) would {} {name}", pass.name, uses.collect::<Vec<_>>().join(", "));
    };
    let ops = plan
        .attached(step, name)
        .map(|a| format!("{}: {}, {}\n  {}\n  {}", a.role, a.load, a.store, a.load_reason, a.store_reason));
    let lines: Vec<_> = uses.chain(ops).collect();
    format!("{name} in {}\n{}", pass.name, lines.join("\n"))
}

/// Draws the load operation: an arrow, a filled box, or an empty box.
fn load_mark(drawing: &mut Drawing, load: &str, x: f32, y: f32) {
    match load {
        "load" => drawing.triangle([[x, y - 5.0], [x + 8.0, y], [x, y + 5.0]], Ink::Load),
        "clear" => drawing.rect([x, y - 3.5, x + 7.0, y + 3.5], Ink::Clear, None),
        _ => drawing.rect([x, y - 3.5, x + 7.0, y + 3.5], None, Ink::Faint),
    }
}

/// Draws the store operation: an arrow, two arrows for a multisample resolve, a cross, or a dot.
fn store_mark(drawing: &mut Drawing, store: &str, x: f32, y: f32) {
    let arrow = |x: f32| [[x - 4.0, y - 5.0], [x + 4.0, y], [x - 4.0, y + 5.0]];
    match store {
        "store" => drawing.triangle(arrow(x), Ink::Store),
        "multisample" => {
            drawing.triangle(arrow(x - 4.0), Ink::Resolve);
            drawing.triangle(arrow(x + 1.0), Ink::Resolve);
        }
        "discard" => {
            drawing.line(vec![[x - 4.0, y - 4.0], [x + 4.0, y + 4.0]], Ink::Text, 1.5);
            drawing.line(vec![[x - 4.0, y + 4.0], [x + 4.0, y - 4.0]], Ink::Text, 1.5);
        }
        _ => drawing.rect([x - 1.5, y - 1.5, x + 1.5, y + 1.5], Ink::Faint, None),
    }
}
