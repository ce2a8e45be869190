//! All views of a plan with their zoom, scroll positions and cached drawings.

use super::canvas::{Canvas, Clicked};
use super::drawings::{Drawings, drawn};
use super::grid::{self, Grid};
use super::inspector::{Link, inspector};
use super::theme;
use super::view_data::ViewData;
use crate::drawing::{Item, svg};
use crate::plan_data::PlanData;
use crate::view::table::Kind;
use crate::view::{self, View};
use egui::{Label, Pos2, Ui};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Request of the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// Select an item, or nothing.
    Select(Option<Item>),
    /// Open a source location, `PATH:LINE`.
    Source(String),
}

/// State of all views.
pub struct Views {
    /// Pan and zoom of each drawing.
    canvases: BTreeMap<View, Canvas>,
    timeline: Grid,
    memory: Grid,
    /// Shows memory as a map of offsets instead of a table.
    map: bool,
    drawings: Drawings,
}

impl Default for Views {
    fn default() -> Self {
        Self {
            canvases: BTreeMap::new(),
            timeline: Grid::new(Kind::Timeline),
            memory: Grid::new(Kind::Memory),
            map: true,
            drawings: Drawings::default(),
        }
    }
}

impl Views {
    /// Resets zoom, scroll positions and filters, as for another document.
    pub fn reset(&mut self) {
        let drawings = std::mem::take(&mut self.drawings);
        *self = Self { drawings, ..Self::default() };
    }

    /// Returns the screen position of an item in a view in the last frame; `None` if it is not visible.
    pub fn place_of(&self, view: View, item: Item) -> Option<Pos2> {
        match view {
            View::Timeline => self.timeline.place_of(item),
            View::Memory if !self.map => self.memory.place_of(item),
            _ => self.canvases.get(&view)?.place_of(self.drawings.existing(view)?, item),
        }
    }

    /// Shows a view. Returns the user's request: an item to select, or a source location to open.
    ///
    /// Without a plan, every view but the trace shows nothing.
    pub fn show(&mut self, ui: &mut Ui, view: View, data: ViewData<'_>) -> Option<Reaction> {
        self.drawings.refresh(data);
        let empty = Arc::default();
        let plan = data.plan.or((!view.is_of_a_plan()).then_some(&empty))?;
        if view == View::Inspector {
            let sections = view::inspector::sections(plan, data.selected);
            return inspector(ui, &sections).map(|link| match link {
                Link::Item(item) => Reaction::Select(Some(item)),
                Link::Source(place) => Reaction::Source(place),
            });
        }
        if view == View::Memory {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.map, true, "map").on_hover_text("Offsets over steps");
                let tip = "Resources with their sizes and offsets over steps";
                ui.selectable_value(&mut self.map, false, "table").on_hover_text(tip);
            });
        }
        let clicked = match view {
            View::Timeline => table(&mut self.timeline, ui, view, plan, data),
            View::Memory if !self.map => table(&mut self.memory, ui, view, plan, data),
            _ => self.canvas(ui, view, data),
        };
        match clicked {
            Clicked::No => None,
            Clicked::Empty => Some(Reaction::Select(None)),
            Clicked::Item(item) => Some(Reaction::Select(Some(item))),
        }
    }

    /// Shows a view as a drawing.
    fn canvas(&mut self, ui: &mut Ui, view: View, data: ViewData<'_>) -> Clicked {
        let ctx = ui.ctx().clone();
        let Some(drawing) = self.drawings.get(view, data, move || ctx.request_repaint()) else {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label(format!("drawing the {}", view.word()));
            });
            return Clicked::No;
        };
        let canvas = self.canvases.entry(view).or_default();
        ui.horizontal(|ui| canvas.bar(ui, drawing));
        canvas.show(ui, view.word(), drawing, &data.lit())
    }
}

/// Shows a view as a table.
fn table(grid: &mut Grid, ui: &mut Ui, view: View, plan: &PlanData, data: ViewData<'_>) -> Clicked {
    let trace = data.trace.map(|trace| &**trace);
    ui.horizontal_wrapped(|ui| {
        if ui.small_button("Fit").on_hover_text("Show the whole view (F)").clicked() {
            grid.fit();
        }
        for (name, tip) in [("Copy", "Copy the view as text"), ("SVG", "Copy the view as an SVG document")] {
            if ui.small_button(name).on_hover_text(tip).clicked() {
                let drawing = drawn(view, data);
                ui.ctx().copy_text(if name == "SVG" { svg(&drawing, theme(ui)) } else { drawing.words() });
            }
        }
        grid.bar(ui);
        if view == View::Timeline {
            ui.label("Legend").on_hover_text(view::timeline::LEGEND);
        }
    });
    if let Some(other) = trace.and_then(|trace| trace.mismatch(plan)).filter(|_| view == View::Timeline) {
        ui.add(Label::new(other).wrap());
    }
    grid.show(ui, view.word(), grid::Shown { plan, trace, generation: data.generation, lit: &data.lit() })
}
