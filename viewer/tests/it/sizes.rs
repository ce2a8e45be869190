//! Every view and pane at sizes from 1×1 to 8K, without data, with one pass, and with 2,000 passes.

use crate::{case, folder, session, session_of};
use egui::{Context, Event, PointerButton, RawInput, Rect, pos2, vec2};
use framegraph::Caps;
use std::time::{Duration, Instant};
use viewer::app::{Pane, Session, Viewer};
use viewer::view::View;
use viewer::what_if::WhatIf;

/// Sizes of the window in points.
const SIZES: [[f32; 2]; 9] = [
    [1.0, 1.0],
    [2.0, 700.0],
    [21.0, 21.0],
    [40.0, 23.0],
    [64.0, 48.0],
    [320.0, 100.0],
    [1280.0, 720.0],
    [7680.0, 4320.0],
    [5.0, 5.0],
];

/// Panes without a live frame.
fn panes() -> impl Iterator<Item = Pane> {
    Pane::drawn().chain([Pane::List, Pane::WhatIf])
}

/// Shows one frame of the viewer at a size, with some events. Returns the number of painted shapes.
pub fn frame(ctx: &Context, viewer: &mut Viewer, size: [f32; 2], events: Vec<Event>) -> usize {
    let input = RawInput {
        screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]))),
        events,
        ..RawInput::default()
    };
    let mut output = ctx.run_ui(input, |ui| viewer.show(ui));
    let shapes = output.shapes.len();
    drop(ctx.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point));
    output.textures_delta.clear();
    shapes
}

fn shown_at_every_size(viewer: &mut Viewer) {
    let ctx = Context::default();
    viewer::panel::dress(&ctx);
    for pane in panes() {
        viewer.turn_to(pane);
        for size in SIZES {
            let middle = pos2(size[0] / 2.0, size[1] / 2.0);
            let button = |pressed| Event::PointerButton {
                pos: middle,
                button: PointerButton::Primary,
                pressed,
                modifiers: egui::Modifiers::NONE,
            };
            frame(&ctx, viewer, size, vec![Event::PointerMoved(middle), button(true)]);
            frame(&ctx, viewer, size, vec![Event::PointerMoved(middle + vec2(900.0, -900.0)), button(false)]);
        }
    }
}

#[test]
fn no_size_stops_a_window_without_data() {
    shown_at_every_size(&mut Viewer::new(Session::new(WhatIf::on(Caps::wgpu()), || {})));
}

#[test]
fn no_size_stops_a_window_with_one_pass() {
    let path = folder("one_pass").join("one.ron");
    let text = r#"(version: 1, name: "one", resources: [
        Texture(name: "screen", format: Rgba8Unorm, kind: Import(entry: Undefined, exit: Keep)),
    ], passes: [Raster(name: "only", accesses: [Color(to: "screen", intent: ClearColor(0, 0, 0, 1))])])"#;
    std::fs::write(&path, text).expect("a file");
    shown_at_every_size(&mut Viewer::new(session(&path)));
    let mut with_features = Viewer::new(session_of(&case("filament"), &["shadows", "sao", "taa"]));
    shown_at_every_size(&mut with_features);
}

#[test]
fn no_size_stops_a_window_with_two_thousand_passes() {
    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    session.show_plan(viewer::synthetic::large(2000).expect("a plan"));
    let mut viewer = Viewer::new(session);
    shown_at_every_size(&mut viewer);
    // The layout on another thread arrives.
    let (ctx, end) = (Context::default(), Instant::now() + Duration::from_secs(120));
    let first = viewer::drawing::Item::Pass(0);
    viewer.turn_to(Pane::View(View::Graph));
    while viewer.place_of(View::Graph, first).is_none() {
        assert!(Instant::now() < end, "the graph is laid out in less than two minutes");
        frame(&ctx, &mut viewer, [1280.0, 720.0], Vec::new());
        viewer.select(Some(first));
    }
}
