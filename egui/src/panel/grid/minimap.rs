//! Overview of a grid with the visible part.

use super::rows::Row;
use crate::view::table::Table;
use egui::{Painter, Rect, Stroke, StrokeKind, Vec2, Visuals, pos2, vec2};

/// Maximum number of lines.
const LINES: usize = 90;

/// Lifetimes of evenly chosen rows, as fractions of the columns.
pub(super) fn lines(table: &Table, rows: &[Row]) -> Vec<Option<[f32; 2]>> {
    let count = rows.len().min(LINES);
    let columns = table.len().max(1) as f32;
    let line = |line: usize| match rows[line * rows.len() / count] {
        Row::Resource(index) => table.spans[index].map(|[first, last]| [first as f32, last as f32 + 1.0]),
        Row::Group(..) => None,
    };
    (0..count).map(|index| line(index).map(|ends| ends.map(|end| end / columns))).collect()
}

/// Returns the place of the map in the body; `None` if everything is visible or the body is small.
pub(super) fn place(body: Rect, content: Vec2) -> Option<Rect> {
    let fits = content.x <= body.width() + 1.0 && content.y <= body.height() + 1.0;
    if fits || body.width() < 240.0 || body.height() < 140.0 {
        return None;
    }
    let size = vec2((0.3 * body.width()).min(180.0), (0.3 * body.height()).min(100.0));
    Some(Rect::from_min_size(body.max - size - vec2(6.0, 6.0), size))
}

/// Paints the map. `shown` is the visible part, as fractions of the content.
pub(super) fn paint(painter: &Painter, visuals: &Visuals, map: Rect, lines: &[Option<[f32; 2]>], shown: Rect) {
    painter.rect(map, 0.0, visuals.panel_fill, visuals.widgets.noninteractive.bg_stroke, StrokeKind::Outside);
    let height = map.height() / lines.len().max(1) as f32;
    for (index, [first, last]) in lines.iter().enumerate().filter_map(|(index, ends)| Some((index, (*ends)?))) {
        let top = map.top() + height * index as f32;
        let ends = [first, last].map(|end| map.left() + end * map.width());
        let line = Rect::from_min_max(pos2(ends[0], top), pos2(ends[1].max(ends[0] + 1.0), top + height.max(1.0)));
        painter.rect_filled(line, 0.0, visuals.selection.bg_fill.gamma_multiply(0.8));
    }
    let at = |share: egui::Pos2| map.min + share.to_vec2() * map.size();
    let shown = Rect::from_min_max(at(shown.min), at(shown.max)).intersect(map);
    painter.rect_stroke(shown, 0.0, Stroke::new(1.5, visuals.strong_text_color()), StrokeKind::Inside);
}
