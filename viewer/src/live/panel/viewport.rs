//! Viewport: the live frame at the available size, with pointer and key control of the camera.

use crate::live::Live;
use crate::live::camera::{Mode, Moves};
use crate::session::Session;
use egui::{Color32, Key, PointerButton, Rect, Sense, Ui, pos2, vec2};
use glam::{DVec2, DVec3};

/// Maximum side of the drawn frame, in pixels.
const MAX_PX: u32 = 8192;

/// Shows the frame and draws it after changes.
pub fn viewport(ui: &mut Ui, live: &mut Live, session: &mut Session) {
    bar(ui, live, session);
    let rect = ui.available_rect_before_wrap();
    if rect.width() < 2.0 || rect.height() < 2.0 {
        return;
    }
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "viewport"));
    steer(ui, live, &response, rect);
    let scale = ui.ctx().pixels_per_point() * live.share.clamp(0.1, 1.0);
    let max = live.screen.gpu.caps().max_texture_texels.min(MAX_PX) as f32;
    let size_px = [rect.width(), rect.height()].map(|side| (side * scale).round().clamp(1.0, max) as u32);
    if live.take_size(size_px) {
        live.again();
    }
    live.draw(size_px, session);
    let copied = live
        .copied_picture()
        .map(|copied| super::texture(ui.ctx(), "viewport", copied.made, copied.size_px, &copied.rgba8).id());
    let own = live.picture().map(|(id, _)| id).filter(|_| !live.has_own_device());
    match copied.or(own) {
        Some(id) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(id, rect, whole, Color32::WHITE);
            // Drawn over the picture, because a growing text line would change its size and thereby the measurement.
            let font = egui::FontId::monospace(11.0);
            let width = (rect.width() - 12.0).max(1.0);
            let words = ui.painter().layout(statistics(live), font, Color32::WHITE, width);
            let at = rect.left_bottom() + vec2(6.0, -6.0 - words.size().y);
            let behind = Rect::from_min_size(at, words.size()).expand(3.0);
            if !words.is_empty() {
                ui.painter().rect_filled(behind, 2.0, Color32::from_black_alpha(170));
                ui.painter().galley(at, words, Color32::WHITE);
            }
        }
        None => {
            let text = if live.doing().is_some() { "Loading" } else { "No scene: drop a glTF file here" };
            ui.painter().text(
                rect.center(),
                egui::Align2::CENTER_CENTER,
                text,
                egui::FontId::proportional(16.0),
                ui.visuals().text_color(),
            );
        }
    }
    if live.wants_frame() {
        ui.ctx().request_repaint_after(live.next_frame());
    }
}

/// Shows background work, camera mode and resolution.
fn bar(ui: &mut Ui, live: &mut Live, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        if let Some((doing, progress)) = live.doing().map(|(doing, progress)| (doing.to_owned(), progress)) {
            match progress {
                Some(share) => _ = ui.add(egui::ProgressBar::new(share).desired_width(80.0).show_percentage()),
                None => _ = ui.spinner(),
            }
            ui.label(doing);
            let tip = "Cancel the work and keep the displayed frame. Settings that need new pipelines are undone";
            if live.can_cancel() && ui.button("Stop").on_hover_text(tip).clicked() {
                live.cancel();
            }
            ui.separator();
        }
        let Some(rig) = &mut live.rig else { return };
        for (mode, name, tip) in [
            (Mode::Orbit, "orbit", "Drag to orbit, right-drag to pan, wheel to zoom"),
            (
                Mode::Fly,
                "fly",
                "Drag to look around; W A S D move, Q and E move down and up, Shift is four times as fast",
            ),
        ] {
            ui.selectable_value(&mut rig.mode, mode, name).on_hover_text(tip);
        }
        if ui.button("home").on_hover_text("Return to the camera of the scene").clicked() {
            rig.go_home();
            live.again();
        }
        let tip = "Draw continuously for measurements; otherwise only after changes";
        ui.checkbox(&mut live.continuous, "run").on_hover_text(tip);
        ui.menu_button(format!("{:.0} %", 100.0 * live.share), |ui| {
            for share in [1.0, 0.75, 0.5, 0.25] {
                if ui.selectable_label(live.share == share, format!("{:.0} %", 100.0 * share)).clicked() {
                    live.share = share;
                    live.again();
                    ui.close();
                }
            }
        })
        .response
        .on_hover_text("Rendered fraction of the viewport's sides");
        if !session.is_live()
            && ui.button("Show plan").on_hover_text("Show the plan of this frame in the views").clicked()
        {
            live.show_plan(session);
        }
    });
}

/// Returns frame rate, median CPU, GPU and latency times, size and counts.
fn statistics(live: &Live) -> String {
    let Some(running) = &live.running else { return String::new() };
    let times = running.frames().executor().timing().frame();
    let ms = |summary: Option<framegraph_wgpu::Summary>| summary.map_or("-".into(), |s| format!("{:.2}", s.median_ms));
    let fps = live.frames_per_s().map_or("-".into(), |fps| format!("{fps:.1}"));
    let [width, height] = running.picture().map_or([0, 0], |(_, size)| size);
    let triangles = running.loaded.scene.triangle_count();
    let flight = running.frames().frames_in_flight();
    format!(
        "{width}x{height}  {fps} fps  CPU {} ms  GPU {} ms  latency {} ms with {} frames queued  {triangles} triangles",
        ms(times.cpu),
        ms(times.gpu),
        ms(flight.latency()),
        flight.max()
    )
}

/// Moves the camera.
fn steer(ui: &Ui, live: &mut Live, response: &egui::Response, rect: Rect) {
    let Some(rig) = &mut live.rig else { return };
    let mut moves = Moves::default();
    let drag = response.drag_delta();
    let drag = DVec2::new(drag.x.into(), drag.y.into());
    if response.dragged_by(PointerButton::Primary) {
        moves.turn = drag;
    } else if response.dragged_by(PointerButton::Secondary) || response.dragged_by(PointerButton::Middle) {
        moves.shift = drag / f64::from(rect.height().max(1.0));
    }
    if response.hovered() || response.has_focus() || response.dragged() {
        let (scroll, passed_s) = ui.input(|i| (i.smooth_scroll_delta().y, f64::from(i.stable_dt.min(0.1))));
        moves.nearer = f64::from(scroll) / 50.0;
        if rig.mode == Mode::Fly && !ui.ctx().egui_wants_keyboard_input() {
            let held = |key: Key| f64::from(u8::from(ui.input(|i| i.key_down(key))));
            let fast = if ui.input(|i| i.modifiers.shift) { 4.0 } else { 1.0 };
            let right = held(Key::D) - held(Key::A);
            let (up, forward) = (held(Key::E) - held(Key::Q), held(Key::W) - held(Key::S));
            moves.fly_s = DVec3::new(right, up, forward) * passed_s * fast;
            if moves.fly_s != DVec3::ZERO {
                ui.ctx().request_repaint();
            }
        }
    }
    if rig.act(&moves) {
        live.again();
    }
}
