//! Selection of version, mip level, layer, plane and sample, limited to those that exist.

use crate::live::preview::Preview;
use egui::{ComboBox, DragValue, Ui};

/// Shows the selection. `samples` is the number of samples of the texture.
pub(super) fn parts(ui: &mut Ui, preview: &mut Preview, samples: u64) {
    let targets = &preview.targets;
    let mut versions: Vec<(usize, String)> = targets
        .iter()
        .map(|target| (target.number, target.writer.clone().unwrap_or_else(|| "on entry".into())))
        .collect();
    versions.dedup();
    let Some((newest, _)) = versions.last().cloned() else { return };
    let number = preview.version.unwrap_or(newest);
    let text =
        versions.iter().find(|(v, _)| *v == number).map_or_else(String::new, |(_, writer)| format!("by {writer}"));
    if versions.len() > 1 {
        ComboBox::from_id_salt("version")
            .selected_text(text)
            .show_ui(ui, |ui| {
                for (version, writer) in &versions {
                    if ui.selectable_label(*version == number, format!("by {writer}")).clicked() {
                        preview.version = Some(*version);
                    }
                }
            })
            .response
            .on_hover_text("Version: contents after this pass");
    } else {
        ui.label(text);
    }
    let of_version = || preview.targets.iter().filter(|target| target.number == number);
    let mips = of_version().map(|target| target.mip).max().unwrap_or(0);
    let layers = of_version().map(|target| target.layer).max().unwrap_or(0);
    let mut planes: Vec<_> = of_version().map(|target| target.aspect).collect();
    planes.sort_unstable_by_key(|plane| *plane as u8);
    planes.dedup();
    preview.mip = preview.mip.min(mips);
    preview.layer = preview.layer.min(layers);
    if mips > 0 {
        ui.add(DragValue::new(&mut preview.mip).range(0..=mips).speed(0.05).prefix("level "))
            .on_hover_text(format!("Mip level, 0 to {mips}"));
    }
    if layers > 0 {
        ui.add(DragValue::new(&mut preview.layer).range(0..=layers).speed(0.05).prefix("layer "))
            .on_hover_text(format!("Array layer or slice, 0 to {layers}"));
    }
    if planes.len() > 1 {
        for (index, plane) in planes.iter().enumerate() {
            ui.selectable_value(&mut preview.plane, index, format!("{plane:?}").to_lowercase());
        }
    }
    if samples > 1 {
        let text = preview.sample.map_or("average".into(), |sample| format!("sample {sample}"));
        ComboBox::from_id_salt("sample")
            .selected_text(text)
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut preview.sample, None, "average");
                for sample in 0..samples.min(16) as u8 {
                    ui.selectable_value(&mut preview.sample, Some(sample), format!("sample {sample}"));
                }
            })
            .response
            .on_hover_text("Sample of the multisampled texture");
    } else {
        preview.sample = None;
    }
}
