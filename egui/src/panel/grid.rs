//! Table of resources over passes or steps: only the visible cells are drawn, names and heads stay in place.

mod minimap;
mod rows;
#[cfg(test)]
mod tests;
mod view;

pub use rows::{Options, Row, Sort};

use super::{Clicked, paint, theme};
use crate::drawing::{Drawing, Ink, Item};
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;
use crate::view::table::{Kind, Table};
use crate::view::timeline;
use egui::emath::TSTransform;
use egui::{ComboBox, DragValue, Key, Modifiers, Pos2, Rect, Response, Sense, Ui, Vec2, pos2, vec2};
use view::GridView;

/// Maximum share of the panel for names and for heads.
const SHARE: f32 = 0.45;

/// Data of a grid.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    /// Plan.
    pub plan: &'a PlanData,
    /// Frame times.
    pub trace: Option<&'a TraceData>,
    /// Counts changes of the plan.
    pub generation: u64,
    /// Selected item and its relations.
    pub lit: &'a [Item],
}

/// Table and rows after filtering.
struct Made {
    of: (u64, Options, Option<usize>),
    table: Table,
    rows: Vec<Row>,
    lines: Vec<Option<[f32; 2]>>,
    names: f32,
    heads: f32,
}

/// Grid with its scroll position, zoom and filters.
pub struct Grid {
    kind: Kind,
    /// Filters, groups and order.
    pub options: Options,
    view: GridView,
    made: Option<Made>,
    revealed: Option<Item>,
    fits: bool,
    /// Body and origin of the last frame.
    last: (Rect, Pos2),
}

impl Grid {
    /// Creates a grid.
    pub fn new(kind: Kind) -> Self {
        let sort = if kind == Kind::Memory { Sort::Placement } else { Sort::Declared };
        Self {
            kind,
            options: Options { sort, ..Options::default() },
            view: GridView { scroll: Vec2::ZERO, cell: vec2(timeline::COLUMN, timeline::ROW) },
            made: None,
            revealed: None,
            fits: false,
            last: (Rect::NOTHING, Pos2::ZERO),
        }
    }

    /// Fits the whole table in the next frame.
    pub fn fit(&mut self) {
        self.fits = true;
    }

    /// Returns the rows of the last frame.
    pub fn rows(&self) -> &[Row] {
        self.made.as_ref().map_or(&[], |made| &made.rows)
    }

    /// Returns the last screen position of an item in the body; `None` if it is not visible.
    pub fn place_of(&self, item: Item) -> Option<Pos2> {
        let (body, origin) = self.last;
        let [column, row] = self.cell_of(item);
        let at = |index: Option<usize>, axis: usize| {
            index.map_or(body.center()[axis], |index| origin[axis] + self.view.cell[axis] * (index as f32 + 0.5))
        };
        column.or(row)?;
        Some(pos2(at(column, 0), at(row, 1))).filter(|place| body.contains(*place))
    }

    /// Returns column and row of an item.
    fn cell_of(&self, item: Item) -> [Option<usize>; 2] {
        let Some(made) = &self.made else { return [None; 2] };
        let columns = 0..made.table.len();
        match item {
            Item::Pass(pass) => [columns.into_iter().find(|c| made.table.pass(*c) == Some(pass)), None],
            Item::Step(step) => [columns.into_iter().find(|c| made.table.step(*c) == Some(step)), None],
            Item::Resource(index) => {
                let row = made.rows.iter().position(|row| *row == Row::Resource(index));
                [row.and(made.table.spans[index].map(|[first, _]| first)), row]
            }
            Item::Flow(_) => [None; 2],
        }
    }

    /// Shows order, filters and zoom.
    pub fn bar(&mut self, ui: &mut Ui) {
        let options = &mut self.options;
        let list = ComboBox::from_id_salt("order").selected_text(options.sort.word()).width(80.0).show_ui(ui, |ui| {
            for sort in Sort::ALL {
                ui.selectable_value(&mut options.sort, sort, sort.word());
            }
        });
        list.response.on_hover_text("Order of the rows");
        ui.toggle_value(&mut options.reversed, "reverse").on_hover_text("Reverse the order of the rows");
        ui.toggle_value(&mut options.grouped, "group").on_hover_text("Group resources by their names before `/`");
        ui.toggle_value(&mut options.of_pass, "of pass").on_hover_text("Show only resources of the selected pass");
        if self.kind == Kind::Timeline {
            ui.toggle_value(&mut options.raster, "raster").on_hover_text("Show only raster passes");
            ui.toggle_value(&mut options.culled, "culled").on_hover_text("Show only culled passes");
        }
        let mut cell = self.view.cell;
        let tips = ["Width of a column (Ctrl+wheel)", "Height of a row (Ctrl+Shift+wheel)"];
        for ((side, prefix), tip) in [&mut cell.x, &mut cell.y].into_iter().zip(["width ", "height "]).zip(tips) {
            ui.add(DragValue::new(side).prefix(prefix).speed(0.5).max_decimals(0)).on_hover_text(tip);
        }
        if cell != self.view.cell {
            self.view.zoom(cell, Vec2::ZERO);
        }
    }

    /// Filters the table after a change.
    fn make(&mut self, shown: Shown<'_>) {
        let pass = match shown.lit.first() {
            Some(Item::Pass(pass)) if *pass < shown.plan.form.passes.len() => Some(*pass),
            // The filter keeps its pass while one of its resources is selected.
            _ => self.made.as_ref().and_then(|made| made.of.2).filter(|_| self.options.of_pass),
        };
        let pass = pass.filter(|pass| self.options.of_pass && *pass < shown.plan.form.passes.len());
        let of = (shown.generation, self.options.clone(), pass);
        if self.made.as_ref().is_some_and(|made| made.of == of) {
            return;
        }
        let all = Table::new(shown.plan, self.kind);
        let columns = rows::columns(shown.plan, &all, &self.options);
        let table = if columns.len() == all.len() { all } else { all.with_columns(&columns) };
        let rows = rows::rows(shown.plan, &table, &self.options, pass);
        let (names, heads) = (timeline::names_width(shown.plan), table.heads_height(shown.plan));
        self.made = Some(Made { of, lines: minimap::lines(&table, &rows), table, rows, names, heads });
    }

    /// Shows the table and returns what was clicked.
    pub fn show(&mut self, ui: &mut Ui, name: &str, shown: Shown<'_>) -> Clicked {
        self.make(shown);
        let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, format!("{name} view")));
        let Some(made) = self.made.take() else { return Clicked::No };
        let rect = response.rect;
        let times = if shown.trace.is_some() && self.kind == Kind::Timeline { timeline::TIMES } else { 0.0 };
        let corner = vec2(made.names.min(SHARE * rect.width()), (made.heads + times).min(SHARE * rect.height()));
        let body = Rect::from_min_max(rect.min + corner, rect.max.max(rect.min + corner));
        let counts = [made.table.len(), made.rows.len()];
        self.navigate(ui, &response, body, counts);
        let mut clicked = self.keys(ui, &response, &made, shown.lit.first().copied(), body.size());
        let content = self.view.content(counts);
        let map = minimap::place(body, content);
        if let Some(map) = map {
            let drag = ui.interact(map, response.id.with("minimap"), Sense::click_and_drag());
            drag.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "minimap"));
            if let Some(pointer) = drag.interact_pointer_pos() {
                self.view.scroll = (pointer - map.min) / map.size() * content - 0.5 * body.size();
            }
        }
        self.made = Some(made);
        if self.revealed != shown.lit.first().copied() {
            self.revealed = shown.lit.first().copied();
            if let Some(item) = self.revealed {
                self.view.reveal(self.cell_of(item), body.size());
            }
        }
        self.view.limit(counts, body.size());
        self.last = (body, body.min - self.view.scroll);
        let drawing = self.paint(ui, &painter, shown, rect, body, times);
        if let (Some(map), Some(made)) = (map, &self.made) {
            let share = |at: Vec2| pos2(at.x / content.x.max(1.0), at.y / content.y.max(1.0));
            let seen = Rect::from_min_max(share(self.view.scroll), share(self.view.scroll + body.size()));
            minimap::paint(&painter, ui.visuals(), map, &made.lines, seen);
        }
        let at = |pos: Pos2| {
            let part = drawing.iter().find(|(clip, _)| clip.contains(pos));
            let local = pos - rect.min;
            part.and_then(|(_, drawing)| drawing.at([local.x, local.y]))
        };
        if let Some(pos) = response.interact_pointer_pos().filter(|_| response.clicked()) {
            let row = (pos.y >= body.top() && pos.x < body.left()).then(|| self.row_at(pos)).flatten();
            clicked = match row {
                Some(Row::Group(group, ..)) => {
                    if !self.options.closed.remove(&group) {
                        self.options.closed.insert(group);
                    }
                    Clicked::No
                }
                _ => at(pos).and_then(|hit| hit.item).map_or(Clicked::Empty, Clicked::Item),
            };
        }
        if let Some(hit) = response.hover_pos().and_then(at).filter(|hit| !hit.tip.is_empty()) {
            response.on_hover_text_at_pointer(&hit.tip);
        }
        clicked
    }

    fn row_at(&self, pos: Pos2) -> Option<Row> {
        let row = (pos.y - self.last.1.y) / self.view.cell.y;
        self.rows().get(row.max(0.0) as usize).cloned()
    }

    /// Scrolls and zooms.
    fn navigate(&mut self, ui: &Ui, response: &Response, body: Rect, counts: [usize; 2]) {
        if std::mem::take(&mut self.fits) {
            self.view.fit(counts, body.size());
        }
        if response.dragged() {
            self.view.scroll -= response.drag_delta();
        }
        let Some(pointer) = response.hover_pos() else { return };
        let (scroll, pinch, rows) = ui.input(|i| (i.smooth_scroll_delta(), i.zoom_delta(), i.modifiers.shift));
        self.view.scroll -= scroll;
        if pinch != 1.0 {
            let factor = if rows { vec2(1.0, pinch) } else { vec2(pinch, 1.0) };
            self.view.zoom(self.view.cell * factor, (pointer - body.min).max(Vec2::ZERO));
        }
    }

    /// Moves the selection: up and down to other resources, left and right to other passes.
    fn keys(&mut self, ui: &Ui, response: &Response, made: &Made, selected: Option<Item>, body: Vec2) -> Clicked {
        if !response.hovered() || ui.ctx().memory(|memory| memory.focused().is_some()) {
            return Clicked::No;
        }
        let pressed = |key: Key| ui.input_mut(|i| i.consume_key(Modifiers::NONE, key));
        if pressed(Key::F) {
            self.fits = true;
            ui.ctx().request_repaint();
        }
        for (key, factor) in [(Key::Plus, 1.25), (Key::Equals, 1.25), (Key::Minus, 0.8)] {
            if pressed(key) {
                self.view.zoom(self.view.cell * vec2(factor, 1.0), 0.5 * body);
            }
        }
        let resources: Vec<usize> =
            made.rows.iter().filter_map(|row| if let Row::Resource(r) = row { Some(*r) } else { None }).collect();
        let row = match selected {
            Some(Item::Resource(index)) => resources.iter().position(|r| *r == index),
            _ => None,
        };
        let page = (body.y / self.view.cell.y).max(1.0) as i64;
        let moves = [
            (Key::ArrowUp, -1),
            (Key::ArrowDown, 1),
            (Key::PageUp, -page),
            (Key::PageDown, page),
            (Key::Home, i64::MIN / 2),
            (Key::End, i64::MAX / 2),
        ];
        for (key, by) in moves {
            if pressed(key) && !resources.is_empty() {
                let last = resources.len() - 1;
                let begin = if key == Key::End { last } else { 0 };
                let next = row.map_or(begin, |row| (row as i64 + by).clamp(0, last as i64) as usize);
                return Clicked::Item(Item::Resource(resources[next]));
            }
        }
        for (key, by) in [(Key::ArrowLeft, -1), (Key::ArrowRight, 1)] {
            if pressed(key) && !made.table.is_empty() {
                let column = selected.and_then(|item| {
                    let is = |column: &usize| match item {
                        Item::Pass(pass) => made.table.pass(*column) == Some(pass),
                        Item::Resource(index) => made.table.spans[index].is_some_and(|[first, _]| first == *column),
                        _ => false,
                    };
                    (0..made.table.len()).find(is)
                });
                let next = column.map_or(0, |c| (c as i64 + by).clamp(0, made.table.len() as i64 - 1) as usize);
                return made.table.pass(next).map_or(Clicked::No, |pass| Clicked::Item(Item::Pass(pass)));
            }
        }
        Clicked::No
    }

    /// Paints the visible cells; returns the parts with their clip rectangles.
    fn paint(
        &self,
        ui: &Ui,
        painter: &egui::Painter,
        shown: Shown<'_>,
        rect: Rect,
        body: Rect,
        times: f32,
    ) -> [(Rect, Drawing); 3] {
        let mut parts = [Drawing::default(), Drawing::default(), Drawing::default()];
        let [cells, names, heads] = &mut parts;
        let corner = body.min - rect.min;
        let (from, cell) = (corner - self.view.scroll, self.view.cell);
        if let Some(made) = &self.made {
            let (table, size) = (&made.table, body.size());
            let columns = self.view.visible(0, table.len(), size);
            let visible = self.view.visible(1, made.rows.len(), size);
            table.heads(shown.plan, columns.clone(), heads, [from.x, corner.y - times], cell.x);
            if let Some(trace) = shown.trace.filter(|_| times > 0.0) {
                let at = [from.x, corner.y - times];
                timeline::times(shown.plan, table, columns.clone(), trace, heads, at, cell.x);
                for (line, side) in timeline::SIDES.into_iter().enumerate() {
                    let y = corner.y - times + timeline::ROW * (line as f32 + 0.5);
                    names.text([4.0, y], 11.0, Ink::Faint, format!("{side}, median"));
                }
            }
            for row in visible {
                let y = from.y + cell.y * row as f32;
                cells.line(vec![[corner.x, y], [rect.width(), y]], Ink::Grid, 1.0);
                match &made.rows[row] {
                    Row::Group(group, count, open) => {
                        let bounds = [0.0, y, corner.x, y + cell.y];
                        names.rect(bounds, Ink::Step, None);
                        let sign = if *open { "-" } else { "+" };
                        let size = (0.72 * cell.y).min(12.0);
                        names.text([4.0, y + 0.5 * cell.y], size, Ink::Text, format!("{sign} {group}/ ({count})"));
                        names.hit(bounds, None, "Open or close the group");
                    }
                    Row::Resource(index) => {
                        let bounds = [4.0, y, corner.x, y + cell.y];
                        timeline::name(shown.plan, self.kind, *index, names, bounds);
                        let at = [from.x, y];
                        timeline::row(shown.plan, table, *index, columns.clone(), cells, at, [cell.x, cell.y]);
                    }
                }
            }
        }
        let theme = theme(ui);
        let to_screen = TSTransform::from_translation(rect.min.to_vec2());
        // Names of columns are slanted and reach over the left end of the body.
        let clips = [
            body,
            Rect::from_min_max(pos2(rect.left(), body.top() - times), pos2(body.left(), rect.bottom())),
            Rect::from_min_max(pos2(body.left(), rect.top()), pos2(rect.right(), body.top())),
        ];
        let mut out = clips.into_iter().zip(parts);
        let parts = [(); 3].map(|()| out.next().unwrap_or((Rect::NOTHING, Drawing::default())));
        for (clip, drawing) in &parts {
            let painter = painter.with_clip_rect(clip.intersect(painter.clip_rect()));
            paint::paint(&painter, drawing, to_screen, theme, shown.lit);
            paint::frame(&painter, drawing, to_screen, theme, shown.lit);
        }
        parts
    }
}
