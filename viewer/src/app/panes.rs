//! Panes and their arrangement.

use super::drawings::Drawings;
use super::strip::Strip;
use crate::drawing::Item;
use crate::panel::grid::Grid;
use crate::panel::{self, Canvas, Clicked, List, Shown};
use crate::plan_data::PlanData;
use crate::session::Session;
use crate::view::table::Kind;
use crate::view::{self, View};
use egui::{Ui, WidgetText};
use egui_tiles::{Behavior, SimplificationOptions, Tile, TileId, Tiles, Tree, UiResponse};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Content of a pane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Pane {
    /// View of the plan.
    View(View),
    /// Search.
    List,
    /// The what-if panel.
    WhatIf,
    /// Live frame.
    Viewport,
    /// Settings of the live frame.
    Settings,
    /// Effects of the live frame and the decisions of feature culling.
    Effects,
    /// Camera and light.
    Lens,
    /// Scene.
    Scene,
    /// Debug modes and budgets.
    Debugging,
    /// Contents of a texture.
    Preview,
}

impl Pane {
    /// Returns the name on the tab.
    pub const fn word(self) -> &'static str {
        match self {
            Self::View(view) => view.word(),
            Self::List => "search",
            Self::WhatIf => "what-if",
            Self::Viewport => "viewport",
            Self::Settings => "settings",
            Self::Effects => "effects",
            Self::Lens => "camera",
            Self::Scene => "scene",
            Self::Debugging => "debug",
            Self::Preview => "texture",
        }
    }
}

/// Returns the default arrangement.
///
/// Search and what-if are on the left, views as tabs in the center, the inspector on the right. With a live frame, its
/// settings are on the left, the frame is in the center, and the views are on the right, above the inspector.
pub(super) fn arranged(live: bool) -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let views = View::ALL.into_iter().filter(|view| *view != View::Inspector).map(Pane::View);
    let drawn = |panes: &[Pane]| if live { panes.to_vec() } else { Vec::new() };
    let mut tabs = |panes: Vec<Pane>| {
        let panes = panes.into_iter().map(|pane| tiles.insert_pane(pane)).collect();
        tiles.insert_tab_tile(panes)
    };
    let set = [Pane::Settings, Pane::Effects, Pane::Lens, Pane::Scene, Pane::Debugging];
    let asked = [Pane::List, Pane::WhatIf];
    let left = tabs(if live { set.to_vec() } else { asked.to_vec() });
    let middle = tabs(views.collect());
    let beside = drawn(&[Pane::Preview, asked[0], asked[1]]);
    let inspector = tabs([Pane::View(View::Inspector)].into_iter().chain(beside).collect());
    let columns = if live {
        let viewport = tabs(vec![Pane::Viewport]);
        let stacked = tiles.insert_vertical_tile(vec![middle, inspector]);
        vec![(left, 1.1), (viewport, 1.9), (stacked, 1.9)]
    } else {
        vec![(left, 0.98), (middle, 2.6), (inspector, 1.0)]
    };
    let tiles_of = columns.iter().map(|(tile, _)| *tile).collect();
    let mut row = egui_tiles::Linear::new(egui_tiles::LinearDir::Horizontal, tiles_of);
    for (tile, share) in columns {
        row.shares.set_share(tile, share);
    }
    let root = tiles.insert_container(row);
    Tree::new(egui::Id::unique("panes"), root, tiles)
}

/// Returns all panes of an arrangement.
fn panes_of(tree: &Tree<Pane>) -> Vec<Pane> {
    let of = tree.tiles.tiles().filter_map(|tile| match tile {
        Tile::Pane(pane) => Some(*pane),
        Tile::Container(_) => None,
    });
    of.collect()
}

/// Returns all panes in one container of tabs.
pub(super) fn in_tabs(live: bool) -> Tree<Pane> {
    Tree::new_tabs(egui::Id::unique("panes"), panes_of(&arranged(live)))
}

/// Adds the texture viewer to the tabs of the inspector if it is missing, for an attached engine.
#[cfg(feature = "window")]
pub(super) fn add_textures(tree: &mut Tree<Pane>) {
    let of = |tree: &Tree<Pane>, pane| tree.tiles.find_pane(&pane);
    if of(tree, Pane::Preview).is_none()
        && let Some(tabs) = of(tree, Pane::View(View::Inspector)).and_then(|tile| tree.tiles.parent_of(tile))
    {
        let tile = tree.tiles.insert_pane(Pane::Preview);
        tree.move_tile_to_container(tile, tabs, usize::MAX, false);
    }
}

/// Returns whether an arrangement contains every pane once. The texture viewer of an attached engine is optional.
pub(super) fn is_whole(tree: &Tree<Pane>, live: bool) -> bool {
    let (mut found, all) = (panes_of(tree), panes_of(&arranged(live)));
    found.retain(|pane| live || *pane != Pane::Preview);
    found.len() == all.len() && found.into_iter().collect::<BTreeSet<_>>() == all.into_iter().collect()
}

/// Tables of the timeline and of memory.
pub(super) struct Grids {
    timeline: Grid,
    memory: Grid,
    /// Shows memory as a map of offsets instead of a table.
    map: bool,
}

impl Default for Grids {
    fn default() -> Self {
        Self { timeline: Grid::new(Kind::Timeline), memory: Grid::new(Kind::Memory), map: true }
    }
}

impl Grids {
    /// Returns the table that a view shows; `None` if it shows a drawing.
    pub fn of(&self, view: View) -> Option<&Grid> {
        match view {
            View::Timeline => Some(&self.timeline),
            View::Memory if !self.map => Some(&self.memory),
            _ => None,
        }
    }
}

/// State required to show the panes.
pub(super) struct Panes<'a> {
    pub session: &'a mut Session,
    pub list: &'a mut List,
    pub canvases: &'a mut BTreeMap<View, Canvas>,
    pub grids: &'a mut Grids,
    pub drawings: &'a mut Drawings,
    pub strip: &'a mut Strip,
    #[cfg(feature = "window")]
    pub live: &'a mut Option<crate::live::Live>,
    #[cfg(feature = "window")]
    pub attached: &'a mut Option<crate::attached::Attached>,
    /// Typed paths of a scene and an environment.
    #[cfg(feature = "window")]
    pub typed: &'a mut [String; 2],
}

impl Panes<'_> {
    fn select(&mut self, item: Option<Item>) {
        self.session.selected = item;
    }

    fn view(&mut self, ui: &mut Ui, view: View) {
        let plan = self.session.plan.clone();
        let Some(plan) = plan.or_else(|| (!view.is_of_a_plan()).then(Arc::default)) else {
            #[cfg(feature = "window")]
            let waits = self.live.is_some();
            #[cfg(not(feature = "window"))]
            let waits = false;
            let text = if waits {
                "The plan appears when the scene is loaded"
            } else {
                "Open a plan (JSON) or a graph (RON): type its path above, or drop it here"
            };
            ui.centered_and_justified(|ui| ui.label(text));
            return;
        };
        if view == View::Inspector {
            let sections = view::inspector::sections(&plan, self.session.selected);
            match panel::inspector(ui, &sections) {
                Some(panel::Link::Item(item)) => self.select(Some(item)),
                Some(panel::Link::Source(place)) => {
                    if let Err(error) = crate::editor::open(&place) {
                        self.session.say(error);
                    }
                }
                None => {}
            }
            return;
        }
        if self.table(ui, view, &plan) {
            return;
        }
        let ctx = ui.ctx().clone();
        let Some(drawing) = self.drawings.get(view, self.session, move || ctx.request_repaint()) else {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label(format!("drawing the {}", view.word()));
            });
            return;
        };
        ui.horizontal(|ui| {
            let canvas = self.canvases.entry(view).or_default();
            if ui.small_button("Fit").on_hover_text("Show the whole view (F)").clicked() {
                canvas.fit();
            }
            if ui.small_button("Copy").on_hover_text("Copy the view as text").clicked() {
                ui.ctx().copy_text(drawing.words());
            }
            if ui.small_button("SVG").on_hover_text("Copy the view as an SVG document").clicked() {
                ui.ctx().copy_text(crate::drawing::svg(drawing, panel::theme(ui)));
            }
            if view == View::Accuracy
                && let Some(data) = self.session.accuracy.clone()
            {
                if let Some([fastest, finest]) = data.span_ms() {
                    let mut budget_ms = self.session.budget_ms;
                    let slider = egui::Slider::new(&mut budget_ms, fastest..=finest).suffix(" ms").text("time budget");
                    ui.add(slider)
                        .on_hover_text("Choose the most accurate frame within this time, as `render --budget-ms` does");
                    self.session.allow_ms(budget_ms);
                }
                self.strip.choose(ui, &data);
            }
        });
        if view == View::Accuracy {
            self.strip.show(ui);
        }
        let lit = self.session.lit();
        let canvas = self.canvases.entry(view).or_default();
        match canvas.show(ui, view.word(), drawing, &lit) {
            Clicked::No => {}
            Clicked::Empty => self.session.selected = None,
            Clicked::Item(item) => self.session.selected = Some(item),
        }
    }

    /// Shows a view as a table; returns false for views that are drawings.
    fn table(&mut self, ui: &mut Ui, view: View, plan: &PlanData) -> bool {
        if view == View::Memory {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.grids.map, true, "map").on_hover_text("Offsets over steps");
                let tip = "Resources with their sizes and offsets over steps";
                ui.selectable_value(&mut self.grids.map, false, "table").on_hover_text(tip);
            });
        }
        let grid = match view {
            View::Timeline => &mut self.grids.timeline,
            View::Memory if !self.grids.map => &mut self.grids.memory,
            _ => return false,
        };
        let trace = self.session.trace.as_deref();
        ui.horizontal_wrapped(|ui| {
            if ui.small_button("Fit").on_hover_text("Show the whole view (F)").clicked() {
                grid.fit();
            }
            let copies = [("Copy", "Copy the view as text"), ("SVG", "Copy the view as an SVG document")];
            for (name, tip) in copies {
                if ui.small_button(name).on_hover_text(tip).clicked() {
                    let drawing = super::drawings::drawn(view, self.session);
                    let text = match name {
                        "SVG" => crate::drawing::svg(&drawing, panel::theme(ui)),
                        _ => drawing.words(),
                    };
                    ui.ctx().copy_text(text);
                }
            }
            grid.bar(ui);
            if view == View::Timeline {
                ui.label("Legend").on_hover_text(view::timeline::LEGEND);
            }
        });
        if let Some(other) = trace.and_then(|trace| trace.mismatch(plan)).filter(|_| view == View::Timeline) {
            ui.add(egui::Label::new(other).wrap());
        }
        let (generation, lit) = (self.session.generation(), self.session.lit());
        let shown = panel::grid::Shown { plan, trace, generation, lit: &lit };
        match grid.show(ui, view.word(), shown) {
            Clicked::No => {}
            Clicked::Empty => self.session.selected = None,
            Clicked::Item(item) => self.session.selected = Some(item),
        }
        true
    }

    /// Shows a pane of the live frame.
    #[cfg(feature = "window")]
    fn drawn(&mut self, ui: &mut Ui, pane: Pane) {
        use crate::live::panel as live;
        let [scene, light] = &mut *self.typed;
        let Some(drawn) = &mut *self.live else {
            match self.attached {
                Some(attached) => live::remote_preview(ui, attached, self.session),
                None => _ = ui.label("Attach to an engine to see its textures"),
            }
            return;
        };
        match pane {
            Pane::Viewport => live::viewport(ui, drawn, self.session),
            Pane::Settings => live::settings(ui, drawn),
            Pane::Effects => live::effects(ui, drawn),
            Pane::Lens => live::lens(ui, drawn, light),
            Pane::Scene => live::scene(ui, drawn, scene, self.session),
            Pane::Debugging => live::debugging(ui, drawn, self.session),
            Pane::Preview => live::preview(ui, drawn, self.session),
            Pane::View(_) | Pane::List | Pane::WhatIf => {}
        }
    }

    /// Live frames require the feature `window`.
    #[cfg(not(feature = "window"))]
    fn drawn(&mut self, _: &mut Ui, _: Pane) {}

    fn questions(&mut self, ui: &mut Ui) {
        let planning = self.session.doing().is_some();
        let (base, now) = (self.session.base(), self.session.plan.clone());
        let Some(mut questions) = self.session.questions.take() else {
            ui.label("A saved plan contains no graph. Open the graph (FRAME.ron) to try other conditions.");
            return;
        };
        let changed = questions.show(ui, Shown { base: base.as_deref(), now: now.as_deref(), planning });
        self.session.questions = Some(questions);
        if changed {
            self.session.ask();
        }
    }
}

impl Behavior<Pane> for Panes<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut Pane) -> UiResponse {
        let pane = *pane;
        egui::Frame::new().inner_margin(6.0).show(ui, |ui| match pane {
            Pane::View(view) => self.view(ui, view),
            Pane::Viewport
            | Pane::Settings
            | Pane::Effects
            | Pane::Lens
            | Pane::Scene
            | Pane::Debugging
            | Pane::Preview => self.drawn(ui, pane),
            Pane::WhatIf => self.questions(ui),
            Pane::List => {
                if let Some(plan) = self.session.plan.clone()
                    && let Some(item) = self.list.show(ui, &plan, self.session.selected)
                {
                    self.select(Some(item));
                }
            }
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.word().into()
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }
}
