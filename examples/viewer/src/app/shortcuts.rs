//! Keys.

use super::Viewer;
use crate::view::View;
use egui::{Context, Grid, Key, Modifiers};

/// Each shortcut with what it does.
pub const SHORTCUTS: [(&str, &str); 12] = [
    ("Ctrl+F", "search passes and resources"),
    ("Ctrl+1 … Ctrl+7", "graph, timeline, memory, bandwidth, inspector, diff, trace"),
    ("Escape", "select nothing; close this list"),
    ("F", "show the whole view under the pointer"),
    ("1", "show it at its own size"),
    ("+ and -", "zoom it"),
    ("arrows", "pan it"),
    ("drag, wheel", "pan it"),
    ("Ctrl+wheel", "zoom it about the pointer"),
    ("Ctrl+plus, Ctrl+minus", "make all letters larger or smaller"),
    ("Ctrl+D", "change between light and dark"),
    ("F1", "this list"),
];

/// Does what keys ask for.
pub(super) fn act(viewer: &mut Viewer, ctx: &Context) {
    let pressed = |modifiers: Modifiers, key: Key| ctx.input_mut(|i| i.consume_key(modifiers, key));
    if pressed(Modifiers::COMMAND, Key::F) {
        viewer.tiles.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(super::Pane::List)));
        viewer.list.focus = true;
    }
    let numbers = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7];
    for (key, view) in numbers.into_iter().zip(View::ALL) {
        if pressed(Modifiers::COMMAND, key) {
            viewer.turn_to(view);
        }
    }
    if pressed(Modifiers::COMMAND, Key::D) {
        let dark = ctx.theme() == egui::Theme::Dark;
        ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
    }
    if pressed(Modifiers::NONE, Key::F1) {
        viewer.help = !viewer.help;
    }
    if pressed(Modifiers::NONE, Key::Escape) {
        viewer.help = false;
        viewer.session.selected = None;
    }
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
