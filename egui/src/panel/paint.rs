//! Painter of the visible shapes of a drawing.

use super::color;
use crate::drawing::{ADVANCE, Align, Drawing, Item, Shape, Theme};
use egui::emath::TSTransform;
use egui::epaint::TextShape;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, pos2};

/// Minimum height of painted text, in points.
const MIN_TEXT: f32 = 3.5;

/// Paints the shapes within the clip rectangle and highlights marked shapes of lit items.
pub(super) fn paint(painter: &Painter, drawing: &Drawing, to_screen: TSTransform, theme: Theme, lit: &[Item]) {
    let seen = painter.clip_rect().expand(2.0);
    let bright: std::collections::HashSet<usize> =
        drawing.marks.iter().filter(|(_, item)| lit.contains(item)).map(|(shape, _)| *shape).collect();
    let (zoom, at) = (to_screen.scaling, |[x, y]: [f32; 2]| to_screen * pos2(x, y));
    for (index, shape) in drawing.shapes.iter().enumerate() {
        match shape {
            Shape::Rect { bounds: [left, top, right, bottom], fill, stroke, dashed } => {
                let rect = Rect::from_two_pos(at([*left, *top]), at([*right, *bottom]));
                if !rect.intersects(seen) {
                    continue;
                }
                let fill = fill.map_or(Color32::TRANSPARENT, |ink| color(ink, theme));
                let stroke = stroke.map_or(Stroke::NONE, |ink| Stroke::new(1.0, color(ink, theme)));
                if *dashed {
                    let corners = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
                    let around: Vec<Pos2> = corners.into_iter().chain([corners[0]]).collect();
                    painter.extend(egui::Shape::dashed_line(&around, stroke, 4.0, 3.0));
                } else {
                    painter.rect(rect, 0.0, fill, stroke, StrokeKind::Middle);
                }
            }
            Shape::Line { points, ink, width, dashed } => {
                let bright = bright.contains(&index);
                let ink = if bright { crate::drawing::Ink::Selected } else { *ink };
                let width = (width * zoom).clamp(0.6, 3.0) + if bright { 1.5 } else { 0.0 };
                let stroke = Stroke::new(width, color(ink, theme));
                for run in runs(points.iter().map(|p| at(*p)), seen.expand(width)) {
                    if *dashed {
                        painter.extend(egui::Shape::dashed_line(&run, stroke, 4.0, 3.0));
                    } else {
                        painter.add(egui::Shape::line(run, stroke));
                    }
                }
            }
            Shape::Triangle { points, ink } => {
                let points = points.map(at);
                if Rect::from_points(&points).intersects(seen) {
                    let fill = color(*ink, theme);
                    painter.add(egui::Shape::convex_polygon(points.to_vec(), fill, Stroke::NONE));
                }
            }
            Shape::Text { at: place, size, align, ink, turned, text } => {
                let size = size * zoom;
                let (place, reach) = (at(*place), text.chars().count() as f32 * size * ADVANCE + size);
                if size < MIN_TEXT || !Rect::from_center_size(place, egui::Vec2::splat(2.0 * reach)).intersects(seen) {
                    continue;
                }
                let anchor = match align {
                    Align::Left => Align2::LEFT_CENTER,
                    Align::Center => Align2::CENTER_CENTER,
                    Align::Right => Align2::RIGHT_CENTER,
                };
                // Round to half points, so that zooming creates few font sizes.
                let font = FontId::monospace((size * 2.0).round() / 2.0);
                let ink = color(*ink, theme);
                if *turned == 0.0 {
                    painter.text(place, anchor, text, font, ink);
                } else {
                    let galley = painter.layout_no_wrap(text.clone(), font, ink);
                    let place = place - egui::vec2(0.0, galley.size().y / 2.0);
                    painter.add(
                        TextShape::new(place, galley, ink)
                            .with_angle_and_anchor(-turned.to_radians(), Align2::LEFT_CENTER),
                    );
                }
            }
        }
    }
}

/// Returns the visible runs of a polyline, each with the points just outside.
///
/// A line across a long frame has thousands of points.
fn runs(points: impl Iterator<Item = Pos2>, seen: Rect) -> Vec<Vec<Pos2>> {
    let mut runs: Vec<Vec<Pos2>> = Vec::new();
    let mut last: Option<(Pos2, bool)> = None;
    for point in points {
        let drawn = last.is_some_and(|(before, _)| Rect::from_two_pos(before, point).intersects(seen));
        match (last, drawn) {
            (Some((_, true)), true) => runs.last_mut().into_iter().for_each(|run| run.push(point)),
            (Some((before, false)), true) => runs.push(vec![before, point]),
            _ => {}
        }
        last = Some((point, drawn));
    }
    runs
}

/// Outlines the areas of lit items; of nested areas, only the outermost.
pub(super) fn frame(painter: &Painter, drawing: &Drawing, to_screen: TSTransform, theme: Theme, lit: &[Item]) {
    let seen = painter.clip_rect().expand(2.0);
    for (index, item) in lit.iter().enumerate() {
        let width = if index == 0 { 3.0 } else { 1.5 };
        let stroke = Stroke::new(width, color(crate::drawing::Ink::Selected, theme));
        let mut framed: Vec<[f32; 4]> = Vec::new();
        for hit in drawing.hits.iter().filter(|hit| hit.item == Some(*item)) {
            let within = |[l, t, r, b]: [f32; 4]| {
                l <= hit.bounds[0] && t <= hit.bounds[1] && hit.bounds[2] <= r && hit.bounds[3] <= b
            };
            if framed.iter().any(|outer| within(*outer)) {
                continue;
            }
            framed.push(hit.bounds);
            let [left, top, right, bottom] = hit.bounds;
            let rect = Rect::from_two_pos(to_screen * pos2(left, top), to_screen * pos2(right, bottom));
            if rect.intersects(seen) {
                painter.rect_stroke(rect.expand(1.0), 0.0, stroke, StrokeKind::Middle);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_keep_their_visible_runs() {
        let seen = Rect::from_min_max(pos2(0.0, 0.0), pos2(10.0, 10.0));
        let line = |xs: &[f32]| runs(xs.iter().map(|x| pos2(*x, 5.0)), seen);
        let xs = |run: &[Pos2]| run.iter().map(|p| p.x).collect::<Vec<_>>();
        let all: Vec<_> = line(&[-30.0, -20.0, -5.0, 5.0, 15.0, 30.0, 40.0]).iter().map(|run| xs(run)).collect();
        assert_eq!(all, [[-5.0, 5.0, 15.0]]);
        let twice: Vec<_> = line(&[-5.0, 5.0, 15.0, 20.0, 15.0, 5.0]).iter().map(|run| xs(run)).collect();
        assert_eq!(twice, [vec![-5.0, 5.0, 15.0], vec![15.0, 5.0]]);
        assert_eq!(line(&[-5.0, 15.0]).len(), 1, "it goes across without a point inside");
        assert!(line(&[-9.0, -5.0]).is_empty() && line(&[5.0]).is_empty());
    }
}
