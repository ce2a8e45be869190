//! Texture preview: version and subresource, display mode, histogram, and values under the pointer.

use super::texture;
use crate::drawing::Item;
use crate::live::Live;
use crate::live::preview::{CHANNELS, Found, Preview};
use crate::session::Session;
use egui::{Color32, ComboBox, DragValue, Pos2, Rect, Sense, Ui, pos2, vec2};
use framegraph_wgpu::inspect::{Channel, DisplayMode, InspectTarget};

/// Shows the texture of the selected resource.
pub fn preview(ui: &mut Ui, live: &mut Live, session: &Session) {
    if !session.is_live() {
        ui.label("Only textures of the live frame have contents. Show its plan from the viewport");
        return;
    }
    let Some(running) = &live.running else {
        ui.label("No frame has been drawn yet");
        return;
    };
    let preview = &mut live.preview;
    let plan = session.plan.as_ref();
    if let Some((Item::Resource(index), plan)) = session.selected.zip(plan)
        && let Some(resource) = plan.form.resources.get(index)
    {
        preview.look_at(&resource.name);
    }
    let targets = preview.targets(running);
    ui.horizontal_wrapped(|ui| {
        let mut names: Vec<String> = plan.map_or_else(Vec::new, |plan| {
            plan.form.resources.iter().filter(|r| r.format.is_some()).map(|r| r.name.clone()).collect()
        });
        names.sort_unstable();
        let shown = preview.name.clone().unwrap_or_else(|| "select a texture".into());
        ComboBox::from_id_salt("texture")
            .selected_text(shown)
            .show_ui(ui, |ui| {
                for name in names {
                    if ui.selectable_label(preview.name.as_ref() == Some(&name), &name).clicked() {
                        preview.look_at(&name);
                    }
                }
            })
            .response
            .on_hover_text("Displayed texture; follows the selected resource");
        parts(ui, preview, &targets);
    });
    modes(ui, preview);
    let frames = running.plans() ^ (u64::from(running.drawn()) << 20);
    preview.refresh(running, frames);
    if let Some(error) = &preview.error {
        ui.add(egui::Label::new(error).wrap());
    }
    if let Some(found) = &preview.found {
        contents(ui, found);
    }
}

/// Shows the selection of version, mip level, layer, plane and sample.
fn parts(ui: &mut Ui, preview: &mut Preview, targets: &[InspectTarget]) {
    let mut versions: Vec<(usize, String)> = targets
        .iter()
        .map(|target| (target.number, target.writer.clone().unwrap_or_else(|| "on entry".into())))
        .collect();
    versions.dedup();
    let Some((newest, _)) = versions.last().cloned() else { return };
    let number = preview.version.unwrap_or(newest);
    let text =
        versions.iter().find(|(v, _)| *v == number).map_or_else(String::new, |(_, writer)| format!("by {writer}"));
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
    let of_version = || targets.iter().filter(|target| target.number == number);
    let mips = of_version().map(|target| target.mip).max().unwrap_or(0);
    let layers = of_version().map(|target| target.layer).max().unwrap_or(0);
    preview.mip = preview.mip.min(mips);
    preview.layer = preview.layer.min(layers);
    if mips > 0 {
        ui.add(DragValue::new(&mut preview.mip).range(0..=mips).speed(0.05).prefix("level "))
            .on_hover_text("Mip level");
    }
    if layers > 0 {
        ui.add(DragValue::new(&mut preview.layer).range(0..=layers).speed(0.05).prefix("layer "))
            .on_hover_text("Array layer or slice");
    }
    let mut planes: Vec<_> = of_version().map(|target| target.aspect).collect();
    planes.dedup();
    if planes.len() > 1 {
        for (index, plane) in planes.iter().enumerate().take(2) {
            ui.selectable_value(&mut preview.plane, index, format!("{plane:?}").to_lowercase());
        }
    }
    let text = preview.sample.map_or("average of samples".into(), |sample| format!("sample {sample}"));
    ui.menu_button(text, |ui| {
        for sample in [None, Some(0), Some(1), Some(2), Some(3)] {
            let text = sample.map_or("average".into(), |sample: u8| format!("sample {sample}"));
            if ui.selectable_label(preview.sample == sample, text).clicked() {
                preview.sample = sample;
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("Sample of a multisampled texture");
}

/// Shows the selection of the display mode.
fn modes(ui: &mut Ui, preview: &mut Preview) {
    let channel = match preview.mode {
        DisplayMode::Stretch { channel } | DisplayMode::Plain { channel } | DisplayMode::False { channel, .. } => {
            channel
        }
        _ => Channel::Red,
    };
    ui.horizontal_wrapped(|ui| {
        for (name, mode, tip) in [
            ("auto", DisplayMode::Auto, "Chosen by format"),
            ("color", DisplayMode::Color { stops: 0.0 }, "Linear light with an exposure in stops"),
            ("depth", DisplayMode::Depth { near_m: None }, "Distance from the camera"),
            ("stretch", DisplayMode::Stretch { channel }, "One channel, from its minimum to its maximum"),
            ("plain", DisplayMode::Plain { channel }, "One channel, from 0 to 1"),
            (
                "false color",
                DisplayMode::False { channel, range: None },
                "One channel in the Turbo color map, over a range",
            ),
        ] {
            let is = std::mem::discriminant(&preview.mode) == std::mem::discriminant(&mode);
            if ui.selectable_label(is, name).on_hover_text(tip).clicked() && !is {
                preview.mode = mode;
            }
        }
        ui.checkbox(&mut preview.follow, "live").on_hover_text("Update in every frame");
        if ui.small_button("Refresh").on_hover_text("Inspect the texture again").clicked() {
            preview.again();
        }
    });
    let span = preview.found.as_ref().map(|found| found.span).unwrap_or_default();
    ui.horizontal_wrapped(|ui| match &mut preview.mode {
        DisplayMode::Color { stops } => {
            ui.add(egui::Slider::new(stops, -16.0..=16.0).text("stops"));
        }
        DisplayMode::Stretch { channel } | DisplayMode::Plain { channel } => channels(ui, channel),
        DisplayMode::False { channel, range } => {
            channels(ui, channel);
            let mut own = range.is_some();
            if ui.checkbox(&mut own, "range").changed() {
                *range = own.then_some(span);
            }
            for end in range.iter_mut().flatten() {
                let drag = DragValue::new(end).speed(0.01 * (span[1] - span[0]).abs().max(1e-3));
                ui.add(drag).on_hover_text("Value of the first or last color");
            }
        }
        DisplayMode::Auto | DisplayMode::Depth { .. } => {}
    });
}

fn channels(ui: &mut Ui, channel: &mut Channel) {
    for (name, other) in CHANNELS {
        ui.selectable_value(channel, other, name);
    }
}

/// Shows the picture, the value under the pointer, and the histogram.
fn contents(ui: &mut Ui, found: &Found) {
    let [width, height] = found.texels.size;
    let room = vec2(ui.available_width(), (ui.available_height() - 120.0).max(80.0));
    let scale = (room.x / width.max(1) as f32).min(room.y / height.max(1) as f32).min(8.0);
    let size = vec2(width as f32, height as f32) * scale;
    let handle = texture(ui.ctx(), "preview", found.made, found.texels.size, &found.picture.rgba8);
    let (response, painter) = ui.allocate_painter(size.max(vec2(1.0, 1.0)), Sense::hover());
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(handle.id(), response.rect, whole, Color32::WHITE);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, format!("texture {}", found.title)));
    let under = response.hover_pos().and_then(|pointer| {
        let at = (pointer - response.rect.min) / scale;
        let at = [at.x.max(0.0) as u32, at.y.max(0.0) as u32];
        Some((at, found.texel(at)?))
    });
    let [low, high] = found.picture.range;
    ui.label(format!("{}  {width}x{height} {:?}", found.title, found.texels.format));
    let bad = found.picture.non_finite;
    let bad = if bad > 0 { format!("  {bad} texels NaN or infinite") } else { String::new() };
    ui.label(match under {
        Some(([x, y], numbers)) => {
            let numbers: Vec<String> = numbers[..found.texels.channels()].iter().map(|n| format!("{n:.6}")).collect();
            format!("{x}, {y}: {}", numbers.join("  "))
        }
        None => format!("range {low} to {high}{bad}"),
    });
    histogram(ui, found);
}

/// Shows the histogram with one line per channel, scaled to the maximum.
fn histogram(ui: &mut Ui, found: &Found) {
    let (response, painter) = ui.allocate_painter(vec2(ui.available_width(), 48.0), Sense::hover());
    let rect = response.rect;
    let inks = [[213, 94, 0], [0, 158, 115], [0, 114, 178], [128, 128, 128]];
    for (boxes, [r, g, b]) in found.histogram.iter().zip(inks) {
        let max = boxes.iter().copied().max().unwrap_or(1).max(1) as f32;
        let points: Vec<Pos2> = boxes
            .iter()
            .enumerate()
            .map(|(index, count)| {
                let x = rect.left() + rect.width() * (index as f32 + 0.5) / boxes.len() as f32;
                pos2(x, rect.bottom() - rect.height() * (*count as f32 / max).sqrt())
            })
            .collect();
        painter.add(egui::Shape::line(points, egui::Stroke::new(1.2, Color32::from_rgb(r, g, b))));
    }
    let [low, high] = found.span;
    response.on_hover_text(format!("Histogram from {low} to {high}: red, green, blue, alpha (square-root scale)"));
}
