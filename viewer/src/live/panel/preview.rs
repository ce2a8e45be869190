//! Texture viewer: version and subresource, channels and range, zoom, histogram, and values of texels.

mod controls;
mod histogram;
mod parts;
mod picture;
mod remote;

pub use remote::remote_preview;

use crate::drawing::Item;
use crate::live::Live;
use crate::live::file_request::FileRequest;
use crate::live::preview::{Preview, save};
use crate::plan_data::PlanData;
use crate::session::Session;
use egui::{ComboBox, RichText, TextEdit, Ui};
use std::path::PathBuf;

/// Shows the texture of the selected resource.
pub fn preview(ui: &mut Ui, live: &mut Live, session: &mut Session) {
    if !session.is_live() {
        ui.label("Only textures of the live frame have contents. Show its plan from the viewport");
        return;
    }
    let plan = session.plan.clone();
    if let Some((Item::Resource(index), plan)) = session.selected.zip(plan.as_ref())
        && let Some(resource) = plan.form.resources.get(index)
    {
        live.preview.look_at(&resource.name);
    }
    live.inspect(session);
    let (blocking, read) = (live.is_blocking(), live.read());
    if contents(ui, &mut live.preview, session, blocking, &read) {
        live.file_request = Some(FileRequest::SaveTexture);
    }
}

/// Shows a preview, and returns whether a file dialog is requested. `read` are files that must not be overwritten.
fn contents(ui: &mut Ui, preview: &mut Preview, session: &mut Session, blocking: bool, read: &[PathBuf]) -> bool {
    let plan = session.plan.clone();
    let mut asks = false;
    ui.horizontal_wrapped(|ui| {
        if let Some(plan) = &plan {
            names(ui, preview, plan, session);
        }
        let samples = plan.as_ref().and_then(|plan| {
            let index = plan.resource(preview.name.as_ref()?)?;
            plan.form.resources[index].samples
        });
        parts::parts(ui, preview, samples.unwrap_or(1));
    });
    controls::controls(ui, preview);
    if let Some(error) = &preview.error {
        ui.add(egui::Label::new(error).wrap());
    }
    let ctx = ui.ctx().clone();
    preview.display(blocking, move || ctx.request_repaint());
    if preview.found.is_some() {
        asks = file(ui, preview, read);
        histogram::histogram(ui, preview);
        picture::picture(ui, preview);
    } else if preview.is_reading() {
        ui.spinner();
    }
    asks
}

/// Shows the list of textures. A choice selects the resource everywhere.
fn names(ui: &mut Ui, preview: &mut Preview, plan: &PlanData, session: &mut Session) {
    let mut names: Vec<(&str, usize)> = plan
        .form
        .resources
        .iter()
        .enumerate()
        .filter(|(_, r)| r.format.is_some())
        .map(|(index, r)| (r.name.as_str(), index))
        .collect();
    names.sort_unstable();
    let shown = preview.name.clone().unwrap_or_else(|| "select a texture".into());
    ComboBox::from_id_salt("texture")
        .selected_text(shown)
        .show_ui(ui, |ui| {
            for (name, index) in names {
                if ui.selectable_label(preview.name.as_deref() == Some(name), name).clicked() {
                    preview.look_at(name);
                    session.selected = Some(Item::Resource(index));
                }
            }
        })
        .response
        .on_hover_text("Displayed texture; follows the selected resource");
}

/// Shows the path of the file to save, and returns whether a file dialog is requested.
fn file(ui: &mut Ui, preview: &mut Preview, read: &[PathBuf]) -> bool {
    let asks = ui.horizontal(|ui| {
        let width = (ui.available_width() - 116.0).max(40.0);
        let edit = TextEdit::singleline(&mut preview.path).hint_text("TEXTURE.png or .exr").desired_width(width);
        ui.add(edit);
        let path = PathBuf::from(preview.path.trim());
        let tip = "Save the picture as PNG, or the values of all channels as EXR";
        let named = !preview.path.trim().is_empty();
        if ui.add_enabled(named, egui::Button::new("Save")).on_hover_text(tip).clicked() {
            let saved = save(preview, &path, read);
            preview.saved = Some(saved.map(|()| format!("saved {}", path.display())));
        }
        ui.button("Save…").on_hover_text("Choose the file in a dialog").clicked()
    });
    match &preview.saved {
        Some(Ok(saved)) => _ = ui.label(saved),
        Some(Err(error)) => _ = ui.label(RichText::new(error).color(ui.visuals().error_fg_color)),
        None => {}
    }
    asks.inner
}
