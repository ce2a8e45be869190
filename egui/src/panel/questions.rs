//! What-if panel: the frame under another device, size, order, memory aliasing or features.
//!
//! Plans are compiled without rendering and compared with the unmodified plan.

use crate::plan_data::PlanData;
use crate::view::{bytes, change, label};
use crate::what_if::{SIZES, WhatIf};
use egui::{ComboBox, DragValue, Grid, ScrollArea, TextEdit, Ui};
use framegraph::{Alias, Caps, Order};
use std::path::Path;

/// What-if questions and the state of their panel.
#[derive(Clone, Debug)]
pub struct Questions {
    /// Unmodified conditions.
    pub base: WhatIf,
    /// Requested conditions.
    pub asked: WhatIf,
    /// Typed path of a device file.
    device: String,
    /// Error of the device file.
    refused: Option<String>,
}

/// Plans that the panel compares.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// Unmodified plan.
    pub base: Option<&'a PlanData>,
    /// What-if plan.
    pub now: Option<&'a PlanData>,
    /// True while a plan is being compiled.
    pub planning: bool,
    /// Reads a device file, or returns an error of one line. Without it, devices are chosen from the presets.
    pub read_device: Option<fn(&Path) -> Result<Caps, String>>,
}

impl Questions {
    /// Starts without changes.
    pub fn new(base: WhatIf) -> Self {
        Self { asked: base.clone(), base, device: String::new(), refused: None }
    }

    /// Shows the questions and the comparison; returns whether the questions changed.
    pub fn show(&mut self, ui: &mut Ui, shown: Shown<'_>) -> bool {
        let before = self.asked.clone();
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            Grid::new("what_if").num_columns(2).show(ui, |ui| self.rows(ui, shown));
            // Outside of the grid, whose cells do not wrap.
            self.sizes(ui, shown);
            if let Some(refused) = &self.refused {
                ui.label(egui::RichText::new(refused).color(ui.visuals().error_fg_color));
            }
            self.features(ui);
            ui.horizontal(|ui| {
                if ui.add_enabled(self.asked != self.base, egui::Button::new("Reset")).clicked() {
                    self.asked = self.base.clone();
                }
                if shown.planning {
                    ui.spinner();
                    ui.label("compiling");
                }
            });
            ui.separator();
            answer(ui, shown);
        });
        before != self.asked
    }

    fn rows(&mut self, ui: &mut Ui, shown: Shown<'_>) {
        let device = super::term(ui, "device", "caps").id;
        let caps = ComboBox::from_id_salt("caps").selected_text(self.asked.caps.name.clone());
        let caps = caps.show_ui(ui, |ui| {
            for caps in Caps::PRESETS.iter().filter_map(|name| Caps::preset(name)) {
                let name = caps.name.clone();
                if ui.selectable_label(self.asked.caps == caps, name).clicked() {
                    self.asked.caps = caps;
                }
            }
        });
        caps.response.labelled_by(device);
        ui.end_row();
        if let Some(read) = shown.read_device {
            ui.label("device file");
            let edit = TextEdit::singleline(&mut self.device).hint_text("DEVICE.ron, then Enter");
            let edit = ui.add(edit.desired_width(150.0));
            if edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter)) {
                let caps = read(Path::new(self.device.trim()));
                self.refused = caps.map(|caps| self.asked.caps = caps).err();
            }
            ui.end_row();
        }
        let label = ui.label("size").id;
        let frame = self.frame(shown);
        ui.horizontal(|ui| {
            let mut size = frame;
            for side in &mut size {
                ui.add(DragValue::new(side).range(1..=16384).speed(8.0)).labelled_by(label);
            }
            if size != frame {
                self.asked.frame = Some(size);
            }
        });
        ui.end_row();
        super::term(ui, "order", "order");
        ui.horizontal(|ui| {
            ui.selectable_value(&mut self.asked.order, Order::Declared, "declared");
            ui.selectable_value(&mut self.asked.order, Order::Optimized, "optimized");
        });
        ui.end_row();
        super::term(ui, "memory", "alias");
        ui.horizontal(|ui| {
            ui.selectable_value(&mut self.asked.alias, Alias::Off, "off");
            ui.selectable_value(&mut self.asked.alias, Alias::Pool, "pool");
            ui.selectable_value(&mut self.asked.alias, Alias::Heap, "heap");
        });
        ui.end_row();
        for (name, switch) in [
            ("cull", &mut self.asked.cull),
            ("merge", &mut self.asked.merge),
            ("inline", &mut self.asked.inline),
            ("memoryless", &mut self.asked.memoryless),
        ] {
            ui.label("");
            let box_ = ui.checkbox(switch, name);
            let word = if name == "cull" {
                "culled"
            } else if name == "inline" {
                "inlined"
            } else {
                name
            };
            if let Some(meaning) = crate::glossary::meaning(word) {
                box_.on_hover_text(meaning);
            }
            ui.end_row();
        }
    }

    /// Returns the requested frame size.
    fn frame(&self, shown: Shown<'_>) -> [u32; 2] {
        self.asked.frame.or(shown.base.map(|plan| plan.form.frame)).unwrap_or([1920, 1080])
    }

    /// Shows common sizes.
    fn sizes(&mut self, ui: &mut Ui, shown: Shown<'_>) {
        let size = self.frame(shown);
        ui.horizontal_wrapped(|ui| {
            for (name, texels) in SIZES {
                if ui.selectable_label(size == texels, name).clicked() {
                    self.asked.frame = Some(texels);
                }
            }
        });
    }

    fn features(&mut self, ui: &mut Ui) {
        if !self.asked.features.is_empty() {
            ui.separator();
            ui.label("features");
        }
        for (name, on) in &mut self.asked.features {
            ui.checkbox(on, name.as_str());
        }
    }
}

/// Shows changed totals, and the most important others.
fn answer(ui: &mut Ui, shown: Shown<'_>) {
    let (Some(base), Some(now)) = (shown.base, shown.now) else { return };
    let theme = super::theme(ui);
    Grid::new("answer").num_columns(3).min_col_width(0.0).spacing([8.0, 2.0]).striped(true).show(ui, |ui| {
        for heading in ["total", "now", "change"] {
            ui.label(egui::RichText::new(heading).weak());
        }
        ui.end_row();
        for ((name, was, is_bytes), (_, is, _)) in base.form.totals.rows().into_iter().zip(now.form.totals.rows()) {
            if name == "optimal" || (was, is) == (0, 0) {
                continue;
            }
            let words = label(name);
            let small = egui::RichText::new(&words).size(11.0);
            super::term(ui, small, words.trim_end_matches(" bytes").trim_end_matches('s'));
            ui.label(if is_bytes { bytes(is) } else { is.to_string() });
            let ink = crate::view::cost_ink(name, was, is);
            ui.label(egui::RichText::new(change(was, is, is_bytes)).color(super::color(ink, theme)));
            ui.end_row();
        }
    });
}
