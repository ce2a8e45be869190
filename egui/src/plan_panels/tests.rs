//! Tests of the widget without a window.

use super::*;
use crate::synthetic;
use egui::{Context, RawInput, Rect, vec2};
use framegraph::Caps;

fn frame(ctx: &Context, panels: &mut PlanPanels, width: f32) {
    let screen_rect = Some(Rect::from_min_size(egui::Pos2::ZERO, vec2(width, 400.0)));
    let mut output = ctx.run_ui(RawInput { screen_rect, ..RawInput::default() }, |ui| panels.show(ui));
    output.textures_delta.clear();
}

#[test]
fn the_graph_of_the_plan_is_compiled_under_other_conditions() {
    let (ctx, mut panels) = (Context::default(), PlanPanels::new());
    frame(&ctx, &mut panels, 900.0);
    let data = synthetic::large(4).expect("a plan");
    let plan = data.plan.clone().expect("the plan of this process");
    panels.update(&plan);
    let first = panels.generation;
    panels.update(&plan);
    assert_eq!(panels.generation, first, "a plan that did not change is not read again");
    for tab in View::ALL.into_iter().map(Tab::View).chain([Tab::Search, Tab::WhatIf]) {
        panels.tab = tab;
        for width in [1.0, 300.0, 900.0] {
            frame(&ctx, &mut panels, width);
        }
    }
    assert!(panels.asked.is_none(), "nothing was asked");
    panels.selected = plan.graph().passes().first().map(|_| Item::Pass(0));
    panels.questions.as_mut().expect("the plan has a graph").asked.caps = Caps::tiler();
    let begun = std::time::Instant::now();
    while panels.asked.is_none() && begun.elapsed().as_secs() < 60 {
        frame(&ctx, &mut panels, 900.0);
    }
    let device = |panels: &PlanPanels| panels.plan().map(|plan| plan.form.caps.clone());
    assert_eq!((device(&panels).as_deref(), panels.error.as_deref()), (Some("tiler"), None));
    let questions = panels.questions.as_mut().expect("they are kept");
    questions.asked = questions.base.clone();
    frame(&ctx, &mut panels, 900.0);
    assert_eq!(device(&panels).as_deref(), Some("desktop"));
    // The selection is kept by name in the next plan.
    let next = synthetic::large(5).expect("a plan").plan.expect("the plan of this process");
    panels.update(&next);
    assert_eq!(panels.selected, Some(Item::Pass(0)));
    assert_eq!(data.form.passes[4].name, "show 4");
    panels.update(&plan);
    panels.selected = Some(Item::Pass(4));
    panels.update(&next);
    assert_eq!(panels.selected, None, "the next plan has no pass `show 4`");
}
