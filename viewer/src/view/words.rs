//! Figures in words, colors of changes, and headings: what the views share.

use crate::drawing::{Drawing, Ink};
use crate::plan_data::PlanData;

/// Bytes with a unit that keeps three or four digits.
pub fn bytes(count: u64) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let mut value = count as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{count} B") } else { format!("{value:.1} {}", UNITS[unit]) }
}

/// How a figure changed: `+3`, `-1.5 MiB`, `=` where it did not.
pub fn change(before: u64, after: u64, is_bytes: bool) -> String {
    let amount = before.abs_diff(after);
    let amount = if is_bytes { bytes(amount) } else { amount.to_string() };
    match before.cmp(&after) {
        std::cmp::Ordering::Less => format!("+{amount}"),
        std::cmp::Ordering::Greater => format!("-{amount}"),
        std::cmp::Ordering::Equal => "=".into(),
    }
}

/// The color of a change in a cost: more is worse.
pub fn change_ink(before: u64, after: u64) -> Ink {
    match before.cmp(&after) {
        std::cmp::Ordering::Less => Ink::Worse,
        std::cmp::Ordering::Greater => Ink::Better,
        std::cmp::Ordering::Equal => Ink::Faint,
    }
}

/// The same for a figure of the totals; those that are no cost stay plain.
pub fn cost_ink(name: &str, before: u64, after: u64) -> Ink {
    let costs = matches!(name, "unresolves" | "resolves" | "steps" | "render_passes") || name.ends_with("_bytes");
    if costs && name != "avoided_bytes" { change_ink(before, after) } else { Ink::Text }
}

/// The heading of a picture: what frame, for what, how large.
pub(super) fn title(drawing: &mut Drawing, what: &str, plan: &PlanData) -> f32 {
    let form = &plan.form;
    let name = if form.name.is_empty() { "the frame" } else { &form.name };
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
