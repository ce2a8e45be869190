//! Generic editor of settings fields: booleans as check boxes, numbers as drag values, variants as lists, other values as
//! RON text.

use crate::settings::{Node, about, alternatives, parse, range};
use egui::{Checkbox, ComboBox, DragValue, RichText, TextEdit, Ui};

/// Editor of settings fields.
pub(super) struct Fields<'a> {
    /// Search text that filters fields by name, including their children; empty shows all.
    pub search: &'a str,
}

impl Fields<'_> {
    /// Shows and edits the children of a value.
    pub fn children(&self, ui: &mut Ui, path: &str, node: &mut Node) {
        let own = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
        match node {
            Node::Fields(_, fields) => {
                for (name, value) in fields {
                    self.field(ui, &own(name), name, value);
                }
            }
            // Colors and other vectors stay on one line.
            Node::Items(_, items) if items.iter().all(|item| matches!(item, Node::Word(_))) => {
                ui.horizontal_wrapped(|ui| {
                    for (index, value) in items.iter_mut().enumerate() {
                        self.word(ui, &own(&index.to_string()), value, None);
                    }
                });
            }
            Node::Items(_, items) => {
                for (index, value) in items.iter_mut().enumerate() {
                    self.field(ui, &own(&index.to_string()), &index.to_string(), value);
                }
            }
            Node::Word(_) => {}
        }
    }

    /// Returns whether the displayed name of a field or of a descendant, with its groups, contains all search words.
    pub fn is_found(&self, path: &str, node: &Node) -> bool {
        let shown = path.replace(['_', '.'], " ").to_lowercase();
        let mut words = self.search.split_whitespace().map(|word| word.replace(['_', '.'], " ").to_lowercase());
        words.all(|word| shown.contains(&word))
            || node.children().iter().any(|(name, child)| self.is_found(&format!("{path}.{name}"), child))
    }

    /// Shows a field: its name, its value, and its children below.
    fn field(&self, ui: &mut Ui, path: &str, name: &str, node: &mut Node) {
        if !self.is_found(path, node) {
            return;
        }
        let words = name.replace('_', " ");
        let tip = about(path);
        let holds = !matches!(node, Node::Word(_));
        if !holds || alternatives(path).is_some() {
            ui.horizontal(|ui| {
                let label = ui.label(words.as_str());
                let id = label.id;
                if let Some(tip) = &tip {
                    label.on_hover_text(tip);
                }
                if let Some(all) = alternatives(path) {
                    self.choice(ui, path, &all, node, id);
                } else {
                    self.word(ui, path, node, Some(id));
                }
            });
            if !node.children().is_empty() {
                ui.indent(path, |ui| self.children(ui, path, node));
            }
        } else {
            let open = !self.search.trim().is_empty() || path.matches('.').count() == 0;
            let header = egui::CollapsingHeader::new(RichText::new(words).strong()).id_salt(path);
            let header = header.default_open(open).open((!self.search.trim().is_empty()).then_some(true));
            let shown = header.show(ui, |ui| self.children(ui, path, node));
            if let Some(tip) = tip {
                shown.header_response.on_hover_text(tip);
            }
        }
    }

    /// Shows a list of variants, or a check box for an optional value.
    fn choice(&self, ui: &mut Ui, path: &str, all: &[String], node: &mut Node, label: egui::Id) {
        let name_of = |node: &Node| node.variant().unwrap_or("on").to_owned();
        let now = name_of(node);
        let is_switch = all.len() == 2 && all[0] == "None";
        if is_switch {
            let mut on = now != "None";
            let was_word = matches!(node, Node::Word(_)) && on;
            ui.horizontal(|ui| {
                let switch = ui.add(Checkbox::without_text(&mut on)).labelled_by(label);
                if switch.changed() {
                    replace(node, &all[usize::from(on)]);
                } else if was_word {
                    // Optional number.
                    self.word(ui, path, node, Some(label));
                }
            });
            return;
        }
        let list = ComboBox::from_id_salt(path).selected_text(now.as_str()).show_ui(ui, |ui| {
            for text in all {
                let Ok(other) = parse(text) else { continue };
                let name = name_of(&other);
                if ui.selectable_label(name == now, name.as_str()).clicked() && name != now {
                    *node = other;
                }
            }
        });
        list.response.labelled_by(label);
    }

    /// Shows a scalar: a boolean, a number, or other text.
    fn word(&self, ui: &mut Ui, path: &str, node: &mut Node, label: Option<egui::Id>) {
        let Node::Word(word) = node else { return };
        let named = |response: egui::Response| match label {
            Some(label) => response.labelled_by(label),
            None => response.on_hover_text(path),
        };
        if let Ok(mut on) = word.parse::<bool>() {
            if named(ui.add(Checkbox::without_text(&mut on))).changed() {
                *word = on.to_string();
            }
            return;
        }
        let whole = !word.contains(['.', 'e', 'E']);
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => {
                let mut changed = number;
                let mut drag = DragValue::new(&mut changed).max_decimals(if whole { 0 } else { 5 });
                drag = match range(path) {
                    Some([low, high]) => {
                        let span = (high - low).min(100.0 * number.abs().max(0.01));
                        drag.range(low..=high).speed(if whole { 0.1 } else { span / 400.0 })
                    }
                    None => drag.speed(if whole { 0.1 } else { 0.01 * number.abs().max(0.05) }),
                };
                if named(ui.add(drag)).changed() && changed != number {
                    *word = if whole { format!("{changed:.0}") } else { format!("{changed:?}") };
                }
            }
            _ => _ = named(ui.add(TextEdit::singleline(word).desired_width(90.0))),
        }
    }
}

fn replace(node: &mut Node, text: &str) {
    if let Ok(other) = parse(text) {
        *node = other;
    }
}
