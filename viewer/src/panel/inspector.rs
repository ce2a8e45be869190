//! Inspector: all data of the selected item as selectable text.

use crate::drawing::{Ink, Item};
use crate::view::inspector::{Line, Section, text};
use egui::{Label, RichText, ScrollArea, Ui};

/// Shows the sections and returns the item of a clicked link.
pub fn inspector(ui: &mut Ui, sections: &[Section]) -> Option<Item> {
    let mut clicked = None;
    if ui.small_button("Copy").on_hover_text("Copy everything as text").clicked() {
        ui.ctx().copy_text(text(sections));
    }
    let theme = super::theme(ui);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for (index, Section { title, lines }) in sections.iter().enumerate() {
            if index > 0 {
                ui.add_space(8.0);
            }
            let size = if index == 0 { 17.0 } else { 14.0 };
            ui.add(Label::new(RichText::new(title).size(size).strong()).wrap());
            for line in lines {
                match line {
                    Line::Plain(text) => _ = ui.add(Label::new(text).wrap()),
                    Line::Link(item, text) => {
                        if ui.link(text).clicked() {
                            clicked = Some(*item);
                        }
                    }
                    Line::Hint(text) => {
                        let hint = RichText::new(format!("hint: {text}")).italics();
                        ui.add(Label::new(hint.color(super::color(Ink::Faint, theme))).wrap());
                    }
                }
            }
        }
    });
    clicked
}
