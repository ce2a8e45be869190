//! The matrix of resources and steps: lifetimes as bars, and in each cell the operations of a step on a resource.

use super::canvas::{Canvas, Ink, MARGIN, NAMES, STEP, shortened, step_x};
use crate::access::AccessKind;
use crate::decision::Subject;
use crate::dump::describe::{bytes, place, shape};
use crate::dump::reasons::Reasons;
use crate::id::{ResourceId, StepId};
use crate::plan::{Attachment, Join, LoadOp, Placement, Plan, StoreOp};
use crate::sanitize::escape_controls;

/// Height of a row.
const ROW: f64 = 20.0;
/// Maximum number of characters of a column head.
const HEAD: usize = 26;

/// Draws the matrix from `y` down. Returns the lower end.
pub(super) fn draw(plan: &Plan, reasons: &Reasons, canvas: &mut Canvas, y: f64) -> f64 {
    canvas.text(MARGIN, y, Ink::Heading, "resources × steps");
    let y = legend(canvas, y + 20.0);
    let y = heads(plan, canvas, y);
    let mut row = y;
    for resource in plan.graph().resource_ids() {
        draw_row(plan, reasons, canvas, resource, row);
        row += ROW;
    }
    let steps = plan.steps().len();
    for step in 0..=steps {
        let x = step_x(step);
        canvas.path(&format!("M{x:.1} {y:.1}V{row:.1}"), "none", "#e4e4e4", "");
    }
    row
}

fn legend(canvas: &mut Canvas, y: f64) -> f64 {
    let entries = [
        (LoadOp::Load, StoreOp::Store, "load from memory, store to memory"),
        (LoadOp::Clear, StoreOp::Discard, "clear, discard"),
        (LoadOp::DontCare, StoreOp::None, "don't care, unchanged"),
    ];
    let mut x = MARGIN;
    for (load, store, text) in entries {
        glyph_load(canvas, load, x, y - 4.0, "");
        glyph_store(canvas, store, x + 20.0, y - 4.0, "");
        canvas.text(x + 40.0, y, Ink::Faint, text);
        x += 60.0 + text.chars().count() as f64 * Ink::Faint.advance();
    }
    let colors = [("#cfe3f7", "shared memory"), ("#cdeccd", "no memory"), ("#e3d8f2", "outlives the frame")];
    for (color, text) in colors {
        canvas.rect([x, y - 10.0], [14.0, 12.0], color, "none", "");
        canvas.text(x + 20.0, y, Ink::Faint, text);
        x += 40.0 + text.chars().count() as f64 * Ink::Faint.advance();
    }
    let (x, y) = (MARGIN, y + 18.0);
    let text = "r: read, w: written as storage or copy target; step names: +: merged, ⤷: inlined into the previous pass, ⤓: full-screen resolve";
    canvas.text(x, y, Ink::Faint, text);
    y
}

/// Draws step numbers and the names of their passes, slanted.
fn heads(plan: &Plan, canvas: &mut Canvas, y: f64) -> f64 {
    let graph = plan.graph();
    let label = |step: StepId| {
        let names = plan.passes_of(step).iter().map(|m| {
            let sign = match m.join {
                Join::First => "",
                Join::Attachments | Join::SamePixel => "+",
                Join::Inlined => "⤷",
                Join::Resolve => "⤓",
            };
            format!("{sign}{}", graph.pass_name(m.pass))
        });
        shortened(&names.collect::<Vec<_>>().join(" "), HEAD)
    };
    let longest = plan.step_ids().map(|s| label(s).chars().count()).max().unwrap_or(0);
    // Text slanted by 60° rises by sin 60° of its length.
    let y = y + 34.0 + longest as f64 * Ink::Plain.advance() * 0.87;
    for step in plan.step_ids() {
        let x = step_x(step.index());
        canvas.slanted(x + 16.0, y - 18.0, &label(step));
        let all: Vec<_> = plan.passes_of(step).iter().map(|m| escape_controls(graph.pass_name(m.pass))).collect();
        let traffic = plan.step_traffic(step, plan.frame());
        let tip = format!(
            "step {}: {}\nloads {}, stores {}",
            step.index(),
            all.join(", "),
            bytes(traffic.loaded_bytes),
            bytes(traffic.stored_bytes)
        );
        canvas.rect([x + 1.0, y - 15.0], [STEP - 2.0, 14.0], "#f4f4f4", "#bbb", &tip);
        canvas.text(x + 6.0, y - 4.0, Ink::Small, &step.index().to_string());
    }
    y + 2.0
}

fn draw_row(plan: &Plan, reasons: &Reasons, canvas: &mut Canvas, resource: ResourceId, y: f64) {
    let graph = plan.graph();
    let row = &plan.resources()[resource.index()];
    let unused = row.first.is_none();
    let place = match row.placement {
        Placement::Own | Placement::Slot(_) => format!("{} {}", place(row.placement), bytes(row.bytes)),
        Placement::Heap { .. } => bytes(row.bytes),
        other => place(other),
    };
    let name = graph.resource_name(resource);
    let room = (NAMES / Ink::Plain.advance()) as usize - 2 - place.chars().count();
    let ink = if unused { Ink::Faint } else { Ink::Plain };
    canvas.text(MARGIN, y + 14.0, ink, &shortened(name, room));
    let width = place.chars().count() as f64 * Ink::Faint.advance();
    canvas.text(MARGIN + NAMES - 8.0 - width, y + 14.0, Ink::Faint, &place);
    if unused {
        return;
    }
    let color = match row.placement {
        Placement::Slot(_) | Placement::Heap { .. } => "#cfe3f7",
        Placement::Memoryless | Placement::Inlined => "#cdeccd",
        Placement::Own | Placement::External => "#e3d8f2",
        Placement::Unused => "#eee",
    };
    let (first, last) = (step_x(row.first.index()), step_x(row.last.index()) + STEP);
    let declared = &graph.resources()[resource.index()];
    let mut tip =
        format!("{}\n{}, {}", escape_controls(name), shape(plan, &declared.desc, row.format), bytes(row.bytes));
    for reason in reasons.of(Subject::Resource(resource)) {
        tip += &format!("\n{}", reason.sentence(graph));
    }
    canvas.rect([first + 2.0, y + 3.0], [last - first - 4.0, ROW - 6.0], color, "none", &tip);
    for step in row.first.index()..=row.last.index() {
        cell(plan, reasons, canvas, resource, StepId::at(step), y);
    }
}

/// Draws the operations of one step on one resource.
fn cell(plan: &Plan, reasons: &Reasons, canvas: &mut Canvas, resource: ResourceId, step: StepId, y: f64) {
    let middle = y + ROW / 2.0;
    let x = step_x(step.index());
    let mut attached = plan.attachments_of(step).iter().filter(|a| a.resource == resource);
    if let Some(first) = attached.next() {
        let strongest = attached.fold(*first, |a, b| stronger(&a, b));
        let why = |subject| reasons.sentence(plan, subject);
        let load = format!("{}: {}", strongest.load.word(), why(Subject::Load(step, resource)));
        let store = format!("{}: {}", strongest.store.word(), why(Subject::Store(step, resource)));
        glyph_load(canvas, strongest.load, x + 5.0, middle, &load);
        glyph_store(canvas, strongest.store, x + 23.0, middle, &store);
        return;
    }
    let word = match used(plan, resource, step) {
        (true, true) => "rw",
        (true, false) => "r",
        (false, true) => "w",
        (false, false) => return,
    };
    let width = word.len() as f64 * Ink::Plain.advance();
    canvas.text(x + (STEP - width) / 2.0, middle + 4.0, Ink::Plain, word);
}

/// Combines attachments of several subresources: prefers operations with a cost.
fn stronger(a: &Attachment, b: &Attachment) -> Attachment {
    let load = if b.load == LoadOp::Load { b.load } else { a.load };
    let store = if b.store == StoreOp::Store { b.store } else { a.store };
    Attachment { load, store, ..*a }
}

/// Returns two flags: the step reads the resource, and it writes it.
fn used(plan: &Plan, resource: ResourceId, step: StepId) -> (bool, bool) {
    let mut read = plan.full_screen_resolves(step).any(|(samples, _)| samples.resource == resource);
    let mut written = plan.full_screen_resolves(step).any(|(_, target)| target.resource == resource);
    for member in plan.passes_of(step).iter().filter(|m| m.join != Join::Resolve) {
        for access in plan.graph().accesses_of(member.pass) {
            let inlined = member.join == Join::Inlined && access.kind == AccessKind::SamePixel;
            if access.resource == resource && !inlined {
                read |= access.needs_contents();
                written |= access.mode.writes();
            }
        }
    }
    (read, written)
}

/// Draws the left half of a cell: an arrow into the tile, a square, or a dash.
fn glyph_load(canvas: &mut Canvas, load: LoadOp, x: f64, y: f64, tip: &str) {
    match load {
        LoadOp::Load => {
            let path = format!("M{x:.1} {:.1}l6 0l0 -3l6 6l-6 6l0 -3l-6 0z", y - 3.0);
            canvas.path(&path, "#c0392b", "none", tip);
        }
        LoadOp::Clear => canvas.rect([x + 2.0, y - 4.0], [8.0, 8.0], "#fff", "#333", tip),
        LoadOp::DontCare => {
            canvas.path(&format!("M{:.1} {y:.1}h8", x + 2.0), "none", "#777", tip);
        }
    }
}

/// Draws the right half of a cell: an arrow out of the tile, a cross, or a dot.
fn glyph_store(canvas: &mut Canvas, store: StoreOp, x: f64, y: f64, tip: &str) {
    match store {
        StoreOp::Store => {
            let path = format!("M{x:.1} {:.1}l6 0l0 -3l6 6l-6 6l0 -3l-6 0z", y - 3.0);
            canvas.path(&path, "#1f5fa8", "none", tip);
        }
        StoreOp::Discard => {
            let path = format!("M{:.1} {:.1}l8 8m0 -8l-8 8", x + 2.0, y - 4.0);
            canvas.path(&path, "none", "#333", tip);
        }
        StoreOp::None => canvas.rect([x + 4.5, y - 1.5], [3.0, 3.0], "#777", "none", tip),
    }
}
