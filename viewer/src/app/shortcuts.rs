//! Keyboard shortcuts.

use super::panes::Pane;
use egui::{Context, Grid, Key, Modifiers};

/// Shortcuts with descriptions.
pub const SHORTCUTS: [(&str, &str); 14] = [
    ("Ctrl+F", "search passes and resources"),
    ("Ctrl+1 … Ctrl+9", "graph, timeline, memory, bandwidth, inspector, diff, trace, accuracy, queues"),
    ("Escape", "clear the selection; close this list"),
    ("F", "show the whole view under the pointer"),
    ("1", "show it at 100 %"),
    ("+ and -", "zoom it"),
    ("arrows", "pan it"),
    ("drag, wheel", "pan it"),
    ("Ctrl+wheel", "zoom it at the pointer"),
    ("Ctrl+plus, Ctrl+minus", "change the font size"),
    ("Ctrl+Z", "undo the last change of settings, camera or light"),
    ("Ctrl+Y", "redo it"),
    ("Ctrl+D", "change between light and dark"),
    ("F1", "this list"),
];

/// Action of a shortcut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// Focus the search.
    Search,
    /// Bring a pane to the front.
    Pane(Pane),
    /// Toggle the list of shortcuts.
    Help,
    /// Undo the last change of settings.
    Undo,
    /// Redo the last undone change.
    Redo,
    /// Clear the selection and close the list.
    Clear,
}

/// Returns the actions of keys pressed in this frame. The theme changes immediately.
pub(super) fn actions(ctx: &Context) -> Vec<Action> {
    let pressed = |modifiers: Modifiers, key: Key| ctx.input_mut(|i| i.consume_key(modifiers, key));
    let mut actions = Vec::new();
    if pressed(Modifiers::COMMAND, Key::F) {
        actions.push(Action::Search);
    }
    let numbers = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];
    actions.extend(
        numbers
            .into_iter()
            .zip(Pane::drawn())
            .filter(|(key, _)| pressed(Modifiers::COMMAND, *key))
            .map(|(_, pane)| Action::Pane(pane)),
    );
    // Text fields have their own undo.
    if !ctx.egui_wants_keyboard_input() {
        if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            actions.push(Action::Redo);
        }
        if pressed(Modifiers::COMMAND, Key::Z) {
            actions.push(Action::Undo);
        }
    }
    if pressed(Modifiers::COMMAND, Key::D) {
        let dark = ctx.theme() == egui::Theme::Dark;
        ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
    }
    if pressed(Modifiers::NONE, Key::F1) {
        actions.push(Action::Help);
    }
    if pressed(Modifiers::NONE, Key::Escape) {
        actions.push(Action::Clear);
    }
    actions
}

/// Shows the shortcuts and returns whether the window stays open.
pub(super) fn list(ctx: &Context) -> bool {
    let mut open = true;
    egui::Window::new("Keyboard shortcuts").open(&mut open).resizable(false).collapsible(false).show(ctx, |ui| {
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
