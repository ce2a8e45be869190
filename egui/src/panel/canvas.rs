//! Drawing with pan, zoom and pointer interaction.

use super::{paint, theme};
use crate::drawing::{Drawing, Item, svg};
use egui::emath::TSTransform;
use egui::{Key, Modifiers, Pos2, Rect, Sense, Ui, Vec2, pos2, vec2};

/// Minimum and maximum zoom.
const ZOOM: [f32; 2] = [0.02, 8.0];
/// Margin around the drawing.
pub const MARGIN: f32 = 16.0;
/// Minimum zoom of automatic fitting, so that text stays readable.
const READABLE: f32 = 0.7;

/// Pan and zoom of a drawing.
#[derive(Clone, Debug)]
pub struct Canvas {
    /// Transform from the drawing to the panel, relative to its top left; `None` before the first frame.
    view: Option<TSTransform>,
    /// Minimum zoom of automatic fitting.
    least: f32,
    /// Panel and transform to the screen in the last frame.
    last: (Rect, TSTransform),
    /// Selected item to which the canvas was last panned.
    revealed: Option<Item>,
}

impl Default for Canvas {
    fn default() -> Self {
        Self { view: None, least: READABLE, last: (Rect::NOTHING, TSTransform::IDENTITY), revealed: None }
    }
}

/// Result of a click.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clicked {
    /// No click.
    No,
    /// Click on empty space.
    Empty,
    /// Click on an item.
    Item(Item),
}

impl Canvas {
    /// Creates a canvas that first fits the whole drawing, at any zoom.
    pub fn whole() -> Self {
        Self { least: ZOOM[0], ..Self::default() }
    }

    /// Shows buttons that fit the drawing, and copy it as text and as SVG.
    pub fn bar(&mut self, ui: &mut Ui, drawing: &Drawing) {
        if ui.small_button("Fit").on_hover_text("Show the whole view (F)").clicked() {
            self.fit();
        }
        if ui.small_button("Copy").on_hover_text("Copy the view as text").clicked() {
            ui.ctx().copy_text(drawing.words());
        }
        if ui.small_button("SVG").on_hover_text("Copy the view as an SVG document").clicked() {
            ui.ctx().copy_text(svg(drawing, theme(ui)));
        }
    }

    /// Shows a drawing with an accessible name. The first of the lit items is the selected one.
    pub fn show(&mut self, ui: &mut Ui, name: &str, drawing: &Drawing, lit: &[Item]) -> Clicked {
        let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, format!("{name} view")));
        let panel = response.rect;
        let mut view = self.view.unwrap_or_else(|| fitted(drawing, panel.size(), self.least));
        if response.dragged() {
            view.translation += response.drag_delta();
        }
        if response.hovered() {
            let (scroll, pinch, pointer) =
                ui.input(|i| (i.smooth_scroll_delta(), i.zoom_delta(), i.pointer.hover_pos()));
            view.translation += scroll;
            if let Some(pointer) = pointer.filter(|_| pinch != 1.0) {
                view = zoomed(view, pinch, pointer - panel.min);
            }
            if ui.ctx().memory(|memory| memory.focused().is_none()) {
                view = keyed(ui, view, drawing, panel);
            }
        }
        if self.revealed != lit.first().copied() {
            self.revealed = lit.first().copied();
            view = revealed(drawing, lit, view, panel.size());
        }
        let [w, h] = drawing.size.map(|side| side * view.scaling);
        let t = view.translation;
        view.translation = vec2(kept(t.x, w, panel.width(), 60.0), kept(t.y, h, panel.height(), 40.0));
        if self.view.is_some() || panel.is_positive() {
            self.view = Some(view);
        }
        let to_screen = TSTransform::from_translation(panel.min.to_vec2()) * view;
        self.last = (panel, to_screen);
        let theme = theme(ui);
        paint::paint(&painter, drawing, to_screen, theme, lit);
        paint::frame(&painter, drawing, to_screen, theme, lit);
        let under = |pos: Pos2| {
            let place = to_screen.inverse() * pos;
            drawing.at([place.x, place.y])
        };
        let clicked = match response.interact_pointer_pos().filter(|_| response.clicked()) {
            Some(pos) => under(pos).and_then(|hit| hit.item).map_or(Clicked::Empty, Clicked::Item),
            None => Clicked::No,
        };
        if let Some(hit) = response.hover_pos().and_then(under).filter(|hit| !hit.tip.is_empty()) {
            response.on_hover_text_at_pointer(&hit.tip);
        }
        clicked
    }

    /// Fits the whole drawing in the next frame, at any zoom.
    pub fn fit(&mut self) {
        (self.view, self.least) = (None, ZOOM[0]);
    }

    /// Returns the zoom of the last frame.
    pub fn zoom(&self) -> f32 {
        self.last.1.scaling
    }

    /// Returns the last screen position of an item; `None` if it is not visible.
    pub fn place_of(&self, drawing: &Drawing, item: Item) -> Option<Pos2> {
        let (panel, to_screen) = self.last;
        drawing.hits.iter().rev().filter(|hit| hit.item == Some(item)).find_map(|hit| {
            let [left, top, right, bottom] = hit.bounds;
            Some(to_screen * pos2((left + right) / 2.0, (top + bottom) / 2.0)).filter(|place| panel.contains(*place))
        })
    }
}

/// Limits the position of a drawing along one axis so that at least `margin` points of it stay in the panel.
fn kept(position: f32, drawing: f32, panel: f32, margin: f32) -> f32 {
    // A drawing or a panel smaller than the margin stays visible as a whole.
    let margin = margin.min(drawing).min(panel);
    position.min(panel - margin).max(margin - drawing)
}

/// Centers the first lit item that the drawing shows, unless it is visible.
fn revealed(drawing: &Drawing, lit: &[Item], view: TSTransform, panel: Vec2) -> TSTransform {
    // The last area is the item itself; heads and lines come first.
    let shown = |item: &Item| drawing.hits.iter().rev().find(|hit| hit.item == Some(*item));
    let Some([left, top, right, bottom]) = lit.iter().find_map(shown).map(|hit| hit.bounds) else { return view };
    let middle = view * pos2((left + right) / 2.0, (top + bottom) / 2.0);
    if Rect::from_min_size(Pos2::ZERO, panel).contains(middle) {
        return view;
    }
    TSTransform::new(view.translation + (panel / 2.0 - middle.to_vec2()), view.scaling)
}

/// Fits the drawing into the panel at a zoom between `least` and 1.
fn fitted(drawing: &Drawing, panel: Vec2, least: f32) -> TSTransform {
    let [w, h] = drawing.size.map(|side| side.max(1.0) + 2.0 * MARGIN);
    let zoom = (panel.x / w).min(panel.y / h).clamp(ZOOM[0], 1.0).max(least);
    TSTransform::new(vec2(MARGIN, MARGIN) * zoom.min(1.0), zoom)
}

/// Zooms about a position of the panel.
fn zoomed(view: TSTransform, factor: f32, about: Vec2) -> TSTransform {
    let zoom = (view.scaling * factor).clamp(ZOOM[0], ZOOM[1]);
    let factor = zoom / view.scaling;
    TSTransform::new(about + (view.translation - about) * factor, zoom)
}

/// Handles arrow keys, F, 1, plus and minus.
fn keyed(ui: &Ui, view: TSTransform, drawing: &Drawing, panel: Rect) -> TSTransform {
    let pressed = |key: Key| ui.input_mut(|i| i.consume_key(Modifiers::NONE, key));
    let middle = panel.size() / 2.0;
    let mut view = view;
    for (key, by) in [
        (Key::ArrowLeft, vec2(80.0, 0.0)),
        (Key::ArrowRight, vec2(-80.0, 0.0)),
        (Key::ArrowUp, vec2(0.0, 80.0)),
        (Key::ArrowDown, vec2(0.0, -80.0)),
    ] {
        if pressed(key) {
            view.translation += by;
        }
    }
    if pressed(Key::F) {
        view = fitted(drawing, panel.size(), ZOOM[0]);
    }
    if pressed(Key::Num1) {
        view = zoomed(view, 1.0 / view.scaling, middle);
    }
    if pressed(Key::Plus) || pressed(Key::Equals) {
        view = zoomed(view, 1.25, middle);
    }
    if pressed(Key::Minus) {
        view = zoomed(view, 0.8, middle);
    }
    view
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_the_drawing_stays_in_panels_of_every_size() {
        for drawing in [0.0, 1.0, 30.0, 5000.0] {
            for panel in [0.0, 1.0, 21.0, 60.0, 7680.0] {
                for position in [-1e9, -1.0, 0.0, 1e9] {
                    let at = kept(position, drawing, panel, 60.0);
                    let seen = (at + drawing).min(panel) - at.max(0.0);
                    assert!(seen >= drawing.min(panel).min(60.0) - 0.01, "{drawing} {panel} {position}: {at}");
                }
            }
        }
    }
}
