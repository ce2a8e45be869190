//! Drawing with pan, zoom and pointer interaction.

use super::{paint, theme};
use crate::drawing::{Drawing, Item};
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
}

impl Default for Canvas {
    fn default() -> Self {
        Self { view: None, least: READABLE, last: (Rect::NOTHING, TSTransform::IDENTITY) }
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
        // Keep a part of the drawing visible.
        let [w, h] = drawing.size.map(|side| side * view.scaling);
        let t = &mut view.translation;
        *t = vec2(
            t.x.clamp(60.0 - w, panel.width().max(61.0) - 60.0),
            t.y.clamp(40.0 - h, panel.height().max(41.0) - 40.0),
        );
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

    /// Fits the whole drawing in the next frame.
    pub fn fit(&mut self) {
        self.view = None;
    }

    /// Centers an item unless it is visible.
    pub fn reveal(&mut self, drawing: &Drawing, item: Item) {
        let (panel, to_screen) = self.last;
        let Some(view) = &mut self.view else { return };
        // The last area is the item itself; heads and lines come first.
        let Some(hit) = drawing.hits.iter().rev().find(|hit| hit.item == Some(item)) else { return };
        let [left, top, right, bottom] = hit.bounds;
        let middle = to_screen * pos2((left + right) / 2.0, (top + bottom) / 2.0);
        if !panel.contains(middle) {
            view.translation += panel.center() - middle;
        }
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

/// Handles the keys listed in `app::SHORTCUTS`.
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
