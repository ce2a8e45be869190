//! Formatting shared by the views: numbers, colors of changes, and titles.

use crate::drawing::{Drawing, Ink};
use crate::plan_data::PlanData;
pub use framegraph::dump::bytes;

/// Returns the label of a field of the totals: `unresolve_bytes` becomes `load bytes`, `resolves` becomes `stores`.
///
/// Multisample resolves keep their name.
pub fn label(name: &str) -> String {
    let words = name.replace('_', " ");
    if words.starts_with("multisample") {
        words
    } else {
        words.replace("unresolve", "load").replace("resolve", "store")
    }
}

/// Formats a change: `+3`, `-1.5 MiB`, or `=`.
pub fn change(before: u64, after: u64, is_bytes: bool) -> String {
    let amount = before.abs_diff(after);
    let amount = if is_bytes { bytes(amount) } else { amount.to_string() };
    match before.cmp(&after) {
        std::cmp::Ordering::Less => format!("+{amount}"),
        std::cmp::Ordering::Greater => format!("-{amount}"),
        std::cmp::Ordering::Equal => "=".into(),
    }
}

/// Returns the color of a change in a cost: more is worse.
pub fn change_ink(before: u64, after: u64) -> Ink {
    match before.cmp(&after) {
        std::cmp::Ordering::Less => Ink::Worse,
        std::cmp::Ordering::Greater => Ink::Better,
        std::cmp::Ordering::Equal => Ink::Faint,
    }
}

/// Returns the color of a change in a total; totals that are not costs use the text color.
pub fn cost_ink(name: &str, before: u64, after: u64) -> Ink {
    let costs = matches!(name, "unresolves" | "resolves" | "steps" | "render_passes") || name.ends_with("_bytes");
    if costs && name != "avoided_bytes" { change_ink(before, after) } else { Ink::Text }
}

/// Draws the title of a view and the warnings of the plan; returns the bottom.
pub(super) fn title(drawing: &mut Drawing, what: &str, plan: &PlanData) -> f32 {
    let form = &plan.form;
    let name = if form.name.is_empty() { "frame" } else { &form.name };
    let [w, h] = form.frame;
    let head = format!("{what}: {name}, for {} at {w}x{h}", form.caps);
    drawing.text([0.0, 10.0], 16.0, Ink::Text, head);
    let mut y = 10.0;
    for warning in &form.warnings {
        y += 20.0;
        drawing.text([0.0, y], 12.0, Ink::Worse, format!("warning: {}", warning.sentence));
    }
    y + 24.0
}
