//! What an option makes of its technique's picture, as the lab of accuracy keeps it: reference, option, and sixteen times their
//! difference about grey, side by side.

use crate::accuracy_data::AccuracyData;
use egui::{ComboBox, Image, TextureHandle, TextureOptions, Ui};
use framegraph_scene::picture::read_rgba8;
use std::path::{Path, PathBuf};

/// The picture that is shown, if one was chosen.
#[derive(Default)]
pub(super) struct Strip {
    /// Whose picture it is, its file, and the picture or why there is none.
    shown: Option<(String, PathBuf, Result<TextureHandle, String>)>,
}

impl Strip {
    /// The list of the options that have pictures; nothing where none has.
    pub fn choose(&mut self, ui: &mut Ui, data: &AccuracyData) {
        if data.pictures.is_none() {
            return;
        }
        let word = self.shown.as_ref().map_or("none", |(name, ..)| name.as_str()).to_owned();
        ComboBox::from_label("picture").selected_text(word).width(220.0).show_ui(ui, |ui| {
            if ui.selectable_label(self.shown.is_none(), "none").clicked() {
                self.shown = None;
            }
            for technique in &data.techniques {
                for choice in &technique.choices {
                    let Some(file) = data.picture(technique, choice) else { continue };
                    let name = format!("{}: {}", technique.name, choice.name);
                    let is_shown = self.shown.as_ref().is_some_and(|(_, shown, _)| *shown == file);
                    if ui.selectable_label(is_shown, &name).clicked() {
                        let picture = load(ui, &file);
                        self.shown = Some((name, file, picture));
                    }
                }
            }
        });
    }

    /// The picture, as wide as there is room for.
    pub fn show(&self, ui: &mut Ui) {
        match &self.shown {
            None => {}
            Some((.., Err(told))) => {
                ui.colored_label(ui.visuals().error_fg_color, told);
            }
            Some((name, _, Ok(texture))) => {
                ui.label(format!("{name}; reference, option, and sixteen times the difference"));
                ui.add(Image::new(texture).fit_to_exact_size(fitted(texture.size_vec2(), ui.available_size())));
            }
        }
    }
}

/// A picture's size where it is to fit the width and a third of the height, at most thrice its own.
fn fitted(size: egui::Vec2, room: egui::Vec2) -> egui::Vec2 {
    let most = (room.x / size.x).min(0.33 * room.y / size.y).min(3.0);
    size * most.max(0.1)
}

fn load(ui: &Ui, file: &Path) -> Result<TextureHandle, String> {
    let (size, rgba8) = read_rgba8(file).map_err(|error| error.to_string())?;
    let picture = egui::ColorImage::from_rgba_unmultiplied(size.map(|side| side as usize), &rgba8);
    Ok(ui.ctx().load_texture("accuracy", picture, TextureOptions::NEAREST))
}
