//! Keys.

use crate::view::View;
use egui::{Context, Grid, Key, Modifiers};

/// Each shortcut with what it does.
pub const SHORTCUTS: [(&str, &str); 14] = [
    ("Ctrl+F", "search passes and resources"),
    ("Ctrl+1 … Ctrl+8", "graph, timeline, memory, bandwidth, inspector, diff, trace, accuracy"),
    ("Escape", "select nothing; close this list"),
    ("F", "show the whole view under the pointer"),
    ("1", "show it at its own size"),
    ("+ and -", "zoom it"),
    ("arrows", "pan it"),
    ("drag, wheel", "pan it"),
    ("Ctrl+wheel", "zoom it about the pointer"),
    ("Ctrl+plus, Ctrl+minus", "make all letters larger or smaller"),
    ("Ctrl+Z", "take back the last change of settings, camera or light"),
    ("Ctrl+Y", "do it again"),
    ("Ctrl+D", "change between light and dark"),
    ("F1", "this list"),
];

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asked {
    /// Search.
    Search,
    /// A view in front.
    View(View),
    /// The list of shortcuts, or no list.
    Help,
    /// Settings before the last change.
    Undo,
    /// Settings after it.
    Redo,
    /// Nothing selected, no list.
    Nothing,
}

/// What keys ask for in this frame; the theme is changed at once.
pub(super) fn asked(ctx: &Context) -> Vec<Asked> {
    let pressed = |modifiers: Modifiers, key: Key| ctx.input_mut(|i| i.consume_key(modifiers, key));
    let mut asked = Vec::new();
    if pressed(Modifiers::COMMAND, Key::F) {
        asked.push(Asked::Search);
    }
    let numbers = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];
    asked.extend(
        numbers
            .into_iter()
            .zip(View::ALL)
            .filter(|(key, _)| pressed(Modifiers::COMMAND, *key))
            .map(|(_, view)| Asked::View(view)),
    );
    // Letters that are being typed have an undo of their own.
    if !ctx.egui_wants_keyboard_input() {
        if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            asked.push(Asked::Redo);
        }
        if pressed(Modifiers::COMMAND, Key::Z) {
            asked.push(Asked::Undo);
        }
    }
    if pressed(Modifiers::COMMAND, Key::D) {
        let dark = ctx.theme() == egui::Theme::Dark;
        ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
    }
    if pressed(Modifiers::NONE, Key::F1) {
        asked.push(Asked::Help);
    }
    if pressed(Modifiers::NONE, Key::Escape) {
        asked.push(Asked::Nothing);
    }
    asked
}

/// Shows the shortcuts; returns whether they stay.
pub(super) fn list(ctx: &Context) -> bool {
    let mut open = true;
    egui::Window::new("shortcuts").open(&mut open).resizable(false).collapsible(false).show(ctx, |ui| {
        Grid::new("shortcuts").num_columns(2).striped(true).show(ui, |ui| {
            for (keys, what) in SHORTCUTS {
                ui.label(egui::RichText::new(keys).strong());
                ui.label(what);
                ui.end_row();
            }
        });
    });
    open
}
