//! Debug modes, their bisection, and budget limits.

use super::texture;
use crate::drawing::Ink;
use crate::live::Live;
use crate::live::bisecting::Bisecting;
use crate::panel::{color, theme};
use crate::session::Session;
use egui::{Grid, RichText, ScrollArea, TextEdit, Ui, vec2};
use framegraph_check::Budget;
use framegraph_wgpu::debug::Mode;

/// Shows debug modes, bisection and limits.
pub fn debugging(ui: &mut Ui, live: &mut Live, session: &mut Session) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        modes(ui, live);
        ui.separator();
        bisecting(ui, live, session);
        ui.separator();
        budget(ui, live, session);
    });
}

fn modes(ui: &mut Ui, live: &mut Live) {
    ui.strong("debug modes");
    let mut modes = live.options.modes.clone();
    for mode in Mode::ALL {
        let mut on = modes.0.contains(&mode);
        let tip = format!("If the picture changes in this mode: {}", mode.likely_cause());
        if ui.checkbox(&mut on, mode.name()).on_hover_text(tip).changed() {
            modes.0.retain(|other| *other != mode);
            modes.0.extend(on.then_some(mode));
        }
    }
    if modes != live.options.modes {
        // `immediate` implies the other modes, so apply it last.
        modes.0.sort_by_key(|mode| Mode::ALL.iter().position(|other| other == mode));
        live.options.modes = modes;
        live.again();
    }
}

fn bisecting(ui: &mut Ui, live: &mut Live, session: &mut Session) {
    ui.horizontal(|ui| {
        ui.strong("bisect");
        let can = live.running.as_ref().and_then(|running| running.picture());
        let tip = "Draw the frame in each debug mode and list those that change the picture";
        let begin = ui.add_enabled(can.is_some(), egui::Button::new("Compare")).on_hover_text(tip).clicked();
        if let Some((_, size_px)) = can.filter(|_| begin) {
            live.bisect(Bisecting::new(live.document().clone(), &live.options, size_px), session);
        }
        if live.bisecting.is_some() && ui.button("Close").clicked() {
            live.bisecting = None;
            live.again();
        }
    });
    let Some(bisecting) = &mut live.bisecting else { return };
    let theme = theme(ui);
    Grid::new("outcomes").num_columns(4).striped(true).show(ui, |ui| {
        for heading in ["mode", "picture", "pixels", "max difference"] {
            ui.label(RichText::new(heading).weak());
        }
        ui.end_row();
        for (index, outcome) in bisecting.outcomes.iter().enumerate() {
            if ui.selectable_label(bisecting.shown == index, outcome.name()).clicked() {
                bisecting.shown = index;
            }
            let (word, ink) = if outcome.is_same() { ("same", Ink::Text) } else { ("different", Ink::Worse) };
            ui.label(RichText::new(word).color(color(ink, theme)));
            ui.label(outcome.pixels.to_string());
            ui.label(outcome.max_difference.to_string());
            ui.end_row();
        }
    });
    match bisecting.outcomes.iter().find(|outcome| !outcome.is_same()) {
        Some(first) => ui.add(
            egui::Label::new(format!(
                "{} is the first mode that changes the picture: {}",
                first.name(),
                first.likely_cause()
            ))
            .wrap(),
        ),
        None => ui.label("no mode changes the picture"),
    };
    let Some(pictures) = bisecting.pictures(bisecting.shown) else { return };
    let [width, height] = bisecting.size_px.map(|side| side as f32);
    let shown = ui.available_width().min(width);
    let size = vec2(shown, shown * height / width.max(1.0));
    for (name, rgba) in ["unmodified", "with the mode", "difference times 16"].into_iter().zip(pictures) {
        ui.label(name);
        let handle = texture(ui.ctx(), name, bisecting.shown as u64 + 1, bisecting.size_px, &rgba);
        ui.image((handle.id(), size));
    }
}

fn budget(ui: &mut Ui, live: &mut Live, session: &Session) {
    ui.strong("budget");
    let hint = "steps=4,bytes=64MiB,traffic=100MB";
    let tip = "Limits as in `plan --budget`: NAME=MAX,... with loads, stores, steps, culled, bytes, traffic";
    ui.add(TextEdit::singleline(&mut live.budget).hint_text(hint).desired_width(f32::INFINITY)).on_hover_text(tip);
    if live.budget.trim().is_empty() {
        return;
    }
    let error = |ui: &mut Ui, text: &str| {
        let text = RichText::new(text).color(ui.visuals().error_fg_color);
        ui.add(egui::Label::new(text).wrap());
    };
    let budget = match Budget::parse(live.budget.trim()) {
        Ok(budget) => budget,
        Err(message) => return error(ui, &message),
    };
    match session.plan.as_ref().and_then(|plan| plan.plan.as_ref()) {
        None => _ = ui.label("A saved plan has no graph to explain the costs. Open the graph"),
        Some(plan) => match budget.check(plan) {
            Ok(()) => _ = ui.label("The plan meets all limits"),
            Err(exceeded) => exceeded.to_string().lines().for_each(|line| error(ui, line)),
        },
    }
}
