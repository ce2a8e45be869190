//! Panes and their arrangement.

use super::accuracy::AccuracyPane;
use crate::drawing::Drawing;
use crate::panel::{self, List, Reaction, Shown, Views};
use crate::session::Session;
use crate::view::View;
use egui::{Ui, WidgetText};
use egui_tiles::{Behavior, SimplificationOptions, Tile, TileId, Tiles, Tree, UiResponse};
use std::collections::BTreeSet;
use std::path::Path;

/// Content of a pane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Pane {
    /// View of the plan.
    View(View),
    /// Error over cost of settings.
    Accuracy,
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
    /// Returns the panes that draw a plan, a trace or an accuracy record, in the order of the tabs.
    pub fn drawn() -> impl Iterator<Item = Self> {
        let last = View::ALL.len() - 1;
        let views = |views: &'static [View]| views.iter().map(|view| Self::View(*view));
        views(&View::ALL[..last]).chain([Self::Accuracy]).chain(views(&View::ALL[last..]))
    }

    /// Returns whether the pane draws a plan.
    pub const fn is_of_a_plan(self) -> bool {
        matches!(self, Self::View(view) if view.is_of_a_plan())
    }

    /// Returns the drawing of a pane; `None` for panes that are no drawings.
    pub fn drawing(self, session: &Session) -> Option<Drawing> {
        match self {
            Self::View(view) => Some(panel::drawn(view, session.data())),
            Self::Accuracy => Some(super::accuracy::drawn(session)),
            _ => None,
        }
    }

    /// Returns the name on the tab.
    pub const fn word(self) -> &'static str {
        match self {
            Self::View(view) => view.word(),
            Self::Accuracy => "accuracy",
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
    let views = Pane::drawn().filter(|pane| *pane != Pane::View(View::Inspector));
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

/// State required to show the panes.
pub(super) struct Panes<'a> {
    pub session: &'a mut Session,
    pub list: &'a mut List,
    pub views: &'a mut Views,
    pub accuracy: &'a mut AccuracyPane,
    #[cfg(feature = "window")]
    pub live: &'a mut Option<crate::live::Live>,
    #[cfg(feature = "window")]
    pub attached: &'a mut Option<crate::attached::Attached>,
    /// Typed paths of a scene and an environment.
    #[cfg(feature = "window")]
    pub typed: &'a mut [String; 2],
}

impl Panes<'_> {
    fn view(&mut self, ui: &mut Ui, view: View) {
        if self.session.plan.is_none() && view.is_of_a_plan() {
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
        }
        match self.views.show(ui, view, self.session.data()) {
            Some(Reaction::Select(item)) => self.session.selected = item,
            Some(Reaction::Source(place)) => {
                let sources = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
                if let Err(error) = framegraph_egui::editor::open(&place, sources) {
                    self.session.say(error);
                }
            }
            None => {}
        }
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
            Pane::View(_) | Pane::Accuracy | Pane::List | Pane::WhatIf => {}
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
        let changed = questions.show(
            ui,
            Shown {
                base: base.as_deref(),
                now: now.as_deref(),
                planning,
                read_device: Some(crate::graph_source::read_device),
            },
        );
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
            Pane::Accuracy => self.accuracy.show(ui, self.session),
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
                    self.session.selected = Some(item);
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
