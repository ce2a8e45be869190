//! Switches for all effects, with the decisions of feature culling.

use crate::drawing::Ink;
use crate::live::Live;
use crate::live::capture::Document;
use egui::{RichText, ScrollArea, Ui};
use framegraph_passes::feature_culling::Decision;
use framegraph_passes::{Effect, Settings};

/// Effects that only the scene enables, not a setting.
const SCENE_EFFECTS: [Effect; 3] = [Effect::Transmission, Effect::Blending, Effect::Grading];

/// Shows the effects and edits the settings.
pub fn effects(ui: &mut Ui, live: &mut Live) {
    let tip = "Draw all requested effects, even if they change nothing in this scene";
    let mut forced = live.options.forced;
    if ui.checkbox(&mut forced, "force effects").on_hover_text(tip).changed() {
        live.options.forced = forced;
        live.again();
    }
    ui.separator();
    let settings = live.document().frame.settings;
    let mut asked = settings;
    let theme = crate::panel::theme(ui);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for effect in Effect::ALL {
            let mut on = asked.has(effect);
            let row = live.running.as_ref().and_then(|running| running.facts.of(effect));
            let dropped = row.is_some_and(|row| row.decision == Decision::Dropped);
            let name =
                if dropped { RichText::new(effect.name()).strikethrough() } else { RichText::new(effect.name()) };
            let can = on || !SCENE_EFFECTS.contains(&effect);
            let response = ui.add_enabled(can, egui::Checkbox::new(&mut on, name));
            if response.changed() {
                asked = if on { Settings::with(asked, effect) } else { Settings::without(asked, effect) };
            }
            if let Some(row) = row {
                let word = if dropped { "dropped:" } else { "kept:" };
                let ink = if dropped { Ink::Text } else { Ink::Faint };
                let text = RichText::new(format!("{word} {} [{}]", row.reason, row.proof)).size(11.0);
                ui.indent(effect.name(), |ui| {
                    ui.add(egui::Label::new(text.color(crate::panel::color(ink, theme))).wrap());
                });
            }
        }
    });
    if asked != settings {
        let mut document: Document = live.document().clone();
        document.frame.settings = asked;
        live.set(document, false);
    }
}
