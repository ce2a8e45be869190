//! The panels in an application of eframe.

mod frame;

use eframe::{App, Frame, NativeOptions};
use framegraph_egui::PlanPanels;

struct Program {
    plan: framegraph::Plan,
    panels: PlanPanels,
}

impl App for Program {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut Frame) {
        self.panels.update(&self.plan);
        self.panels.show(ui);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let plan = frame::plan(true)?;
    let program = Program { plan, panels: PlanPanels::new() };
    eframe::run_native("frame", NativeOptions::default(), Box::new(|_| Ok(Box::new(program))))?;
    Ok(())
}
