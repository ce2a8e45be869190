//! Channels, range and zoom.

use crate::live::preview::Preview;
use crate::live::preview::look::Shown;
use egui::{DragValue, Ui};

/// Names of the channels.
const CHANNELS: [(&str, &str); 4] = [("R", "red"), ("G", "green"), ("B", "blue"), ("A", "alpha")];

/// Shows the controls that apply to the format of the texture.
pub(super) fn controls(ui: &mut Ui, preview: &mut Preview) {
    let Some(found) = preview.found.clone() else { return };
    let look = &mut preview.look;
    ui.horizontal_wrapped(|ui| {
        let count = found.channels();
        if count > 1 {
            for (channel, (letter, name)) in CHANNELS.into_iter().enumerate().take(count) {
                let tip = format!("Show the {name} channel; secondary click: only this one");
                let button = ui.selectable_label(look.channels[channel], letter).on_hover_text(tip);
                if button.secondary_clicked() {
                    look.channels = [0, 1, 2, 3].map(|other| other == channel);
                } else if button.clicked() {
                    look.channels[channel] ^= true;
                    if !look.channels.contains(&true) {
                        look.channels[channel] = true;
                    }
                }
            }
            ui.separator();
        }
        let mut shown = look.shown;
        ui.selectable_value(&mut shown, Shown::Values, "values").on_hover_text("Values of the channels");
        if found.is_depth() && found.near_m > 0.0 {
            let tip = "Distance from the camera in meters";
            ui.selectable_value(&mut shown, Shown::Distance, "distance").on_hover_text(tip);
        }
        let tip = "First displayed channel in the Turbo color map";
        ui.selectable_value(&mut shown, Shown::FalseColor, "false color").on_hover_text(tip);
        if shown != look.shown {
            let was = std::mem::replace(&mut look.shown, shown);
            if was == Shown::Distance || shown == Shown::Distance {
                look.range = look.whole(&found);
            }
        }
        if count >= 3 && look.shown == Shown::Values {
            ui.checkbox(&mut look.srgb, "sRGB").on_hover_text("Encode linear light for the display");
        }
        ui.checkbox(&mut preview.follow, "live").on_hover_text("Update in every frame");
    });
    let mut again = false;
    ui.horizontal_wrapped(|ui| {
        let look = &mut preview.look;
        let speed = 0.005 * (found.span[1] - found.span[0]).abs().max(1e-3);
        let words = if look.shown == Shown::FalseColor { ["first", "last"] } else { ["black", "white"] };
        for (end, word) in look.range.iter_mut().zip(words) {
            ui.add(DragValue::new(end).speed(speed).max_decimals(4).prefix(format!("{word} ")))
                .on_hover_text("End of the displayed range");
        }
        if ui.small_button("min–max").on_hover_text("From the minimum to the maximum value").clicked() {
            look.range = look.whole(&found);
        }
        if look.shown != Shown::Distance && ui.small_button("0–1").on_hover_text("From 0 to 1").clicked() {
            look.range = [0.0, 1.0];
        }
        ui.separator();
        if ui.small_button("Fit").on_hover_text("Show the whole texture").clicked() {
            preview.pan.fit();
        }
        if ui.small_button("1:1").on_hover_text("One texel per pixel of the screen").clicked() {
            preview.pan.set_zoom(1.0 / ui.ctx().pixels_per_point());
        }
        again = ui.small_button("Refresh").on_hover_text("Read the texture again").clicked();
        if preview.is_reading() {
            ui.spinner();
        }
    });
    if again {
        preview.again();
    }
}
