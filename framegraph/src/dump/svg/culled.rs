//! The list of culled passes and their reasons.

use super::canvas::{Canvas, Ink, MARGIN};
use crate::decision::Subject;
use crate::dump::reasons::Reasons;
use crate::plan::Plan;

/// Draws the list from `y` down.
pub(super) fn draw(plan: &Plan, reasons: &Reasons, canvas: &mut Canvas, y: f64) {
    let graph = plan.graph();
    canvas.text(MARGIN, y, Ink::Heading, "culled passes");
    let mut y = y + 18.0;
    let mut none = true;
    for pass in graph.pass_ids().filter(|p| plan.is_culled(*p)) {
        none = false;
        let reason = reasons.sentence(plan, Subject::Pass(pass));
        let line = format!("{}: {reason}", graph.pass_name(pass));
        canvas.text(MARGIN, y, Ink::Plain, &line);
        y += 16.0;
    }
    if none {
        canvas.text(MARGIN, y, Ink::Faint, "none");
    }
}
