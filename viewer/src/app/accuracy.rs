//! Pane of measured accuracy: time budget, comparison picture and plots.

mod strip;

use crate::accuracy_view;
use crate::drawing::Drawing;
use crate::panel::Canvas;
use crate::session::Session;
use egui::{Slider, Ui};
use strip::Strip;

/// State of the pane.
#[derive(Default)]
pub(super) struct AccuracyPane {
    canvas: Canvas,
    /// Drawing with the generation of its data.
    drawing: Option<(u64, Drawing)>,
    strip: Strip,
}

impl AccuracyPane {
    /// Resets the zoom, as for another document.
    pub fn reset(&mut self) {
        self.canvas = Canvas::default();
    }

    /// Shows the pane.
    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        let now = session.generation();
        let (_, drawing) = match self.drawing.take() {
            Some(made) if made.0 == now => self.drawing.insert(made),
            _ => self.drawing.insert((now, drawn(session))),
        };
        ui.horizontal(|ui| {
            self.canvas.bar(ui, drawing);
            let Some(data) = session.accuracy.clone() else { return };
            if let Some([fastest, finest]) = data.span_ms() {
                let mut budget_ms = session.budget_ms;
                let slider = Slider::new(&mut budget_ms, fastest..=finest).suffix(" ms").text("time budget");
                ui.add(slider)
                    .on_hover_text("Choose the most accurate frame within this time, as `render --budget-ms` does");
                session.allow_ms(budget_ms);
            }
            self.strip.choose(ui, &data);
        });
        self.strip.show(ui);
        self.canvas.show(ui, "accuracy", drawing, &[]);
    }
}

/// Draws the accuracy record of a session.
pub(super) fn drawn(session: &Session) -> Drawing {
    accuracy_view::drawing(session.accuracy.as_deref(), session.budget_ms)
}
