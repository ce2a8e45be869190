//! Histogram with the displayed range, whose ends can be dragged.

use crate::live::preview::Preview;
use crate::live::preview::look::Shown;
use egui::{Color32, Pos2, Sense, Stroke, Ui, pos2, vec2};

/// Height in points.
const HEIGHT: f32 = 48.0;
/// Colors of the channels, from Okabe and Ito.
const INKS: [[u8; 3]; 4] = [[213, 94, 0], [0, 158, 115], [0, 114, 178], [128, 128, 128]];

/// Shows one line per channel, scaled to its maximum, and moves the nearer end of the range to the pointer while
/// dragging.
pub(super) fn histogram(ui: &mut Ui, preview: &mut Preview) {
    let Some(found) = preview.found.clone() else { return };
    let size = vec2(ui.available_width().max(1.0), HEIGHT);
    let (response, painter) = ui.allocate_painter(size, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "histogram"));
    let rect = response.rect;
    for (boxes, [r, g, b]) in found.histogram.iter().zip(INKS) {
        let max = boxes.iter().copied().max().unwrap_or(1).max(1) as f32;
        let point = |(index, count): (usize, &u32)| {
            let x = rect.left() + rect.width() * (index as f32 + 0.5) / boxes.len() as f32;
            pos2(x, rect.bottom() - rect.height() * (*count as f32 / max).sqrt())
        };
        let points: Vec<Pos2> = boxes.iter().enumerate().map(point).collect();
        painter.add(egui::Shape::line(points, Stroke::new(1.2, Color32::from_rgb(r, g, b))));
    }
    let [low, high] = found.span;
    if preview.look.shown != Shown::Distance && high > low {
        let x_of = |value: f32| rect.left() + rect.width() * (value - low) / (high - low);
        let range = &mut preview.look.range;
        for end in *range {
            let x = x_of(end).clamp(rect.left(), rect.right());
            painter.vline(x, rect.y_range(), Stroke::new(1.5, ui.visuals().text_color()));
        }
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            let nearer = usize::from((pointer.x - x_of(range[1])).abs() < (pointer.x - x_of(range[0])).abs());
            let share = ((pointer.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
            range[nearer] = low + share * (high - low);
        }
    }
    response.on_hover_text(format!(
        "Histogram from {low} to {high}: red, green, blue, alpha (square-root scale). Drag to change the range"
    ));
}
