//! Settings panel: presets, files, undo, and every field.

use super::fields::Fields;
use super::{curves, goes_on, tone};
use crate::live::Live;
use crate::live::file_request::FileRequest;
use crate::live::settings_panel::SettingsPanel;
use crate::settings::{settings as as_settings, tree};
use egui::{RichText, ScrollArea, TextEdit, Ui};
use framegraph_passes::Preset;
use std::path::PathBuf;

/// Shows and edits the settings.
pub fn settings(ui: &mut Ui, live: &mut Live) {
    bar(ui, live);
    let mut panel = std::mem::take(&mut live.settings);
    let width = ui.available_width();
    ui.add(TextEdit::singleline(&mut panel.search).hint_text("search fields").desired_width(width - 12.0));
    if let Some(refused) = &panel.refused {
        ui.label(RichText::new(refused).color(ui.visuals().error_fg_color));
    }
    if let Some(saved) = &panel.saved {
        ui.label(saved);
    }
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let mut document = live.document().clone();
        let post = &mut document.frame.settings.post;
        tone::curve(ui, post);
        if curves::curves(ui, &mut post.look.grading) {
            live.set(document, goes_on(ui.ctx()));
        }
        fields(&mut panel, ui, live);
    });
    live.settings = panel;
}

fn fields(panel: &mut SettingsPanel, ui: &mut Ui, live: &mut Live) {
    let frame = live.document().frame;
    if panel.tree.as_ref().is_none_or(|(of, _)| *of != frame) {
        match tree(&frame) {
            Ok(node) => panel.tree = Some((frame, node)),
            Err(error) => panel.refused = Some(error),
        }
    }
    let Some((_, node)) = &panel.tree else { return };
    let mut changed = node.clone();
    let shown = Fields { search: &panel.search };
    if !shown.is_found("", node) {
        ui.label(format!("no field matches `{}`", panel.search.trim()));
    }
    shown.children(ui, "", &mut changed);
    if changed != *node {
        panel.saved = None;
    }
    if changed == *node {
        if !goes_on(ui.ctx()) {
            live.history.finish();
        }
        return;
    }
    match as_settings(&changed) {
        Ok(frame) => {
            panel.refused = None;
            let mut document = live.document().clone();
            document.frame = frame;
            live.set(document, goes_on(ui.ctx()));
        }
        Err(error) => panel.refused = Some(error),
    }
}
/// Shows presets, undo, redo and files.
fn bar(ui: &mut Ui, live: &mut Live) {
    ui.horizontal_wrapped(|ui| {
        for preset in Preset::ALL {
            let is = live.document().frame == preset.frame();
            if ui.selectable_label(is, preset.name()).on_hover_text("Load all settings of this preset").clicked() {
                let mut document = live.document().clone();
                document.frame = preset.frame();
                live.set(document, false);
            }
        }
        let [undo, redo] = live.history.steps().map(|steps| steps > 0);
        if ui.add_enabled(undo, egui::Button::new("Undo")).on_hover_text("Ctrl+Z").clicked() && live.history.undo() {
            live.again();
        }
        if ui.add_enabled(redo, egui::Button::new("Redo")).on_hover_text("Ctrl+Y").clicked() && live.history.redo() {
            live.again();
        }
        super::ask(ui, live, FileRequest::Open, "Open a settings file");
        super::ask(ui, live, FileRequest::SaveSettings, "Save the settings to a file");
    });
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 122.0).max(40.0);
        ui.add(TextEdit::singleline(&mut live.path).hint_text("SETTINGS.ron").desired_width(width));
        let path = PathBuf::from(live.path.trim());
        let named = !live.path.trim().is_empty();
        if ui
            .add_enabled(named, egui::Button::new("Load"))
            .on_hover_text("Load a settings file (docs/reference/settings.md)")
            .clicked()
        {
            let read = crate::standard_frame::settings(live.path.trim());
            live.settings.refused = match read {
                Ok(frame) => {
                    let mut document = live.document().clone();
                    document.frame = frame;
                    live.set(document, false);
                    None
                }
                Err(error) => Some(error),
            };
        }
        if ui.add_enabled(named, egui::Button::new("Save")).on_hover_text("Save every field as RON").clicked() {
            let saved = live.save(&path);
            live.settings.saved = saved.is_ok().then(|| format!("saved {}", path.display()));
            live.settings.refused = saved.err();
        }
    });
}
