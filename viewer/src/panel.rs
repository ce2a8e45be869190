//! Panels for egui. Each is a function of plain data and a small state of its own; an engine puts them into its windows.

mod canvas;
mod facts;
mod list;
mod paint;
mod questions;

pub use canvas::{Canvas, Clicked, MARGIN};
pub use facts::facts;
pub use list::List;
pub use questions::{Questions, Shown};

use crate::drawing::{Ink, Theme};
use crate::glossary;
use egui::{Color32, Response, Ui};

/// The words of the panels that the glossary explains.
pub const TERMS: [&str; 13] = [
    "pass",
    "unresolve",
    "resolve",
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

/// An ink on the screen.
pub fn color(ink: Ink, theme: Theme) -> Color32 {
    let [r, g, b] = ink.rgb(theme);
    Color32::from_rgb(r, g, b)
}

/// The theme that egui shows.
pub fn theme(ui: &Ui) -> Theme {
    if ui.visuals().dark_mode { Theme::Dark } else { Theme::Light }
}

/// Gives egui the background of the pictures, and makes its words as dark as theirs: they are read, not skimmed. To be called
/// once.
pub fn dress(ctx: &egui::Context) {
    for (theme, shown) in [(Theme::Light, egui::Theme::Light), (Theme::Dark, egui::Theme::Dark)] {
        ctx.style_mut_of(shown, |style| {
            style.visuals.panel_fill = color(Ink::Background, theme);
            // Fields stand out from it.
            style.visuals.text_edit_bg_color = Some(color(Ink::Grid, theme));
            style.visuals.widgets.noninteractive.fg_stroke.color = color(Ink::Text, theme);
        });
    }
}

/// A text with the meaning of a word of the glossary as a tooltip.
pub fn term(ui: &mut Ui, text: impl Into<egui::WidgetText>, word: &str) -> Response {
    let label = ui.label(text);
    match glossary::meaning(word) {
        Some(meaning) => label.on_hover_text(meaning),
        None => label,
    }
}
