//! Camera and light: exposure, lens, environment, sun, background and fog.

use super::goes_on;
use crate::live::Live;
use crate::live::capture::{BackgroundSource, Capture, Exposure, Sun, focal_length_mm};
use egui::{Checkbox, DragValue, Grid, ScrollArea, Slider, TextEdit, Ui};
use framegraph_passes::DofSettings;
use framegraph_passes::effects::fog::FogSettings;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_scene::camera::EV100_RANGE;
use std::path::PathBuf;

/// Shows and edits camera and light.
pub fn lens(ui: &mut Ui, live: &mut Live, environment: &mut String) {
    let before = live.document().clone();
    let mut document = before.clone();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.strong("camera");
        Grid::new("camera").num_columns(2).show(ui, |ui| {
            exposure(ui, live, &mut document.capture);
            focal(ui, live, &mut document.capture);
            focus(ui, &mut document.frame.settings.dof);
        });
        ui.separator();
        ui.strong("environment");
        environment_source(ui, live, environment);
        Grid::new("environment").num_columns(2).show(ui, |ui| {
            let capture = &mut document.capture;
            row(ui, "intensity", |ui| {
                ui.add(Slider::new(&mut capture.environment_intensity, 0.0..=8.0).logarithmic(true))
            });
            let tip = "Rotate the picture and its sun about the vertical. A clear sky follows a custom sun";
            row(ui, "rotation", |ui| {
                ui.add(Slider::new(&mut capture.environment_turned_deg, -180.0..=180.0).suffix("°")).on_hover_text(tip)
            });
            background(ui, &mut capture.background);
        });
        ui.separator();
        ui.strong("sun");
        sun(ui, &mut document.capture.sun);
        shadows(ui, &mut document.frame.settings.shadows);
        ui.separator();
        ui.strong("fog");
        fog(ui, &mut document.frame.settings.fog);
    });
    if document != before {
        live.set(document, goes_on(ui.ctx()));
    }
}

/// Adds a labeled widget.
fn row(ui: &mut Ui, name: &str, widget: impl FnOnce(&mut Ui) -> egui::Response) {
    let label = ui.label(name).id;
    widget(ui).labelled_by(label);
    ui.end_row();
}

fn exposure(ui: &mut Ui, live: &Live, capture: &mut Capture) {
    let metered = live.metered_ev100();
    let now = capture.exposure.ev100(metered);
    ui.label("exposure");
    ui.horizontal(|ui| {
        let is = |exposure: Exposure| std::mem::discriminant(&capture.exposure) == std::mem::discriminant(&exposure);
        let camera = Exposure::Camera { aperture: 16.0, shutter_s: 1.0 / 125.0, iso: 100.0 };
        let all = [("metered", Exposure::Metered), ("EV100", Exposure::Ev100(now)), ("camera", camera)];
        let all = all.map(|(name, exposure)| (name, exposure, is(exposure)));
        for (name, exposure, is) in all {
            if ui.selectable_label(is, name).clicked() && !is {
                capture.exposure = exposure;
            }
        }
    });
    ui.end_row();
    match &mut capture.exposure {
        Exposure::Metered => {
            ui.label("EV100");
            ui.label(format!("{now:.2}"));
            ui.end_row();
        }
        Exposure::Ev100(value) => {
            row(ui, "EV100", |ui| ui.add(Slider::new(value, EV100_RANGE.0..=EV100_RANGE.1).max_decimals(2)));
        }
        Exposure::Camera { aperture, shutter_s, iso } => {
            row(ui, "aperture", |ui| ui.add(DragValue::new(aperture).range(0.5..=64.0).speed(0.05).prefix("f/")));
            let mut per_s = 1.0 / *shutter_s;
            row(ui, "shutter", |ui| {
                ui.add(DragValue::new(&mut per_s).range(0.01..=100_000.0).speed(1.0).prefix("1/").suffix(" s"))
            });
            *shutter_s = 1.0 / per_s;
            row(ui, "ISO", |ui| ui.add(DragValue::new(iso).range(1.0..=409_600.0).speed(5.0)));
            ui.label("EV100");
            ui.label(format!("{now:.2}"));
            ui.end_row();
        }
    }
}

fn focal(ui: &mut Ui, live: &Live, capture: &mut Capture) {
    let own = live.rig.as_ref().and_then(|rig| rig.fov_y_rad()).map(focal_length_mm);
    let Some(own) = own else { return };
    let mut mm = capture.focal_length_mm.unwrap_or(own);
    let label = ui.label("focal length").id;
    ui.horizontal(|ui| {
        let tip = "For a sensor 24 mm high; sets the field of view";
        let drag = DragValue::new(&mut mm).range(4.0..=800.0).speed(0.2).max_decimals(1).suffix(" mm");
        if ui.add(drag).labelled_by(label).on_hover_text(tip).changed() {
            capture.focal_length_mm = Some(mm);
        }
        if capture.focal_length_mm.is_some() && ui.small_button("Reset").clicked() {
            capture.focal_length_mm = None;
        }
    });
    ui.end_row();
}

fn focus(ui: &mut Ui, dof: &mut Option<DofSettings>) {
    let label = ui.label("depth of field").id;
    let mut on = dof.is_some();
    if ui.add(Checkbox::without_text(&mut on)).labelled_by(label).changed() {
        *dof = on.then_some(DofSettings::DEFAULT);
    }
    ui.end_row();
    if let Some(dof) = dof {
        row(ui, "focus distance", |ui| {
            ui.add(DragValue::new(&mut dof.focus_m).range(0.01..=1e4).speed(0.02).suffix(" m"))
        });
        row(ui, "DOF aperture", |ui| {
            ui.add(DragValue::new(&mut dof.f_number).range(0.5..=64.0).speed(0.05).prefix("f/"))
        });
    }
}

fn environment_source(ui: &mut Ui, live: &mut Live, path: &mut String) {
    ui.label(live.environment());
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 110.0).max(40.0);
        ui.add(TextEdit::singleline(path).hint_text("PICTURE.hdr, .exr or .ktx").desired_width(width));
        if ui.button("Open").clicked() && !path.trim().is_empty() {
            live.set_environment(Some(PathBuf::from(path.trim())));
        }
        if ui.button("Sky").on_hover_text("Use a clear sky").clicked() {
            live.set_environment(None);
        }
    });
}

fn background(ui: &mut Ui, source: &mut BackgroundSource) {
    ui.label("background");
    ui.horizontal(|ui| {
        let is_constant = matches!(source, BackgroundSource::Constant(_));
        if ui.selectable_label(!is_constant, "environment").clicked() {
            *source = BackgroundSource::Environment;
        }
        if ui.selectable_label(is_constant, "color").clicked() && !is_constant {
            *source = BackgroundSource::Constant([1000.0; 3]);
        }
        if let BackgroundSource::Constant(nits) = source {
            for channel in nits {
                ui.add(DragValue::new(channel).range(0.0..=1e6).speed(10.0)).on_hover_text("Radiance in nits");
            }
        }
    });
    ui.end_row();
}

fn sun(ui: &mut Ui, sun: &mut Sun) {
    ui.horizontal(|ui| {
        for (name, other) in [("from scene", Sun::FromScene), ("off", Sun::Off), ("custom", Sun::CUSTOM)] {
            let is = std::mem::discriminant(sun) == std::mem::discriminant(&other);
            if ui.selectable_label(is, name).clicked() && !is {
                *sun = other;
            }
        }
    });
    if let Sun::Custom { azimuth_deg, elevation_deg, illuminance_lux, diameter_deg } = sun {
        Grid::new("sun").num_columns(2).show(ui, |ui| {
            row(ui, "azimuth", |ui| ui.add(Slider::new(azimuth_deg, -180.0..=180.0).suffix("°")));
            row(ui, "elevation", |ui| ui.add(Slider::new(elevation_deg, -10.0..=90.0).suffix("°")));
            row(ui, "illuminance", |ui| ui.add(Slider::new(illuminance_lux, 0.0..=150_000.0).suffix(" lx")));
            row(ui, "diameter", |ui| ui.add(Slider::new(diameter_deg, 0.0..=10.0).suffix("°")));
        });
    }
}

fn shadows(ui: &mut Ui, shadows: &mut Option<ShadowSettings>) {
    let mut on = shadows.is_some();
    if ui.checkbox(&mut on, "shadows").changed() {
        *shadows = on.then_some(ShadowSettings::DEFAULT);
    }
    if let Some(own) = shadows {
        Grid::new("shadows").num_columns(2).show(ui, |ui| {
            row(ui, "cascades", |ui| ui.add(Slider::new(&mut own.cascades, 0..=4)));
            row(ui, "shadow-map size", |ui| ui.add(Slider::new(&mut own.map_texels, 256..=4096).step_by(256.0)));
            row(ui, "show cascades", |ui| {
                ui.add(Checkbox::without_text(&mut own.show_cascades)).on_hover_text("Tint surfaces by their cascade")
            });
        });
    }
}

fn fog(ui: &mut Ui, fog: &mut Option<FogSettings>) {
    let mut on = fog.is_some();
    if ui.checkbox(&mut on, "fog").changed() {
        *fog = on.then_some(FogSettings::DEFAULT);
    }
    if let Some(own) = fog {
        Grid::new("fog").num_columns(2).show(ui, |ui| {
            row(ui, "density", |ui| ui.add(Slider::new(&mut own.density, 0.0..=10.0).logarithmic(true)));
            row(ui, "start distance", |ui| {
                ui.add(DragValue::new(&mut own.start_m).range(0.0..=1e4).speed(0.1).suffix(" m"))
            });
            row(ui, "height", |ui| ui.add(DragValue::new(&mut own.height_m).range(-1e4..=1e4).speed(0.1).suffix(" m")));
            row(ui, "height falloff", |ui| ui.add(Slider::new(&mut own.falloff, 0.0..=10.0).logarithmic(true)));
            row(ui, "max opacity", |ui| ui.add(Slider::new(&mut own.most_opacity, 0.0..=1.0)));
        });
    }
}
