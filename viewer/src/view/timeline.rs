//! Timeline of resources over passes: lifetimes as bars, accesses, loads and stores.

use super::format::{bytes, title};
use super::heads::{self, Column};
use crate::drawing::{Align, Drawing, Ink, Item, letters_in, shortened, text_width};
use crate::plan_data::{Attachment, PlanData, Resource};
use crate::trace_data::{TraceData, quartiles};

/// Height of a row.
const ROW: f32 = 22.0;
/// Width of a pass.
const COLUMN: f32 = 52.0;
/// Maximum width of the names.
const NAMES: f32 = 330.0;
/// Font size.
const SIZE: f32 = 12.0;

/// Draws the matrix, with step times if a trace of the frame is open.
pub fn drawing(plan: &PlanData, trace: Option<&TraceData>) -> Drawing {
    let mut drawing = Drawing::default();
    let y = title(&mut drawing, "timeline", plan);
    let y = legend(&mut drawing, y);
    let columns = heads::columns(plan);
    let wide = |r: &Resource| text_width(&r.name, SIZE) + text_width(&place_of(r), 11.0) + 30.0;
    let names = plan.form.resources.iter().map(wide).fold(150.0, f32::max).min(NAMES);
    let mut y = heads::draw(plan, &columns, &mut drawing, [names, y], COLUMN);
    if let Some(trace) = trace {
        y = times(plan, &columns, trace, &mut drawing, [names, y]);
    }
    let right = names + COLUMN * columns.len() as f32;
    let top = y;
    for index in 0..plan.form.resources.len() {
        drawing.line(vec![[0.0, y], [right, y]], Ink::Grid, 1.0);
        row(plan, &columns, index, &mut drawing, [names, y]);
        y += ROW;
    }
    drawing.line(vec![[0.0, y], [right, y]], Ink::Grid, 1.0);
    for index in (1..columns.len()).filter(|c| columns[*c].step != columns[c - 1].step) {
        let x = names + COLUMN * index as f32;
        drawing.line(vec![[x, top], [x, y]], Ink::Grid, 1.0);
    }
    drawing
}

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

/// Draws medians and quartiles of step times on CPU and GPU.
fn times(plan: &PlanData, columns: &[Column], trace: &TraceData, drawing: &mut Drawing, [names, y]: [f32; 2]) -> f32 {
    let mut y = y;
    if let Some(other) = trace.mismatch(plan) {
        drawing.text([0.0, y + 8.0], SIZE, Ink::Worse, other);
        y += ROW;
    }
    let traced = trace.steps_of(plan);
    for (line, side) in ["CPU ms", "GPU ms"].into_iter().enumerate() {
        let middle = y + ROW * (line as f32 + 0.5);
        drawing.aligned([names - 8.0, middle], SIZE, Align::Right, Ink::Text, format!("{side}, median"));
        for (index, column) in columns.iter().enumerate() {
            let first = index == 0 || columns[index - 1].step != column.step;
            let Some(step) = column.step.filter(|_| first).map(|s| &plan.form.steps[s]) else { continue };
            let Some(times) = traced[step.index] else { continue };
            let times = if line == 0 { &times.cpu_ms } else { &times.gpu_ms };
            let Some([low, median, high]) = quartiles(times) else { continue };
            let x = names + COLUMN * index as f32;
            drawing.text([x + 2.0, middle], 11.0, Ink::Text, format!("{median:.2}"));
            let tip = format!(
                "step {}, {side} of {} frames: median {median:.3}, quartiles {low:.3} and {high:.3}",
                step.index,
                times.len()
            );
            drawing.hit([x, middle - ROW / 2.0, x + COLUMN, middle + ROW / 2.0], Item::Step(step.index), tip);
        }
    }
    y + 2.0 * ROW + 4.0
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

fn row(plan: &PlanData, columns: &[Column], index: usize, drawing: &mut Drawing, [names, y]: [f32; 2]) {
    let resource = &plan.form.resources[index];
    let middle = y + ROW / 2.0;
    let place = place_of(resource);
    let unused = resource.first_step.is_none();
    let ink = if unused { Ink::Ghost } else { Ink::Text };
    let width = names - 24.0 - text_width(&place, 11.0);
    let name = shortened(&resource.name, letters_in(width, SIZE));
    drawing.text([0.0, middle], SIZE, ink, name);
    drawing.aligned([names - 8.0, middle], 11.0, Align::Right, Ink::Faint, place);
    drawing.hit([0.0, y, names, y + ROW], Item::Resource(index), tip(resource));
    let x_of = |column: usize| names + COLUMN * column as f32;
    let within = |column: &Column| match (column.step, resource.first_step, resource.last_step) {
        (Some(step), Some(first), Some(last)) => first <= step && step <= last,
        _ => false,
    };
    let alive: Vec<usize> = (0..columns.len()).filter(|c| within(&columns[*c])).collect();
    if let (Some(first), Some(last)) = (alive.first(), alive.last()) {
        let bounds = [x_of(*first) + 2.0, y + 3.0, x_of(last + 1) - 2.0, y + ROW - 3.0];
        drawing.rect(bounds, place_ink(resource), None);
        drawing.hit([x_of(*first), y, x_of(last + 1), y + ROW], Item::Resource(index), tip(resource));
    }
    for (place, column) in columns.iter().enumerate() {
        let [left, right] = [x_of(place), x_of(place + 1)];
        let pass = &plan.form.passes[column.pass];
        let uses: Vec<_> = pass.accesses.iter().filter(|a| a.resource == resource.name).collect();
        if !uses.is_empty() && !column.resolve {
            let read = uses.iter().any(|a| a.mode == "read");
            let modify = uses.iter().any(|a| a.mode == "modify");
            let write = uses.iter().any(|a| a.writes() && a.mode != "modify");
            let letters: String =
                [(read, 'R'), (modify, 'M'), (write, 'W')].iter().filter(|(is, _)| *is).map(|(_, c)| *c).collect();
            let ink = if column.step.is_some() { Ink::Text } else { Ink::Ghost };
            drawing.aligned([(left + right) / 2.0, middle], SIZE, Align::Center, ink, letters);
        }
        let Some(step) = column.step.map(|s| &plan.form.steps[s]) else {
            if !uses.is_empty() {
                let words: Vec<_> = uses.iter().map(|a| format!("{} {}", a.mode, a.kind)).collect();
                let tip = format!("{} (culled) would {} {}", pass.name, words.join(", "), resource.name);
                drawing.hit([left, y, right, y + ROW], Item::Pass(column.pass), tip);
            }
            continue;
        };
        let attached: Vec<&Attachment> = plan.attached(step, &resource.name).collect();
        let first = place == 0 || columns[place - 1].step != column.step;
        let last = columns.get(place + 1).is_none_or(|next| next.step != column.step);
        if let (true, Some(attachment)) = (first, strongest(&attached, |a| load_rank(&a.load)))
            && !attachment.role.starts_with("resolve")
        {
            load_mark(drawing, &attachment.load, left + 4.0, middle);
        }
        if let (true, Some(attachment)) = (last, strongest(&attached, |a| store_rank(&a.store))) {
            let resolve = attachment.role.starts_with("resolve") && attachment.store == "store";
            store_mark(drawing, if resolve { "multisample" } else { &attachment.store }, right - 8.0, middle);
        }
        if !uses.is_empty() || !attached.is_empty() {
            let uses = uses.iter().map(|a| {
                let part = a.part.as_ref().map(|part| format!(", {part}")).unwrap_or_default();
                format!("{} {}{part}", a.mode, a.kind)
            });
            let ops = attached
                .iter()
                .map(|a| format!("{}: {}, {}\n  {}\n  {}", a.role, a.load, a.store, a.load_reason, a.store_reason));
            let lines: Vec<_> = uses.chain(ops).collect();
            let tip = format!("{} in {}\n{}", resource.name, pass.name, lines.join("\n"));
            drawing.hit([left, y, right, y + ROW], Item::Resource(index), tip);
        }
    }
}

/// Returns the attachment with the highest rank among several levels or layers of a resource.
fn strongest<'a>(attached: &[&'a Attachment], rank: impl Fn(&Attachment) -> u8) -> Option<&'a Attachment> {
    attached.iter().copied().max_by_key(|a| rank(a))
}

fn load_rank(load: &str) -> u8 {
    match load {
        "load" => 2,
        "clear" => 1,
        _ => 0,
    }
}

fn store_rank(store: &str) -> u8 {
    match store {
        "store" => 2,
        "discard" => 1,
        _ => 0,
    }
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
