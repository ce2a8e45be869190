//! Panels for egui. Each is a function of plain data with a small state, so an engine can embed it in its windows.

mod canvas;
mod drawings;
pub mod grid;
mod inspector;
mod list;
mod paint;
mod questions;
mod view_data;
mod views;

pub use canvas::{Canvas, Clicked, MARGIN};
pub use drawings::drawn;
pub use inspector::{Link, inspector};
pub use list::List;
pub use questions::{Questions, Shown};
pub use view_data::ViewData;
pub use views::{Reaction, Views};

use crate::drawing::{Ink, Theme};
use crate::glossary;
use egui::{Color32, Response, Ui};

/// Glossary terms with tooltips in the panels.
pub const TERMS: [&str; 13] = [
    "pass",
    "load",
    "store",
    "multisample resolve",
    "memoryless",
    "inlined",
    "culled",
    "step",
    "lower bound",
    "order",
    "alias",
    "caps",
    "merge",
];

/// Returns the egui color of an ink.
pub fn color(ink: Ink, theme: Theme) -> Color32 {
    let [r, g, b] = ink.rgb(theme);
    Color32::from_rgb(r, g, b)
}

/// Returns the current theme of egui.
pub fn theme(ui: &Ui) -> Theme {
    if ui.visuals().dark_mode { Theme::Dark } else { Theme::Light }
}

/// Sets the background and text colors of the drawings in egui's style. Call it once.
pub fn dress(ctx: &egui::Context) {
    for (theme, shown) in [(Theme::Light, egui::Theme::Light), (Theme::Dark, egui::Theme::Dark)] {
        ctx.style_mut_of(shown, |style| {
            style.visuals.panel_fill = color(Ink::Background, theme);
            // Text fields contrast with the background.
            style.visuals.text_edit_bg_color = Some(color(Ink::Grid, theme));
            style.visuals.widgets.noninteractive.fg_stroke.color = color(Ink::Text, theme);
        });
    }
}

/// Shows text with the glossary definition of a term as a tooltip.
pub fn term(ui: &mut Ui, text: impl Into<egui::WidgetText>, word: &str) -> Response {
    let label = ui.label(text);
    match glossary::meaning(word) {
        Some(meaning) => label.on_hover_text(meaning),
        None => label,
    }
}
