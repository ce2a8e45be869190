//! What is done with files that dialogs were answered with.

use super::Viewer;
use super::dialog::Purpose;
use crate::drawing::Theme;
use crate::live::asked_file::AskedFile;
use crate::session::Role;
use egui::Ui;
use std::path::Path;

impl Viewer {
    /// A button that opens the desktop's dialog.
    pub(super) fn ask_button(&mut self, ui: &mut Ui, name: &str, purpose: Purpose) {
        let tip = "a dialog of the desktop; where it has none, type the path";
        if ui.button(name).on_hover_text(tip).clicked() {
            self.dialog.ask(purpose, ui.ctx());
            ui.close();
        }
    }

    /// Takes what dialogs were answered, and opens those that panels ask for.
    pub(super) fn dialogs(&mut self, ui: &Ui) {
        if let Some(asked) = self.live.as_mut().and_then(|live| live.asks_file.take()) {
            let purpose = match asked {
                AskedFile::Open => Purpose::Open(Role::Shown),
                AskedFile::SaveSettings => Purpose::SaveSettings,
            };
            self.dialog.ask(purpose, ui.ctx());
        }
        if let Some((purpose, path)) = self.dialog.answer() {
            self.chosen(purpose, &path, crate::panel::theme(ui));
        }
    }

    /// Does with a file what it was chosen for.
    pub fn chosen(&mut self, purpose: Purpose, path: &Path, theme: Theme) {
        let done = match purpose {
            Purpose::Open(role) => return self.open(path, role),
            Purpose::SaveSettings => match &self.live {
                Some(live) => live.save(path),
                None => return,
            },
            Purpose::Export(view) => self.export(view, path, theme),
            Purpose::Trace => self.export_trace(path),
        };
        self.session.say(done.map_or_else(|error| error, |()| format!("wrote {}", path.display())));
    }
}
