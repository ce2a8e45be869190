//! The application: panes in tiles that show one [`Session`].

mod accuracy;
#[cfg(feature = "window")]
mod attaching;
#[cfg(feature = "window")]
mod chosen;
#[cfg(feature = "window")]
pub mod dialog;
#[cfg(feature = "window")]
mod export;
mod panes;
mod shortcuts;

pub use crate::session::{Role, Session};
pub use panes::Pane;
pub use shortcuts::SHORTCUTS;

use crate::drawing::Item;
use crate::panel::{self, List, Views};
use crate::view::{self, View};
use egui::{Context, Panel, RichText, Ui};
use egui_tiles::Tree;

/// The application without its window, which an engine can embed in its own egui UI.
pub struct Viewer {
    /// Displayed data.
    pub session: Session,
    /// Arrangement of the panes.
    tiles: Tree<Pane>,
    /// Search pane.
    list: List,
    /// Views of plans.
    views: Views,
    /// Document to which zoom and search belong.
    document: u64,
    /// Accuracy view.
    accuracy: accuracy::AccuracyPane,
    /// Live frame.
    #[cfg(feature = "window")]
    pub live: Option<crate::live::Live>,
    /// Attached engine.
    #[cfg(feature = "window")]
    pub attached: Option<crate::attached::Attached>,
    /// Typed address of an engine.
    #[cfg(feature = "window")]
    address: String,
    /// File dialog.
    #[cfg(feature = "window")]
    dialog: dialog::Dialog,
    /// Typed paths of a scene, an environment, and an export file.
    #[cfg(feature = "window")]
    typed: ([String; 2], String),
    /// Recently opened files, newest first.
    pub recent: Vec<std::path::PathBuf>,
    /// Typed path of the file to open or to compare with.
    path: String,
    /// Focuses the field of the path in the next frame.
    focus_path: bool,
    /// Shows the list of shortcuts.
    help: bool,
}

impl Viewer {
    /// Creates a viewer of a session.
    pub fn new(session: Session) -> Self {
        Self {
            session,
            tiles: panes::arranged(false),
            list: List::default(),
            views: Views::default(),
            document: 0,
            accuracy: accuracy::AccuracyPane::default(),
            #[cfg(feature = "window")]
            live: None,
            #[cfg(feature = "window")]
            attached: None,
            #[cfg(feature = "window")]
            address: framegraph_wgpu::remote::DEFAULT_ADDRESS.into(),
            #[cfg(feature = "window")]
            dialog: dialog::Dialog::default(),
            #[cfg(feature = "window")]
            typed: Default::default(),
            recent: Vec::new(),
            path: String::new(),
            focus_path: false,
            help: false,
        }
    }

    /// Creates a viewer of a session with a live frame.
    #[cfg(feature = "window")]
    pub fn with(session: Session, live: crate::live::Live) -> Self {
        Self { live: Some(live), tiles: panes::arranged(true), ..Self::new(session) }
    }

    /// Returns whether a live frame is shown.
    pub fn is_live(&self) -> bool {
        #[cfg(feature = "window")]
        return self.live.is_some();
        #[cfg(not(feature = "window"))]
        false
    }

    /// Shows all panels.
    ///
    /// The background of `ui` should have the color that [`panel::dress`] sets. Only changes are recomputed.
    pub fn show(&mut self, ui: &mut Ui) {
        self.session.poll();
        // The next plan of an engine would replace the plan of the file.
        #[cfg(feature = "window")]
        if self.session.documents() != self.document {
            self.detach();
        }
        #[cfg(feature = "window")]
        if let Some(live) = &mut self.live {
            live.tick(&mut self.session, ui.input(|i| i.stable_dt));
        }
        #[cfg(feature = "window")]
        if let Some(attached) = &mut self.attached {
            attached.poll(&mut self.session);
        }
        self.refresh();
        self.dropped(ui.ctx());
        #[cfg(feature = "window")]
        self.dialogs(ui);
        for action in shortcuts::actions(ui.ctx()) {
            self.act(action);
        }
        Panel::top("bar").show(ui, |ui| self.bar(ui));
        if !self.session.messages.is_empty() || self.session.notice.is_some() {
            Panel::top("messages").show(ui, |ui| self.messages(ui));
        }
        let Self { session, tiles, list, views, accuracy, .. } = self;
        let mut behavior = panes::Panes {
            session,
            list,
            views,
            accuracy,
            #[cfg(feature = "window")]
            live: &mut self.live,
            #[cfg(feature = "window")]
            attached: &mut self.attached,
            #[cfg(feature = "window")]
            typed: &mut self.typed.0,
        };
        // The background has the window's color already. Filling it again dominates the time of a software driver.
        let frame = egui::Frame::central_panel(ui.style()).fill(egui::Color32::TRANSPARENT);
        egui::CentralPanel::default().frame(frame).show(ui, |ui| tiles.ui(&mut behavior, ui));
        if self.help {
            self.help = shortcuts::list(ui.ctx());
        }
        // A frame without a visible viewport is drawn too, because all views show its plan.
        #[cfg(feature = "window")]
        if let Some(live) = &mut self.live
            && live.draw_hidden(&mut self.session)
        {
            ui.ctx().request_repaint_after(live.next_frame());
        }
    }

    /// Brings a pane to the front of its tabs.
    pub fn turn_to(&mut self, pane: Pane) {
        self.tiles.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(this) if *this == pane));
    }

    /// Selects an item. All views pan to it.
    pub fn select(&mut self, item: Option<Item>) {
        self.session.selected = item;
    }

    /// Returns the screen position of an item in a view; `None` if it is not visible.
    pub fn place_of(&self, view: View, item: Item) -> Option<egui::Pos2> {
        self.views.place_of(view, item)
    }

    /// Returns the arrangement of the panes as text for [`Viewer::arrange`].
    pub fn arrangement(&self) -> Option<String> {
        serde_json::to_string(&self.tiles).ok()
    }

    /// Arranges all panes in one container of tabs.
    pub fn arrange_all_in_tabs(&mut self) {
        self.tiles = panes::in_tabs(self.is_live());
    }

    /// Restores an arrangement of the panes. Invalid text changes nothing.
    pub fn arrange(&mut self, text: &str) {
        if let Ok(tiles) = serde_json::from_str::<Tree<Pane>>(text)
            && panes::is_whole(&tiles, self.is_live())
        {
            self.tiles = tiles;
        }
    }

    /// Resets zoom and search after another file was opened.
    fn refresh(&mut self) {
        if std::mem::replace(&mut self.document, self.session.documents()) != self.session.documents() {
            self.views.reset();
            self.accuracy.reset();
            self.list.search.clear();
        }
    }

    /// Executes the action of a shortcut.
    fn act(&mut self, action: shortcuts::Action) {
        match action {
            shortcuts::Action::Search => {
                self.turn_to(Pane::List);
                self.list.focus = true;
            }
            shortcuts::Action::Pane(pane) => self.turn_to(pane),
            shortcuts::Action::Help => self.help = !self.help,
            #[cfg(feature = "window")]
            shortcuts::Action::Undo | shortcuts::Action::Redo => {
                if let Some(live) = &mut self.live {
                    let undo = action == shortcuts::Action::Undo;
                    let moved = if undo { live.history.undo() } else { live.history.redo() };
                    if moved {
                        live.again();
                    }
                }
            }
            #[cfg(not(feature = "window"))]
            shortcuts::Action::Undo | shortcuts::Action::Redo => {}
            shortcuts::Action::Clear => (self.help, self.session.selected) = (false, None),
        }
    }

    /// Opens files dropped onto the window.
    fn dropped(&mut self, ctx: &Context) {
        let paths: Vec<std::path::PathBuf> =
            ctx.input(|i| i.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        for path in paths {
            self.open(&path, Role::Shown);
        }
    }

    /// Opens a file of any supported kind. Scenes, environments and settings go to the live frame.
    pub fn open(&mut self, path: &std::path::Path, role: Role) {
        crate::remembered::add_recent(&mut self.recent, path);
        #[cfg(feature = "window")]
        if let Some(live) = &mut self.live
            && role == Role::Shown
            && live.open(path, &mut self.session)
        {
            return;
        }
        self.session.open(path, role);
    }

    fn bar(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new("viewer").strong());
            let hint = "PLAN.json, FRAME.ron or TRACE.json";
            let edit = ui.add(egui::TextEdit::singleline(&mut self.path).hint_text(hint).desired_width(220.0));
            if std::mem::take(&mut self.focus_path) {
                edit.request_focus();
            }
            let enter = edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let tip = "Open the file. Files can also be dropped onto the window";
            let open = ui.button("Open").on_hover_text(tip).clicked() || enter;
            let tip = "Open the file as the plan to compare with";
            let against = ui.button("Compare with").on_hover_text(tip).clicked();
            if (open || against) && !self.path.trim().is_empty() {
                let path = std::path::PathBuf::from(self.path.trim());
                self.open(&path, if against { Role::Against } else { Role::Shown });
            }
            #[cfg(feature = "window")]
            for (name, role) in [("Open…", Role::Shown), ("Compare with…", Role::Against)] {
                self.ask_button(ui, name, dialog::Purpose::Open(role));
            }
            ui.add_enabled_ui(!self.recent.is_empty(), |ui| {
                let chosen = ui.menu_button("Recent", |ui| {
                    let mut shown = |path: &std::path::PathBuf| ui.button(path.display().to_string()).clicked();
                    self.recent.iter().filter(|path| shown(path)).last().cloned()
                });
                if let Some(path) = chosen.inner.flatten() {
                    self.open(&path, Role::Shown);
                }
            });
            if self.session.has_against() && ui.button("Stop comparing").clicked() {
                self.session.forget_against();
            }
            #[cfg(feature = "window")]
            self.export_menu(ui);
            #[cfg(feature = "window")]
            self.attach_menu(ui);
            ui.separator();
            if let Some(doing) = self.session.doing().map(str::to_owned) {
                match self.session.progress() {
                    Some(progress) => {
                        ui.add(egui::ProgressBar::new(progress).desired_width(90.0).show_percentage());
                    }
                    None => _ = ui.spinner(),
                }
                ui.label(doing);
                if ui.button("Cancel").clicked() {
                    self.session.cancel();
                }
            } else if let Some(plan) = &self.session.plan {
                let totals = plan.form.totals;
                for (count, words, word) in [
                    (totals.passes, "passes", "pass"),
                    (totals.culled, "culled", "culled"),
                    (totals.steps, "steps", "step"),
                    (totals.unresolves, "loads", "load"),
                    (totals.resolves, "stores", "store"),
                ] {
                    panel::term(ui, format!("{count} {words}"), word);
                }
                panel::term(ui, format!("{} memory", view::bytes(totals.heap_bytes)), "alias");
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("?").on_hover_text("Keyboard shortcuts").clicked() {
                    self.help = !self.help;
                }
                let dark = ui.visuals().dark_mode;
                if ui.button(if dark { "light" } else { "dark" }).on_hover_text("Change the theme (Ctrl+D)").clicked() {
                    ui.ctx().set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
                }
            });
        });
    }

    fn messages(&mut self, ui: &mut Ui) {
        let mut closed = None;
        for (index, message) in self.session.messages.iter().enumerate() {
            ui.horizontal_top(|ui| {
                if ui.small_button("Close").clicked() {
                    closed = Some(index);
                }
                if ui.small_button("Copy").clicked() {
                    ui.ctx().copy_text(message.clone());
                }
                let text = RichText::new(message).color(ui.visuals().error_fg_color);
                ui.add(egui::Label::new(text).wrap());
            });
        }
        if let Some(index) = closed {
            self.session.messages.remove(index);
        }
        if let Some(notice) = self.session.notice.clone() {
            ui.horizontal_top(|ui| {
                if ui.small_button("Close").clicked() {
                    self.session.notice = None;
                }
                ui.add(egui::Label::new(notice).wrap());
            });
        }
    }
}
