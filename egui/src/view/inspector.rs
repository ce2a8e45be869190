//! Inspector: all data of the frame or of one item as text, for its panel, exports and the clipboard.

mod pass;
mod resource;
mod section;
mod step;

pub use section::{Line, Section};

use super::format::{bytes, label};
use crate::drawing::{Drawing, Ink, Item, wrapped};
use crate::plan_data::PlanData;

/// Returns the sections of an item, or of the whole frame without a selection.
pub fn sections(plan: &PlanData, item: Option<Item>) -> Vec<Section> {
    let form = &plan.form;
    let mut sections = match item {
        Some(Item::Pass(index)) if index < form.passes.len() => pass::sections(plan, index),
        Some(Item::Step(index)) if index < form.steps.len() => step::sections(plan, index),
        Some(Item::Resource(index)) if index < form.resources.len() => resource::sections(plan, index),
        Some(Item::Flow(index)) => flow(plan, index),
        _ => frame(plan),
    };
    sections.retain(|section| !section.lines.is_empty());
    sections
}

/// Returns the sections of the whole frame: totals, warnings, and culled passes.
fn frame(plan: &PlanData) -> Vec<Section> {
    let form = &plan.form;
    let [w, h] = form.frame;
    let mut head = Section::new(if form.name.is_empty() { "frame" } else { &form.name });
    head.say(format!("device {}, {w}x{h}, order {}, aliasing {}", form.caps, form.order, form.alias));
    form.warnings.iter().for_each(|w| head.say(format!("warning: {}", w.sentence)));
    plan.notes.iter().for_each(|note| head.say(format!("note: {note}")));
    let mut totals = Section::new("totals");
    for (name, count, is_bytes) in form.totals.rows() {
        let value = match name {
            "optimal" if count == 0 => "no: not proved minimal".into(),
            "optimal" => "yes: proved minimal".into(),
            _ if is_bytes => bytes(count),
            _ => count.to_string(),
        };
        totals.say(format!("{}: {value}", label(name)));
    }
    let mut culled = Section::new("culled passes");
    for (index, pass) in form.passes.iter().enumerate().filter(|(_, pass)| pass.culled) {
        culled.link(Item::Pass(index), format!("{}: {}", pass.name, pass.reason));
    }
    let mut effects = Section::new("effects");
    form.notes.iter().for_each(|note| effects.say(format!("{}: {}", note.about, note.sentence)));
    vec![head, effects, totals, culled]
}

/// Returns the sections of a dependency between two passes.
fn flow(plan: &PlanData, index: usize) -> Vec<Section> {
    let Some(flow) = plan.form.flows.as_ref().and_then(|flows| flows.get(index)) else { return frame(plan) };
    let mut head = Section::new(format!("dependency from {} to {}", flow.from, flow.to));
    for name in [&flow.from, &flow.to] {
        head.lines.extend(plan.pass(name).map(|pass| Line::Link(Item::Pass(pass), format!("pass {name}"))));
    }
    let mut what = Section::new("resources");
    for resource in flow.resources.iter().filter_map(|name| plan.resource(name)) {
        let row = &plan.form.resources[resource];
        what.link(Item::Resource(resource), format!("{}: {}, {}", row.name, row.shape, bytes(row.bytes)));
    }
    vec![head, what]
}

/// Returns the sections as text for the clipboard.
pub fn text(sections: &[Section]) -> String {
    let mut out = String::new();
    for Section { title, lines } in sections {
        out += &format!("{title}\n");
        for line in lines {
            out += &match line {
                Line::Plain(text) | Line::Link(_, text) => format!("  {text}\n"),
                Line::Source(place) => format!("  declared at {place}\n"),
                Line::Hint(text) => format!("    hint: {text}\n"),
            };
        }
    }
    out
}

/// Draws the sections with lines of at most `letters` characters.
pub fn drawing(sections: &[Section], letters: usize) -> Drawing {
    let mut drawing = Drawing::default();
    let mut y = 10.0;
    for Section { title, lines } in sections {
        for line in wrapped(title, letters * 12 / 15) {
            drawing.text([0.0, y], 15.0, Ink::Text, line);
            y += 22.0;
        }
        for line in lines {
            let (x, ink, text) = match line {
                Line::Plain(text) => (0.0, Ink::Text, text.clone()),
                Line::Link(_, text) => (0.0, Ink::Better, text.clone()),
                Line::Source(place) => (0.0, Ink::Text, format!("declared at {place}")),
                Line::Hint(text) => (16.0, Ink::Faint, format!("hint: {text}")),
            };
            for part in wrapped(&text, letters.saturating_sub(2 * usize::from(x > 0.0))) {
                drawing.text([x, y], 12.0, ink, part);
                y += 17.0;
            }
        }
        y += 12.0;
    }
    drawing
}
