//! Plans as SVG images: a matrix of resources and steps with loads and stores, a map of the shared memory, and the
//! culled passes. The file is self-contained, without scripts or fonts.

mod canvas;
mod culled;
mod matrix;
mod memory;

use super::describe::bytes;
use super::reasons::Reasons;
use crate::plan::Plan;
pub use canvas::xml_escaped;
use canvas::{Canvas, Ink, MARGIN};

/// Returns the plan as an SVG document.
pub fn svg(plan: &Plan) -> String {
    let mut canvas = Canvas::new();
    let reasons = Reasons::new(plan);
    let mut y = MARGIN + 14.0;
    y = title(plan, &mut canvas, y);
    y = matrix::draw(plan, &reasons, &mut canvas, y + 14.0);
    y = memory::draw(plan, &mut canvas, y + 34.0);
    culled::draw(plan, &reasons, &mut canvas, y + 34.0);
    canvas.finish(MARGIN)
}

/// Draws the name of the device, counts and bytes. Returns the lower end.
fn title(plan: &Plan, canvas: &mut Canvas, y: f64) -> f64 {
    let [w, h] = plan.frame();
    let (counts, memory) = (plan.counts(), plan.memory());
    let traffic = plan.traffic(plan.frame());
    let head = format!("plan for {} at {w}×{h}", plan.caps().name);
    canvas.text(MARGIN, y, Ink::Title, &head);
    let lines = [
        format!(
            "{} passes in {} steps, {} culled; {} loads ({}), {} stores ({}), {} clears, {} discards, {} multisample resolves",
            counts.passes,
            counts.steps,
            counts.culled,
            counts.unresolves,
            bytes(traffic.loaded_bytes),
            counts.resolves,
            bytes(traffic.stored_bytes),
            counts.clears,
            counts.discards,
            counts.multisample_resolves,
        ),
        format!(
            "{} memoryless, {} inlined; {} of memory{}, lower bound {}, {} unshared, {} avoided, {} outlive the frame",
            counts.memoryless,
            counts.inlined,
            bytes(memory.bytes),
            match (memory.optimal, plan.slots().is_empty()) {
                (true, true) => " (optimal)",
                (true, false) => " (optimal for a pool)",
                (false, _) => "",
            },
            bytes(memory.lower_bound_bytes),
            bytes(memory.unaliased_bytes),
            bytes(memory.avoided_bytes),
            bytes(memory.own_bytes),
        ),
    ];
    let warnings = plan.warnings().map(|warning| format!("warning: {}", warning.sentence()));
    let lines: Vec<_> = lines.into_iter().chain(warnings).collect();
    for (line, text) in lines.iter().enumerate() {
        canvas.text(MARGIN, y + 20.0 + 16.0 * line as f64, Ink::Plain, text);
    }
    y + 20.0 + 16.0 * lines.len() as f64
}
