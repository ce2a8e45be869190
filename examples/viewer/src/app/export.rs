//! Views and plans as files, from the menu of the window.

use super::Viewer;
use crate::drawing::{Drawing, Theme, svg};
use crate::offscreen::{Offscreen, own_size_px};
use crate::plan_data::PlanData;
use crate::view::View;
use egui::{TextEdit, Ui};
use framegraph::dump;
use std::path::Path;

/// Pixels for each point of a view in a PNG.
const SCALE: f32 = 2.0;

/// A file by its ending: a view as `.svg`, `.png` or `.txt`, the plan as `.json`, `.dot` or `.mmd`.
///
/// # Errors
/// One line that names the file.
pub(super) fn write(
    path: &Path,
    drawing: Option<&Drawing>,
    plan: Option<&PlanData>,
    theme: Theme,
) -> Result<(), String> {
    let shown = path.display();
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let drawing = || drawing.ok_or_else(|| format!("{shown}: nothing is shown; open a plan"));
    let live =
        || plan.and_then(|plan| plan.plan.as_deref()).ok_or_else(|| format!("{shown}: a saved plan is a file already"));
    let name = || plan.map_or("", |plan| plan.form.name.as_str());
    let bytes = match ending.as_str() {
        "svg" => svg(drawing()?, theme).into_bytes(),
        "txt" => drawing()?.words().into_bytes(),
        "png" => png(drawing()?, theme)?,
        "json" => dump::json(live()?, name()).into_bytes(),
        "dot" => dump::dot(live()?).into_bytes(),
        "mmd" => dump::mermaid(live()?).into_bytes(),
        _ => {
            return Err(format!(
                "{shown}: the ending is none of svg, png, txt (of a view), json, dot, mmd (of the plan)"
            ));
        }
    };
    std::fs::write(path, bytes).map_err(|e| format!("{shown}: cannot be written: {e}"))
}

/// On a device of its own: what draws the window is not disturbed.
fn png(drawing: &Drawing, theme: Theme) -> Result<Vec<u8>, String> {
    let mut screen = Offscreen::open()?;
    let size = own_size_px(drawing, SCALE);
    let rgba = screen.drawing(drawing, size, SCALE, theme, &[])?;
    let mut bytes = Vec::new();
    framegraph_scene::picture::encode_png(&mut bytes, size, &rgba).map_err(|e| e.to_string())?;
    Ok(bytes)
}

impl Viewer {
    /// A menu of views with the file that one goes to.
    pub(super) fn export_menu(&mut self, ui: &mut Ui) {
        let theme = crate::panel::theme(ui);
        ui.menu_button("Export", |ui| {
            ui.label("a view as .svg, .png or .txt; the plan as .json, .dot or .mmd");
            ui.add(TextEdit::singleline(&mut self.typed.1).hint_text("FILE.svg").desired_width(220.0));
            for view in View::ALL.into_iter().filter(|view| *view != View::Inspector) {
                if ui.button(view.word()).clicked() {
                    let typed = self.typed.1.trim();
                    let path = if typed.is_empty() { format!("{}.svg", view.word()) } else { typed.to_owned() };
                    let done = write(Path::new(&path), self.drawings.get(&view), self.session.plan.as_deref(), theme);
                    self.session.say(done.map_or_else(|error| error, |()| format!("wrote {path}")));
                    ui.close();
                }
            }
        });
    }
}
