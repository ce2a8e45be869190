//! Inspector: all data of the selected item as selectable text.

use crate::drawing::{Ink, Item};
use crate::view::inspector::{Line, Section, text};
use egui::{Label, RichText, ScrollArea, Ui};

/// Target of a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Link {
    /// Item of the plan.
    Item(Item),
    /// Source location as `PATH:LINE`.
    Source(String),
}

/// Shows the sections and returns a clicked link.
pub fn inspector(ui: &mut Ui, sections: &[Section]) -> Option<Link> {
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
                            clicked = Some(Link::Item(*item));
                        }
                    }
                    Line::Source(place) => {
                        let tip = "Open in the editor of VISUAL or EDITOR, or in Visual Studio Code";
                        if ui.link(format!("declared at {place}")).on_hover_text(tip).clicked() {
                            clicked = Some(Link::Source(place.clone()));
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
