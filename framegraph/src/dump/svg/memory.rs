//! The map of shared memory: offsets upwards, steps across, each resource a box over its lifetime.

use super::canvas::{Canvas, Ink, MARGIN, NAMES, STEP, shortened, step_x};
use crate::dump::describe::{bytes, held, offsets};
use crate::id::ResourceId;
use crate::plan::{Placement, Plan};
use crate::sanitize::escape_controls;

/// Height of the map.
const HEIGHT: f64 = 360.0;

/// Fill colors of neighboring boxes, light enough for dark text.
const FILLS: [&str; 8] = ["#cfe3f7", "#fbe3c4", "#d5efd0", "#f6d5dd", "#e3d8f2", "#fff2b8", "#cdeeea", "#e6e0d6"];

/// Draws the map from `y` down. Returns the lower end.
pub(super) fn draw(plan: &Plan, canvas: &mut Canvas, y: f64) -> f64 {
    let memory = plan.memory();
    let pool = !plan.slots().is_empty();
    let what = if pool { "pool, concatenated slots" } else { "heap" };
    canvas.text(MARGIN, y, Ink::Heading, &format!("shared memory ({what})"));
    let y = y + 18.0;
    if memory.bytes == 0 || plan.steps().is_empty() {
        canvas.text(MARGIN, y, Ink::Plain, "no resource uses shared memory");
        return y;
    }
    let offsets = stacked(plan);
    let ends = plan.resources().iter().zip(&offsets);
    let top = ends.filter_map(|(row, offset)| offset.map(|o| o.saturating_add(row.bytes))).fold(memory.bytes, u64::max);
    let scale = HEIGHT / top as f64;
    let floor = y + HEIGHT;
    let width = STEP * plan.steps().len() as f64;
    canvas.rect([step_x(0), y], [width, HEIGHT], "#fafafa", "#999", "");
    axis(canvas, top, floor, scale);
    for resource in plan.graph().resource_ids() {
        if let Some(offset) = offsets[resource.index()] {
            draw_box(plan, canvas, resource, offset, floor, scale);
        }
    }
    let bound = floor - memory.lower_bound_bytes as f64 * scale;
    let line = format!("M{:.1} {bound:.1}h{width:.1}", step_x(0));
    canvas.path(&line, "none", "#c0392b", "lower bound: the maximum of live bytes");
    live_curve(plan, canvas, floor, scale);
    let text = format!(
        "red line: lower bound {}; gray curve: live bytes; peak at step {}",
        bytes(memory.lower_bound_bytes),
        memory.peak.index()
    );
    canvas.text(step_x(0), floor + 18.0, Ink::Faint, &text);
    floor + 18.0
}

/// Returns the offset at which each resource is drawn. The buffer heap, if separate, is above the texture heap.
fn stacked(plan: &Plan) -> Vec<Option<u64>> {
    let mut offsets = offsets(plan);
    if !plan.caps().separate_heaps || !plan.slots().is_empty() {
        return offsets;
    }
    let graph = plan.graph();
    let is_texture = |r: &ResourceId| graph.resources()[r.index()].desc.texture().is_some();
    let end = |r: ResourceId| {
        let offset = offsets[r.index()]?;
        Some(offset.saturating_add(plan.resources()[r.index()].bytes))
    };
    let top = graph.resource_ids().filter(is_texture).filter_map(end).max().unwrap_or(0);
    for resource in graph.resource_ids().filter(|r| !is_texture(r)) {
        let offset = &mut offsets[resource.index()];
        *offset = offset.map(|o| o.saturating_add(top));
    }
    offsets
}

/// Draws five byte marks along the left edge.
fn axis(canvas: &mut Canvas, top: u64, floor: f64, scale: f64) {
    for mark in 0..=4u64 {
        let value = top / 4 * mark;
        let y = floor - value as f64 * scale;
        let label = bytes(value);
        let x = MARGIN + NAMES - 8.0 - label.chars().count() as f64 * Ink::Faint.advance();
        canvas.text(x, y + 4.0, Ink::Faint, &label);
    }
}

fn draw_box(plan: &Plan, canvas: &mut Canvas, resource: ResourceId, offset: u64, floor: f64, scale: f64) {
    let graph = plan.graph();
    let row = &plan.resources()[resource.index()];
    let name = graph.resource_name(resource);
    let Some((first, last)) = held(plan, resource) else {
        return;
    };
    let x = step_x(first.index());
    let width = step_x(last.index()) + STEP - x;
    let height = (row.bytes as f64 * scale).max(1.0);
    let y = floor - offset.saturating_add(row.bytes) as f64 * scale;
    let place = match row.placement {
        Placement::Slot(slot) => format!("slot {}", slot.index()),
        _ => format!("offset {offset}"),
    };
    let tip =
        format!("{}\n{} B, {place}, steps {} to {}", escape_controls(name), row.bytes, first.index(), last.index());
    let fill = FILLS[resource.index() % FILLS.len()];
    canvas.rect([x + 0.5, y], [width - 1.0, height], fill, "#555", &tip);
    let letters = ((width - 6.0) / Ink::Small.advance()) as usize;
    if height >= 11.0 && letters >= 2 {
        canvas.text(x + 4.0, y + height / 2.0 + 4.0, Ink::Small, &shortened(name, letters));
    }
}

/// Draws the live bytes of each step as a stepped line.
fn live_curve(plan: &Plan, canvas: &mut Canvas, floor: f64, scale: f64) {
    let mut change = vec![0i128; plan.steps().len() + 1];
    for resource in plan.graph().resource_ids() {
        if let Some((first, last)) = held(plan, resource) {
            let bytes = i128::from(plan.resources()[resource.index()].bytes);
            change[first.index()] += bytes;
            change[last.index() + 1] -= bytes;
        }
    }
    let mut live = 0;
    let mut path = format!("M{:.1} {floor:.1}", step_x(0));
    for (step, change) in change.iter().enumerate().take(plan.steps().len()) {
        live += change;
        path += &format!("V{:.1}H{:.1}", floor - live as f64 * scale, step_x(step + 1));
    }
    path += &format!("V{floor:.1}");
    canvas.path(&path, "none", "#888", "live bytes");
}
