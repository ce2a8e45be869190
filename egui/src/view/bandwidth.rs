//! Bytes loaded, stored, resolved and fetched by each step, with totals and the change from another plan.

use super::format::{bytes, change, change_ink, title};
use super::heads::step_tip;
use crate::drawing::{Align, Drawing, Ink, Item, letters_in, shortened, text_width};
use crate::plan_data::{PlanData, Step};

/// Height of a row.
const ROW: f32 = 24.0;
/// Maximum width of the names.
const NAMES: f32 = 300.0;
/// Width of a column of numbers.
const FIGURE: f32 = 92.0;
/// Width of the longest bar.
const BAR: f32 = 420.0;
/// Font size.
const SIZE: f32 = 12.0;

/// Bytes moved by a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moved {
    /// Attachment loads (unresolves).
    pub loaded: u64,
    /// Attachment stores (resolves), without multisample resolve targets.
    pub stored: u64,
    /// Multisample resolve targets.
    pub resolved: u64,
    /// Reads by shaders and copies, each level, layer and buffer once.
    pub fetched: u64,
}

impl Moved {
    /// Returns the sum.
    pub fn total(self) -> u64 {
        [self.stored, self.resolved, self.fetched].iter().fold(self.loaded, |sum, b| sum.saturating_add(*b))
    }

    fn parts(self) -> [(&'static str, u64, Ink); 4] {
        [
            ("loaded", self.loaded, Ink::Load),
            ("stored", self.stored, Ink::Store),
            ("resolved", self.resolved, Ink::Resolve),
            ("fetched", self.fetched, Ink::Fetch),
        ]
    }
}

/// Returns the bytes moved by a step.
pub fn of_step(plan: &PlanData, step: &Step) -> Moved {
    let averages = step.attachments.iter().filter(|a| a.role.starts_with("resolve"));
    let resolved = averages.fold(0u64, |sum, a| sum.saturating_add(a.resolve_bytes));
    Moved {
        loaded: step.unresolve_bytes,
        stored: step.resolve_bytes.saturating_sub(resolved),
        resolved,
        fetched: plan.fetched_bytes(step),
    }
}

/// Returns the bytes moved by the whole frame.
pub fn of_frame(plan: &PlanData) -> Moved {
    plan.form.steps.iter().map(|step| of_step(plan, step)).fold(Moved::default(), |a, b| Moved {
        loaded: a.loaded.saturating_add(b.loaded),
        stored: a.stored.saturating_add(b.stored),
        resolved: a.resolved.saturating_add(b.resolved),
        fetched: a.fetched.saturating_add(b.fetched),
    })
}

/// Draws the table with bars.
pub fn drawing(plan: &PlanData, against: Option<&PlanData>) -> Drawing {
    let mut drawing = Drawing::default();
    let mut y = title(&mut drawing, "bandwidth", plan);
    let steps: Vec<(&Step, Moved)> = plan.form.steps.iter().map(|step| (step, of_step(plan, step))).collect();
    let name = |step: &Step| format!("{} {}", step.index, step.passes.join(" + "));
    let widest = steps.iter().map(|(step, _)| text_width(&name(step), SIZE)).fold(110.0, f32::max);
    let names = widest.min(NAMES);
    // Left end of the bars.
    let bars = names + 4.0 * FIGURE + 20.0;
    let max = steps.iter().map(|(_, moved)| moved.total()).max().unwrap_or(0).max(1);
    for (column, (name, _, ink)) in Moved::default().parts().into_iter().enumerate() {
        let right = names + FIGURE * (column + 1) as f32;
        drawing.rect(
            [right - text_width(name, SIZE) - 18.0, y - 5.0, right - text_width(name, SIZE) - 8.0, y + 5.0],
            ink,
            None,
        );
        drawing.aligned([right, y], SIZE, Align::Right, Ink::Text, name);
    }
    drawing.text([0.0, y], SIZE, Ink::Text, "step");
    y += ROW;
    for (step, moved) in &steps {
        drawing.line(vec![[0.0, y - ROW / 2.0], [bars + BAR, y - ROW / 2.0]], Ink::Grid, 1.0);
        let name = shortened(&name(step), letters_in(names + 1.0, SIZE));
        figures(&mut drawing, &name, *moved, [names, y]);
        let mut x = bars;
        for (word, count, ink) in moved.parts() {
            let width = BAR * (count as f64 / max as f64) as f32;
            if width > 0.0 {
                let bounds = [x, y - 7.0, x + width, y + 7.0];
                drawing.rect(bounds, ink, None);
                drawing.hit(bounds, Item::Step(step.index), format!("step {}: {word} {}", step.index, bytes(count)));
                x += width;
            }
        }
        drawing.hit([0.0, y - ROW / 2.0, bars, y + ROW / 2.0], Item::Step(step.index), step_tip(step));
        y += ROW;
    }
    drawing.line(vec![[0.0, y - ROW / 2.0], [bars + BAR, y - ROW / 2.0]], Ink::Text, 1.0);
    let total = of_frame(plan);
    figures(&mut drawing, "whole frame", total, [names, y]);
    drawing.text([bars, y], SIZE, Ink::Text, format!("{} in total", bytes(total.total())));
    if let Some(before) = against.map(of_frame) {
        y += ROW;
        drawing.text([0.0, y], SIZE, Ink::Text, "change");
        let pairs = before.parts().into_iter().zip(total.parts());
        for (column, ((_, was, _), (_, now, _))) in pairs.enumerate() {
            let right = names + FIGURE * (column + 1) as f32;
            drawing.aligned([right, y], SIZE, Align::Right, change_ink(was, now), change(was, now, true));
        }
        let (was, now) = (before.total(), total.total());
        let words = format!("{} in total", change(was, now, true));
        drawing.text([bars, y], SIZE, change_ink(was, now), words);
    }
    y += ROW + 4.0;
    for line in [
        "loaded: attachments from memory into the tile. stored: attachments from the tile to memory.",
        "resolved: multisample resolve targets. fetched: reads by shaders and copies, each level, layer and buffer once.",
    ] {
        drawing.text([0.0, y], 11.0, Ink::Faint, line);
        y += 17.0;
    }
    drawing
}

fn figures(drawing: &mut Drawing, name: &str, moved: Moved, [names, y]: [f32; 2]) {
    drawing.text([0.0, y], SIZE, Ink::Text, name);
    for (column, (_, count, _)) in moved.parts().into_iter().enumerate() {
        let right = names + FIGURE * (column + 1) as f32;
        let ink = if count == 0 { Ink::Faint } else { Ink::Text };
        drawing.aligned([right, y], SIZE, Align::Right, ink, if count == 0 { "0".into() } else { bytes(count) });
    }
}
