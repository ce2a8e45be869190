//! List of passes and resources with a search field.

use crate::drawing::Item;
use crate::plan_data::PlanData;
use egui::{RichText, ScrollArea, TextEdit, Ui};

/// State of the search.
#[derive(Clone, Debug, Default)]
pub struct List {
    /// Case-insensitive search words, in any order.
    pub search: String,
    /// Focuses the search field in the next frame.
    pub focus: bool,
}

/// Height of a row in points.
const ROW: f32 = 18.0;

impl List {
    /// Returns the items whose names contain all search words: passes, then resources.
    pub fn found(&self, plan: &PlanData) -> Vec<Item> {
        let words: Vec<String> = self.search.split_whitespace().map(str::to_lowercase).collect();
        let fits = |name: &str| {
            let name = name.to_lowercase();
            words.iter().all(|word| name.contains(word.as_str()))
        };
        let passes = plan.form.passes.iter().enumerate().filter(|(_, p)| fits(&p.name)).map(|(i, _)| Item::Pass(i));
        let resources = plan.form.resources.iter().enumerate().filter(|(_, r)| fits(&r.name));
        passes.chain(resources.map(|(i, _)| Item::Resource(i))).collect()
    }

    /// Shows the search field and the results; returns the clicked item.
    pub fn show(&mut self, ui: &mut Ui, plan: &PlanData, selected: Option<Item>) -> Option<Item> {
        let edit = TextEdit::singleline(&mut self.search).hint_text("search passes and resources");
        let edit = ui.add(edit.desired_width(f32::INFINITY));
        if std::mem::take(&mut self.focus) {
            edit.request_focus();
        }
        let found = self.found(plan);
        ui.label(format!("{} of {}", found.len(), plan.form.passes.len() + plan.form.resources.len()));
        let mut clicked = None;
        // Enter selects the first result.
        if edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter)) {
            clicked = found.first().copied();
        }
        ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, found.len(), |ui, rows| {
            for item in found[rows].iter().copied() {
                let (text, faint) = match item {
                    Item::Pass(index) => {
                        let pass = &plan.form.passes[index];
                        let place = pass.step.map_or("culled".into(), |step| format!("step {step}"));
                        (format!("{}  ({place})", pass.name), pass.culled)
                    }
                    Item::Resource(index) => {
                        let resource = &plan.form.resources[index];
                        (format!("{}  {}", resource.name, resource.placement), resource.first_step.is_none())
                    }
                    Item::Step(_) | Item::Flow(_) => continue,
                };
                let text = if faint { RichText::new(text).weak() } else { RichText::new(text) };
                let label = egui::Button::selectable(selected == Some(item), text).truncate();
                if ui.add(label).clicked() {
                    clicked = Some(item);
                }
            }
        });
        clicked
    }
}
