//! Attaching to an engine.

use super::Viewer;
use super::panes::add_textures;
use crate::attached::Attached;
use egui::{TextEdit, Ui};

impl Viewer {
    /// Attaches to an engine at `HOST:PORT`, in place of the previous one. Other threads call `wake` after each message.
    pub fn attach(&mut self, address: &str, wake: impl Fn() + Send + 'static) {
        // Files that were opened before do not end the connection.
        self.refresh();
        self.attached = Some(Attached::open(address, wake));
        address.clone_into(&mut self.address);
        add_textures(&mut self.tiles);
    }

    /// Ends the connection. The last plan and its times stay.
    pub fn detach(&mut self) {
        self.attached = None;
    }

    /// Shows the menu that attaches to an engine. A live frame has its own plan, and needs none.
    pub(super) fn attach_menu(&mut self, ui: &mut Ui) {
        if self.live.is_some() {
            return;
        }
        let title = self.attached.as_ref().map(Attached::title);
        let attached = self.attached.as_ref().is_some_and(|attached| !attached.is_ended());
        let tip = "Show plan, times and textures of a running engine";
        ui.menu_button(if attached { "Attached" } else { "Attach" }, |ui| {
            if let Some(title) = title {
                ui.label(title);
            }
            let edit = TextEdit::singleline(&mut self.address).hint_text("HOST:PORT").desired_width(180.0);
            let edit = ui.add(edit).on_hover_text("Address of the engine's server");
            let enter = edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let address = self.address.trim().to_owned();
            let connect = ui.add_enabled(!address.is_empty(), egui::Button::new("Connect")).clicked();
            if connect || (enter && !address.is_empty()) {
                let ctx = ui.ctx().clone();
                self.attach(&address, move || ctx.request_repaint());
                ui.close();
            }
            if attached && ui.button("Detach").clicked() {
                self.detach();
                ui.close();
            }
        })
        .response
        .on_hover_text(tip);
    }
}
