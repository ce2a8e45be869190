//! Comparison picture of an accuracy choice: reference, choice, and their difference times sixteen around gray.

use crate::accuracy_data::AccuracyData;
use egui::{ComboBox, Image, TextureHandle, TextureOptions, Ui};
use framegraph_scene::picture::read_rgba8;
use std::path::{Path, PathBuf};

/// Selected picture.
#[derive(Default)]
pub struct Strip {
    /// Name, file, and the picture or its error.
    shown: Option<(String, PathBuf, Result<TextureHandle, String>)>,
}

impl Strip {
    /// Shows the list of choices with pictures, if any exist.
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

    /// Shows the picture, fitted to the available width.
    pub fn show(&self, ui: &mut Ui) {
        match &self.shown {
            None => {}
            Some((.., Err(error))) => {
                ui.colored_label(ui.visuals().error_fg_color, error);
            }
            Some((name, _, Ok(texture))) => {
                ui.label(format!("{name}: reference, choice, and difference times sixteen"));
                ui.add(Image::new(texture).fit_to_exact_size(fitted(texture.size_vec2(), ui.available_size())));
            }
        }
    }
}

/// Fits a picture into the width and a third of the height, at most three times its size.
fn fitted(size: egui::Vec2, room: egui::Vec2) -> egui::Vec2 {
    let factor = (room.x / size.x).min(0.33 * room.y / size.y).min(3.0);
    size * factor.max(0.1)
}

fn load(ui: &Ui, file: &Path) -> Result<TextureHandle, String> {
    let (size, rgba8) = read_rgba8(file).map_err(|error| error.to_string())?;
    let picture = egui::ColorImage::from_rgba_unmultiplied(size.map(|side| side as usize), &rgba8);
    Ok(ui.ctx().load_texture("accuracy", picture, TextureOptions::NEAREST))
}
