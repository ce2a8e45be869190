//! Actions on files chosen in dialogs.

use super::Viewer;
use super::dialog::{Answer, Purpose};
use crate::drawing::Theme;
use crate::live::file_request::FileRequest;
use crate::session::Role;
use egui::Ui;
use std::path::Path;

impl Viewer {
    /// Adds a button that opens a file dialog of the desktop.
    pub(super) fn ask_button(&mut self, ui: &mut Ui, name: &str, purpose: Purpose) {
        let tip = "Choose a file in a dialog; without a desktop, type the path instead";
        if ui.button(name).on_hover_text(tip).clicked() {
            self.dialog.ask(purpose, ui.ctx());
            ui.close();
        }
    }

    /// Handles finished dialogs, and opens those that panels request.
    pub(super) fn dialogs(&mut self, ui: &Ui) {
        if let Some(asked) = self.live.as_mut().and_then(|live| live.file_request.take()) {
            let purpose = match asked {
                FileRequest::Open => Purpose::Open(Role::Shown),
                FileRequest::SaveSettings => Purpose::SaveSettings,
                FileRequest::SaveTexture => Purpose::Texture,
            };
            self.dialog.ask(purpose, ui.ctx());
        }
        if self.attached.as_mut().is_some_and(|attached| std::mem::take(&mut attached.asks_file)) {
            self.dialog.ask(Purpose::Texture, ui.ctx());
        }
        match self.dialog.answer() {
            Some((purpose, Answer::File(path))) => self.chosen(purpose, &path, crate::panel::theme(ui)),
            Some((Purpose::Open(_), Answer::NoDialog)) => {
                self.focus_path = true;
                self.session.confirm("no file dialog on this desktop: type the path at the top".into());
            }
            Some((_, Answer::NoDialog)) => {
                self.session.confirm("no file dialog on this desktop: type the path beside the button".into());
            }
            Some((_, Answer::Cancelled)) | None => {}
        }
    }

    /// Executes the purpose of a dialog with the chosen file.
    pub fn chosen(&mut self, purpose: Purpose, path: &Path, theme: Theme) {
        let done = match purpose {
            Purpose::Open(role) => return self.open(path, role),
            Purpose::SaveSettings => match &self.live {
                Some(live) => live.save(path),
                None => return,
            },
            Purpose::Export(view) => self.export(view, path, theme),
            Purpose::Trace => self.export_trace(path),
            Purpose::Texture => match (&self.live, &self.attached) {
                (Some(live), _) => crate::live::preview::save(&live.preview, path, &live.read()),
                (None, Some(attached)) => crate::live::preview::save(&attached.preview, path, &[]),
                (None, None) => return,
            },
        };
        match done {
            Ok(()) => self.session.confirm(format!("saved {}", path.display())),
            Err(error) => self.session.say(error),
        }
    }
}
