//! Material editor: properties and editable factors.

use super::goes_on;
use crate::live::Live;
use crate::live::factors::Factors;
use egui::{DragValue, Grid, Response, Slider, SliderClamping, Ui};
use framegraph_scene::Material;
use framegraph_scene::material::EmissiveUnit;

/// Shows and edits the selected material.
pub(super) fn material(ui: &mut Ui, live: &mut Live) {
    let shown = live.material.and_then(|number| Some((number, live.running.as_ref()?.material(number)?)));
    let Some((number, own)) = shown else { return };
    let scenes = Factors::of(own);
    let before = live.document().materials.get(&number).copied().unwrap_or(scenes);
    let mut factors = before;
    ui.separator();
    let mut closed = false;
    ui.horizontal(|ui| {
        ui.strong(if own.name.is_empty() { "(no name)" } else { &own.name });
        let tip = "Restore the values of the scene";
        if factors != scenes && ui.small_button("Reset").on_hover_text(tip).clicked() {
            factors = scenes;
        }
        closed = ui.small_button("Close").clicked();
    });
    Grid::new("material").num_columns(2).striped(true).show(ui, |ui| {
        changed(ui, own, &mut factors);
        properties(ui, own);
    });
    if factors != before {
        let mut document = live.document().clone();
        if factors == scenes {
            document.materials.remove(&number);
        } else {
            document.materials.insert(number, factors);
        }
        live.set(document, goes_on(ui.ctx()));
    }
    if closed {
        live.material = None;
    }
}

/// Adds a labeled widget.
fn row(ui: &mut Ui, name: &str, texture: bool, widget: impl FnOnce(&mut Ui) -> Response) {
    let label = ui.label(if texture { format!("{name} (× texture)") } else { name.to_owned() }).id;
    widget(ui).labelled_by(label);
    ui.end_row();
}

/// Shows editable factors.
fn changed(ui: &mut Ui, own: &Material, factors: &mut Factors) {
    // Values beyond the range of a slider stay until it is moved.
    let slider = |value, max| Slider::new(value, 0.0..=max).max_decimals(3).clamping(SliderClamping::Edits);
    row(ui, "base color", own.base_color_texture.is_some(), |ui| {
        let mut rgba = factors.base_color.to_array();
        let button = ui.color_edit_button_rgba_unmultiplied(&mut rgba);
        // The round trip through hue rounds values.
        if button.changed() {
            factors.base_color = rgba.into();
        }
        button
    });
    let surface = own.metallic_roughness_texture.is_some();
    row(ui, "metallic", surface, |ui| ui.add(slider(&mut factors.metallic, 1.0)));
    row(ui, "roughness", surface, |ui| ui.add(slider(&mut factors.roughness, 1.0)));
    row(ui, "index of refraction", false, |ui| ui.add(slider(&mut factors.ior, 3.0)));
    let strongest = factors.emissive.max_element();
    let unit = if own.emissive_unit == EmissiveUnit::Nits { " nits" } else { "" };
    row(ui, "emission", own.emissive_texture.is_some(), |ui| {
        let mut strength = strongest;
        let drag =
            DragValue::new(&mut strength).range(0.0..=1e6).clamp_existing_to_range(false).speed(0.05).suffix(unit);
        let drag = ui.add(drag).on_hover_text("Strongest channel; the color is kept");
        if strength != strongest {
            factors.emissive =
                if strongest > 0.0 { factors.emissive * (strength / strongest) } else { glam::Vec3::splat(strength) };
        }
        drag
    });
    if own.normal_texture.is_some() {
        row(ui, "normals", true, |ui| ui.add(slider(&mut factors.normal_scale, 4.0)));
    }
    if own.occlusion_texture.is_some() {
        row(ui, "occlusion", true, |ui| ui.add(slider(&mut factors.occlusion_strength, 1.0)));
    }
}

/// Shows read-only properties that select the shader.
fn properties(ui: &mut Ui, own: &Material) {
    let lobes: Vec<String> = own.lobes().iter().map(|lobe| format!("{lobe:?}")).collect();
    for (name, text) in [
        ("alpha", format!("{:?}", own.alpha)),
        ("sides", if own.double_sided { "both".into() } else { "front".into() }),
        ("lobes", if lobes.is_empty() { "-".into() } else { lobes.join(", ") }),
    ] {
        ui.label(name);
        ui.label(text);
        ui.end_row();
    }
}
