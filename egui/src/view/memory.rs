//! Memory map: offsets over steps, with the peak, and the savings of aliasing and memoryless attachments.

use super::format::{bytes, change, title};
use super::heads::step_tip;
use super::timeline::{place_ink, tip};
use crate::drawing::{Align, Drawing, Ink, Item, letters_in, shortened, text_width};
use crate::plan_data::{PlanData, Resource};

/// Height of the map.
const HEIGHT: f32 = 380.0;
/// Minimum width of the map.
const WIDTH: f32 = 640.0;
/// Minimum width of a step.
const STEP: f32 = 46.0;
/// Width of the offset scale.
const SCALE: f32 = 84.0;
/// Font size.
const SIZE: f32 = 12.0;

/// Draws the map, with the change from another plan.
pub fn drawing(plan: &PlanData, against: Option<&PlanData>) -> Drawing {
    let mut drawing = Drawing::default();
    let y = title(&mut drawing, "memory", plan);
    let mut y = sums(plan, against, &mut drawing, y) + 16.0;
    let form = &plan.form;
    let placed = || form.resources.iter().enumerate().filter(|(_, r)| r.offset.is_some() && r.held_steps.is_some());
    let (textures, buffers): (Vec<_>, Vec<_>) = placed().partition(|(_, r)| r.format.is_some());
    let overlap = |a: &Resource, b: &Resource| {
        let held = |r: &Resource| r.held_steps.unwrap_or_default();
        let range = |r: &Resource| (r.offset.unwrap_or_default(), end(r));
        let ([af, al], [bf, bl], (ao, ae), (bo, be)) = (held(a), held(b), range(a), range(b));
        af <= bl && bf <= al && ao < be && bo < ae
    };
    // Offsets of textures and buffers both start at 0 if the device has separate heaps.
    let apart = form.alias == "heap" && textures.iter().any(|(_, t)| buffers.iter().any(|(_, b)| overlap(t, b)));
    if textures.is_empty() && buffers.is_empty() {
        drawing.text([0.0, y], SIZE, Ink::Faint, "no resource uses shared memory");
        y += 20.0;
    } else if apart {
        y = map(plan, "texture heap", &textures, &mut drawing, y);
        y = map(plan, "buffer heap", &buffers, &mut drawing, y + 20.0);
    } else {
        let what = if form.slots.is_empty() { "heap" } else { "slots of the pool, end to end" };
        let all: Vec<_> = placed().collect();
        y = map(plan, what, &all, &mut drawing, y);
    }
    let y = list(plan, "outlives the frame", |r| r.placement == "own" || r.kind == "history", &mut drawing, y + 24.0);
    let y = list(plan, "imported", |r| r.placement == "external", &mut drawing, y + 12.0);
    list(plan, "no memory", |r| matches!(r.placement.as_str(), "memoryless" | "inlined"), &mut drawing, y + 12.0);
    drawing
}

/// Returns the end of a resource in its heap.
fn end(resource: &Resource) -> u64 {
    resource.offset.unwrap_or_default().saturating_add(resource.bytes)
}

/// Draws the totals.
fn sums(plan: &PlanData, against: Option<&PlanData>, drawing: &mut Drawing, mut y: f32) -> f32 {
    let totals = plan.form.totals;
    let shared = totals.unaliased_bytes.saturating_sub(totals.heap_bytes);
    let bound = if totals.optimal { " (proved minimal)" } else { "" };
    let was = against.map(|plan| plan.form.totals);
    let row = |of: &dyn Fn(&crate::plan_data::Totals) -> u64| (of(&totals), was.as_ref().map(of));
    let rows = [
        ("shared memory", row(&|t| t.heap_bytes), bound.to_owned()),
        ("lower bound", row(&|t| t.lower_bound_bytes), " (of any placement)".into()),
        ("without aliasing", row(&|t| t.unaliased_bytes), format!(" ({} saved by aliasing)", bytes(shared))),
        ("avoided", row(&|t| t.avoided_bytes), " (memoryless and inlined)".into()),
        ("outlives the frame", row(&|t| t.own_bytes), " (histories, exports)".into()),
    ];
    for (name, (now, was), note) in rows {
        drawing.text([0.0, y], SIZE, Ink::Text, name);
        drawing.aligned([250.0, y], SIZE, Align::Right, Ink::Text, bytes(now));
        let was = was.filter(|was| *was != now).map(|was| format!("  {}", change(was, now, true)));
        drawing.text([256.0, y], SIZE, Ink::Faint, note + &was.unwrap_or_default());
        y += 18.0;
    }
    y
}

/// Draws one map.
fn map(plan: &PlanData, what: &str, rows: &[(usize, &Resource)], drawing: &mut Drawing, y: f32) -> f32 {
    let form = &plan.form;
    let top_bytes = rows.iter().map(|(_, r)| end(r)).max().unwrap_or(1).max(1);
    let steps = form.steps.len().max(1);
    let step = (WIDTH / steps as f32).max(STEP);
    let (x_of, right) = (|s: usize| SCALE + step * s as f32, SCALE + step * steps as f32);
    let top = y + 44.0;
    let y_of = |offset: u64| top + HEIGHT * (1.0 - offset as f32 / top_bytes as f32);
    drawing.text([0.0, y], 13.0, Ink::Text, format!("{what}: {}", bytes(top_bytes)));
    let peak = form.peak.as_ref();
    if let Some(peak) = peak {
        let names = format!("peak at step {}: {}", peak.step, peak.resources.join(", "));
        let at = (x_of(peak.step), x_of(peak.step + 1));
        drawing.rect([at.0, top - 18.0, at.1, top + HEIGHT], None, Ink::Peak);
        let room = letters_in(right.max(900.0), SIZE);
        drawing.text([0.0, y + 17.0], SIZE, Ink::Peak, shortened(&names, room));
        drawing.hit([0.0, y + 8.0, right, y + 25.0], Item::Step(peak.step), names);
    }
    for quarter in 0..=4u64 {
        let offset = (u128::from(top_bytes) * u128::from(quarter) / 4) as u64;
        drawing.line(vec![[SCALE, y_of(offset)], [right, y_of(offset)]], Ink::Grid, 1.0);
        drawing.aligned([SCALE - 6.0, y_of(offset)], 11.0, Align::Right, Ink::Faint, bytes(offset));
    }
    for row in &form.steps {
        let bounds = [x_of(row.index), top - 18.0, x_of(row.index + 1), top];
        let middle = [(bounds[0] + bounds[2]) / 2.0, top - 9.0];
        drawing.aligned(middle, 11.0, Align::Center, Ink::Faint, row.index.to_string());
        drawing.hit(bounds, Item::Step(row.index), step_tip(row));
    }
    for &(index, resource) in rows {
        let [first, last] = resource.held_steps.unwrap_or_default();
        let offset = resource.offset.unwrap_or_default();
        let bounds = [x_of(first) + 1.0, y_of(end(resource)) + 0.5, x_of(last + 1) - 1.0, y_of(offset) - 0.5];
        let at_peak = peak.is_some_and(|peak| peak.resources.contains(&resource.name));
        drawing.rect(bounds, place_ink(resource), if at_peak { Ink::Peak } else { Ink::Faint });
        drawing.hit(bounds, Item::Resource(index), tip(resource));
        let (width, height) = (bounds[2] - bounds[0], bounds[3] - bounds[1]);
        let letters = letters_in(width - 8.0, 11.0);
        let middle = (bounds[1] + bounds[3]) / 2.0;
        if height >= 14.0 && letters >= 2 {
            let size = bytes(resource.bytes);
            let both = text_width(&resource.name, 11.0) + text_width(&size, 11.0) + 16.0 < width;
            drawing.text([bounds[0] + 4.0, middle], 11.0, Ink::Text, shortened(&resource.name, letters));
            if both {
                drawing.aligned([bounds[2] - 4.0, middle], 11.0, Align::Right, Ink::Text, size);
            }
        }
    }
    top + HEIGHT + 8.0
}

/// Draws a list of resources outside the map.
fn list(plan: &PlanData, what: &str, is: impl Fn(&Resource) -> bool, drawing: &mut Drawing, y: f32) -> f32 {
    let rows: Vec<_> = plan.form.resources.iter().enumerate().filter(|(_, r)| is(r)).collect();
    if rows.is_empty() {
        return y;
    }
    drawing.text([0.0, y], 13.0, Ink::Text, what);
    let mut y = y + 20.0;
    for (index, resource) in rows {
        drawing.rect([0.0, y - 6.0, 14.0, y + 6.0], place_ink(resource), Ink::Faint);
        let images = plan.form.histories.iter().find(|h| h.name == resource.name);
        let images = images.map(|h| format!(", {} images of {}", h.images, bytes(h.image_bytes))).unwrap_or_default();
        let line = format!("{}: {}, {}{images}", resource.name, resource.shape, bytes(resource.bytes));
        drawing.hit([0.0, y - 8.0, 20.0 + text_width(&line, SIZE), y + 8.0], Item::Resource(index), tip(resource));
        drawing.text([20.0, y], SIZE, Ink::Text, line);
        y += 18.0;
    }
    y
}
