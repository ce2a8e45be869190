//! Cost of the panels: layout and scrolling of a large graph, and every panel of the standard frame.

mod loading;

use crate::app::{Pane, Session, Viewer};
use crate::offscreen::Offscreen;
use crate::standard_frame::StandardFrame;
use crate::synthetic::large;
use crate::view::{View, graph};
use crate::what_if::WhatIf;
use egui::{Context, Event, MouseWheelUnit, RawInput, Rect, TouchPhase, Vec2, pos2, vec2};
use framegraph::Caps;
use std::fmt::Write;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Window size in points and pixels.
const SIZE: [u32; 2] = [1280, 720];
/// Number of measured frames.
const FRAMES: usize = 40;

/// Measures and returns a Markdown table. `scene` is loaded while tabs are clicked: a built-in name or a path.
///
/// # Errors
/// An error of the standard frame, of the scene or of the device.
pub fn table(scene: &str) -> Result<String, String> {
    let profile = if cfg!(debug_assertions) { "not optimized" } else { "optimized" };
    let mut rows = vec![("measurement".to_owned(), format!("median, ms ({profile})"))];
    let plan = large(2000)?;
    let (passes, begun) = (plan.form.passes.len(), Instant::now());
    let drawing = graph::drawing(&plan, None);
    rows.push((format!("layout of a graph, {passes} passes"), ms(begun.elapsed())));
    drop(drawing);

    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    session.show_plan(plan);
    let mut viewer = Viewer::new(session);
    let (shown, idle) = frames(&mut viewer, true, None)?;
    rows.push((format!("CPU time of a frame while scrolling, {passes} passes"), ms(shown)));
    rows.push(("repaints without input".into(), if idle { "no" } else { "yes" }.into()));
    for view in [View::Timeline, View::Memory] {
        viewer.turn_to(Pane::View(view));
        let shown = frames(&mut viewer, true, None)?.0;
        rows.push((
            format!("CPU time of a frame while scrolling, {passes} passes, {} in front", view.word()),
            ms(shown),
        ));
    }
    viewer.turn_to(Pane::View(View::Graph));
    match Offscreen::as_windows() {
        Ok(mut screen) => {
            let drawn = frames(&mut viewer, true, Some(&mut screen))?.0;
            rows.push((format!("time of a frame while scrolling, drawn by {}", screen.gpu().describe()), ms(drawn)));
            let loading::Answers { took, loaded } = loading::answers(screen.gpu(), scene, SIZE)?;
            let (clicks, loaded_s) = (took.len(), loaded.as_secs_f64());
            let during = format!("while {scene} loads for {loaded_s:.1} s");
            rows.push((format!("from a click on a tab to its frame {during}, {clicks} clicks"), ms(took[clicks / 2])));
            let longest = took.last().copied().unwrap_or_default();
            rows.push((format!("longest time from a click on a tab to its frame {during}"), ms(longest)));
        }
        Err(error) => rows.push(("no device".into(), error)),
    }

    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    session.show(Arc::new(StandardFrame::open("high")?));
    session.settle(Duration::from_secs(60));
    let mut viewer = Viewer::new(session);
    let panes = View::ALL.into_iter().filter(|view| view.is_of_a_plan()).map(Pane::View);
    for pane in panes.chain([Pane::WhatIf]) {
        viewer.turn_to(pane);
        rows.push((
            format!("CPU time of a frame, standard frame, {} in front", pane.word()),
            ms(frames(&mut viewer, false, None)?.0),
        ));
    }
    let mut text = String::new();
    for (index, (what, number)) in rows.iter().enumerate() {
        let _ = writeln!(text, "| {what} | {number} |");
        if index == 0 {
            text.push_str("| --- | ---: |\n");
        }
    }
    Ok(text)
}

/// Returns the median frame time, drawn on `screen` if present, and whether egui stays idle without input.
fn frames(viewer: &mut Viewer, scrolls: bool, mut screen: Option<&mut Offscreen>) -> Result<(Duration, bool), String> {
    let ctx = Context::default();
    crate::panel::dress(&ctx);
    let (mut took, mut idle) = (Vec::new(), false);
    let size = vec2(SIZE[0] as f32, SIZE[1] as f32);
    for frame in 0..FRAMES + 40 {
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), size)),
            time: Some(frame as f64 / 60.0),
            ..RawInput::default()
        };
        if scrolls && frame < FRAMES {
            let delta = Vec2::new(-30.0, if frame % 20 < 10 { -12.0 } else { 12.0 });
            let (unit, phase, modifiers) = (MouseWheelUnit::Point, TouchPhase::Move, egui::Modifiers::NONE);
            let source = egui::MouseWheelSource::Wheel;
            input.events.push(Event::PointerMoved(pos2(size.x / 2.0, size.y / 2.0)));
            input.events.push(Event::MouseWheel { unit, delta, phase, source, modifiers });
        }
        let begun = Instant::now();
        let mut output = ctx.run_ui(input, |ui| viewer.show(ui));
        idle = output.viewport_output.values().all(|viewport| viewport.repaint_delay > Duration::from_secs(3600));
        match &mut screen {
            Some(screen) => screen.frame(&ctx, output, SIZE)?,
            None => {
                drop(ctx.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point));
                output.textures_delta.clear();
            }
        }
        if (4..FRAMES).contains(&frame) {
            took.push(begun.elapsed());
        }
    }
    took.sort_unstable();
    Ok((took[took.len() / 2], idle))
}

fn ms(time: Duration) -> String {
    format!("{:.2}", time.as_secs_f64() * 1e3)
}
