//! Answers of the panels while a scene is loaded and its first frame is drawn.

use crate::app::{Pane, Session, Viewer};
use crate::live::Live;
use crate::live::capture::Document;
use crate::live::screen::Screen;
use crate::what_if::WhatIf;
use egui::{Context, RawInput, Rect, pos2, vec2};
use framegraph::Caps;
use framegraph_wgpu::Gpu;
use std::time::{Duration, Instant};

/// Tabs that are clicked in turn.
const TABS: [Pane; 5] = [Pane::Settings, Pane::Effects, Pane::Lens, Pane::Scene, Pane::Debugging];
/// Pause between two frames.
const PAUSE: Duration = Duration::from_millis(4);

/// Frames of the panels while a scene loads, one for each click on a tab.
pub(super) struct Answers {
    /// CPU times of the frames, sorted.
    pub took: Vec<Duration>,
    /// Time until the first frame of the scene was drawn.
    pub loaded: Duration,
}

/// Loads a scene, turns to another tab in every frame of the panels, and measures these frames.
///
/// # Errors
/// The scene cannot be loaded or drawn.
pub(super) fn answers(gpu: &Gpu, scene: &str, size: [u32; 2]) -> Result<Answers, String> {
    let document = Document { frame: crate::standard_frame::settings("high")?, ..Document::default() };
    let live = Live::new(Screen::new(gpu, None), document, scene, None, || {});
    let mut viewer = Viewer::with(Session::new(WhatIf::on(Caps::wgpu()), || {}), live);
    let (ctx, begun, mut took) = (Context::default(), Instant::now(), Vec::new());
    crate::panel::dress(&ctx);
    let is_drawn = |viewer: &Viewer| {
        let running = viewer.live.as_ref().and_then(|live| live.running.as_ref());
        running.is_some_and(|running| running.drawn() > 0)
    };
    for tab in TABS.into_iter().cycle() {
        if is_drawn(&viewer) {
            break;
        }
        let works = |live: &Live| live.doing().is_some() || live.is_drawing() || live.wants_frame();
        if !viewer.live.as_ref().is_some_and(works) {
            let message = viewer.session.messages.last().cloned();
            return Err(message.unwrap_or_else(|| format!("{scene}: no frame was drawn")));
        }
        let screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0] as f32, size[1] as f32)));
        let time = Some(begun.elapsed().as_secs_f64());
        let clicked = Instant::now();
        viewer.turn_to(tab);
        let mut output = ctx.run_ui(RawInput { screen_rect, time, ..RawInput::default() }, |ui| viewer.show(ui));
        drop(ctx.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point));
        output.textures_delta.clear();
        took.push(clicked.elapsed());
        std::thread::sleep(PAUSE);
    }
    took.sort_unstable();
    Ok(Answers { took, loaded: begun.elapsed() })
}
