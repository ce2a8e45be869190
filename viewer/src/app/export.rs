//! Export of views, plans and frame times to files.

use super::Viewer;
use super::dialog::Purpose;
use super::panes::Pane;
use crate::drawing::{Drawing, Theme, svg};
use crate::offscreen::{Offscreen, own_size_px};
use crate::plan_data::PlanData;
use crate::view::View;
use egui::{TextEdit, Ui};
use framegraph::dump;
use framegraph::file::to_ron;
use program::outputs::Outputs;
use std::path::{Path, PathBuf};

/// Pixels per point in a PNG export.
const SCALE: f32 = 2.0;

/// Writes a file whose kind depends on its extension.
///
/// A view becomes `.svg`, `.png` or `.txt`, the plan `.json`, `.dot` or `.mmd`, and its graph `.ron`.
///
/// # Errors
/// One line that names the file.
pub(super) fn write(
    path: &Path,
    drawing: Option<&Drawing>,
    plan: Option<&PlanData>,
    theme: Theme,
    read: &[PathBuf],
) -> Result<(), String> {
    let shown = path.display();
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let drawing = || drawing.ok_or_else(|| format!("{shown}: nothing to export; open a plan"));
    let live = || {
        plan.and_then(|plan| plan.plan.as_deref())
            .ok_or_else(|| format!("{shown}: a saved plan cannot be exported; open its graph"))
    };
    let name = || plan.map_or("", |plan| plan.form.name.as_str());
    let bytes = match ending.as_str() {
        "svg" => svg(drawing()?, theme).into_bytes(),
        "txt" => drawing()?.words().into_bytes(),
        "png" => png(drawing()?, theme)?,
        "json" => dump::json(live()?, name()).into_bytes(),
        "ron" => to_ron(live()?.graph(), name(), live()?.frame()).into_bytes(),
        "dot" => dump::dot(live()?).into_bytes(),
        "mmd" => dump::mermaid(live()?).into_bytes(),
        _ => {
            return Err(format!(
                "{shown}: unknown extension; use svg, png or txt for a view, json, ron, dot or mmd for the plan"
            ));
        }
    };
    Outputs::one_beside(path, &bytes, read).map_err(|error| error.to_string())
}

/// Draws on a separate device, so that the window is not disturbed.
fn png(drawing: &Drawing, theme: Theme) -> Result<Vec<u8>, String> {
    let mut screen = Offscreen::open()?;
    let size = own_size_px(drawing, SCALE);
    let rgba = screen.drawing(drawing, size, SCALE, theme, &[])?;
    let mut bytes = Vec::new();
    framegraph_scene::picture::encode_png(&mut bytes, size, &rgba).map_err(|e| e.to_string())?;
    Ok(bytes)
}

impl Viewer {
    /// Shows the export menu: a file name and a button for each view.
    pub(super) fn export_menu(&mut self, ui: &mut Ui) {
        let theme = crate::panel::theme(ui);
        ui.menu_button("Export", |ui| {
            ui.label("A view as .svg, .png or .txt; the plan as .json, .dot or .mmd; its graph as .ron");
            ui.add(TextEdit::singleline(&mut self.typed.1).hint_text("FILE.svg").desired_width(220.0));
            let typed = PathBuf::from(self.typed.1.trim());
            let named = |otherwise: String| if typed.as_os_str().is_empty() { otherwise.into() } else { typed.clone() };
            for pane in Pane::drawn().filter(|pane| *pane != Pane::View(View::Inspector)) {
                ui.horizontal(|ui| {
                    if ui.button(pane.word()).clicked() {
                        self.chosen(Purpose::Export(pane), &named(format!("{}.svg", pane.word())), theme);
                        ui.close();
                    }
                    self.ask_button(ui, "…", Purpose::Export(pane));
                });
            }
            if self.live.is_some() {
                ui.separator();
                ui.horizontal(|ui| {
                    let tip = "Times of every frame and step on CPU and GPU, for Perfetto or chrome://tracing";
                    if ui.button("times").on_hover_text(tip).clicked() {
                        self.chosen(Purpose::Trace, &named("trace.json".into()), theme);
                        ui.close();
                    }
                    self.ask_button(ui, "…", Purpose::Trace);
                });
            }
        });
    }

    /// Exports a view, or the plan, depending on the extension.
    ///
    /// # Errors
    /// One line that names the file.
    pub(super) fn export(&self, pane: Pane, path: &Path, theme: Theme) -> Result<(), String> {
        let drawing =
            (self.session.plan.is_some() || !pane.is_of_a_plan()).then(|| pane.drawing(&self.session)).flatten();
        write(path, drawing.as_ref(), self.session.plan.as_deref(), theme, &self.read())
    }

    /// Exports the times of the drawn frames in the trace event format.
    ///
    /// # Errors
    /// One line that names the file.
    pub(super) fn export_trace(&self, path: &Path) -> Result<(), String> {
        let shown = path.display();
        let running = self.live.as_ref().and_then(|live| live.running.as_ref());
        let trace = running.and_then(|running| running.frames().executor().timing().trace());
        let trace = trace.ok_or_else(|| format!("{shown}: no frame has been drawn yet"))?;
        let json = trace.chrome_json();
        Outputs::one_beside(path, json.as_bytes(), &self.read()).map_err(|error| error.to_string())
    }

    /// Returns the input files of the displayed data.
    fn read(&self) -> Vec<PathBuf> {
        let live = self.live.as_ref().map_or_else(Vec::new, |live| live.read());
        self.session.read.iter().cloned().chain(live).collect()
    }
}
