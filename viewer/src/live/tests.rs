//! Tests of a live frame that another thread works on.

use super::drawing::Done;
use super::*;
use crate::what_if::WhatIf;
use framegraph::Caps;
use framegraph_passes::{FrameSettings, Preset};
use framegraph_scene::environment::ShWindow;
use framegraph_wgpu::debug::{Mode, Modes};
use framegraph_wgpu::inspect::all_targets;
use framegraph_wgpu::{AdapterRequest, Gpu};
use std::sync::mpsc::{Sender, channel};

/// Light setting that is not the default.
const OTHER: ShWindow = ShWindow::Laplacian { lambda: 0.02 };
/// Timeout of work on another thread.
const PATIENCE: Duration = Duration::from_secs(300);

/// Returns a loaded scene with its session; `None` without a device.
fn loaded(test: &str, scene: &str, wake: impl Fn() + Send + Sync + 'static) -> Option<(Live, Session)> {
    let gpu = match Gpu::open(&AdapterRequest::from_env()) {
        Ok(gpu) => gpu,
        Err(error) => {
            test_report::skip(test, &error.to_string());
            return None;
        }
    };
    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    let frame = FrameSettings { lod_error_px: 0.0, ..Preset::Low.frame() };
    let document = Document { frame, ..Document::default() };
    let mut live = Live::new(Screen::new(&gpu, None), document, scene, None, wake);
    assert!(live.settle(&mut session, PATIENCE) && live.running.is_some(), "{:?}", session.messages);
    Some((live, session))
}

#[test]
fn a_panic_while_drawing_is_reported_and_the_scene_can_be_loaded_again() {
    let name = "a_panic_while_drawing_is_reported_and_the_scene_can_be_loaded_again";
    let Some((mut live, mut session)) = loaded(name, "columns", || {}) else { return };
    live.work("drawing", &mut session, |_, _| panic!("expected by the test"));
    assert!(live.settle(&mut session, PATIENCE), "the work ends");
    let expected = "internal error: drawing ended without a result; load the scene again";
    assert_eq!(session.messages, [expected]);
    assert!(live.running.is_none() && !live.wants_frame());
    live.load("columns");
    assert!(live.settle(&mut session, PATIENCE) && live.wants_frame());
}

/// Begins to draw on another thread, which reports progress, and then waits until the returned sender is dropped.
fn begin_frame(live: &mut Live, session: &mut Session, modes: Modes) -> Sender<()> {
    let (go, wait) = channel::<()>();
    let (begun, begins) = channel();
    let (document, options) = (live.document().clone(), DrawOptions { modes, ..live.options.clone() });
    live.work("compiling pipelines", session, move |running, handle| {
        handle.step(1, 2);
        let _ = begun.send(());
        let _ = wait.recv();
        let result = running.draw([64, 64], &document, &options, &mut |_, _| ());
        Done::Drawn(Box::new((document, options.modes)), result)
    });
    begins.recv_timeout(PATIENCE).expect("the thread begins");
    go
}

/// Changes a setting and returns the previous document.
fn change(live: &mut Live, intensity: f32) -> Document {
    let before = live.document().clone();
    let mut document = before.clone();
    document.capture.environment_intensity = intensity;
    live.set(document, false);
    before
}

#[test]
fn stop_undoes_only_the_change_that_compiles_pipelines() {
    let name = "stop_undoes_only_the_change_that_compiles_pipelines";
    let Some((mut live, mut session)) = loaded(name, "columns", || {}) else { return };
    drop(begin_frame(&mut live, &mut session, Modes::default()));
    assert!(live.settle(&mut session, PATIENCE));
    let before = change(&mut live, 2.0);
    let go = begin_frame(&mut live, &mut session, Modes::default());
    // The panels continue while the thread waits.
    live.tick(&mut session, 0.0);
    assert!(live.is_drawing() && live.can_cancel());
    live.cancel();
    drop(go);
    assert!(live.settle(&mut session, PATIENCE));
    assert_eq!(*live.document(), before, "the change is undone");
    assert!(!live.can_cancel() && live.wants_frame());
    // The repeated frame of these settings, for example at another size, undoes nothing more.
    change(&mut live, 3.0);
    drop(begin_frame(&mut live, &mut session, Modes::default()));
    assert!(live.settle(&mut session, PATIENCE));
    let go = begin_frame(&mut live, &mut session, Modes::default());
    live.cancel();
    drop(go);
    assert!(live.settle(&mut session, PATIENCE));
    assert_eq!(live.document().capture.environment_intensity, 3.0);
    assert!(session.messages.is_empty(), "{:?}", session.messages);
}

#[test]
fn the_plan_belongs_to_the_settings_that_were_drawn() {
    let name = "the_plan_belongs_to_the_settings_that_were_drawn";
    let Some((mut live, mut session)) = loaded(name, "columns", || {}) else { return };
    let go = begin_frame(&mut live, &mut session, Modes(vec![Mode::NoCull]));
    // The settings change while the frame is drawn.
    let drawn = change(&mut live, 2.0);
    drop(go);
    assert!(live.settle(&mut session, PATIENCE));
    assert_eq!(live.drawn_with, (drawn, Modes(vec![Mode::NoCull])));
    let base = session.questions.as_ref().expect("a plan").asked.clone();
    assert!(!base.cull, "the drawn mode disables culling");
}

/// Requests other light with other settings, and waits until its preparation has begun.
fn change_light(live: &mut Live, session: &mut Session, window: ShWindow) {
    let mut document = live.document().clone();
    document.frame.settings.shading.window = window;
    live.set(document, false);
    live.tick(session, 0.0);
    assert_eq!(live.doing().map(|(doing, _)| doing), Some("preparing light"));
}

#[test]
fn light_that_is_ready_while_another_thread_draws_is_kept() {
    let name = "light_that_is_ready_while_another_thread_draws_is_kept";
    let (sender, woken) = channel();
    let wake = move || _ = sender.send(());
    let Some((mut live, mut session)) = loaded(name, "columns", wake) else { return };
    change_light(&mut live, &mut session, OTHER);
    // Another thread has the frame while the light becomes ready.
    let running = live.running.take();
    for ready in ["the scene", "the light"] {
        woken.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("{ready} is ready"));
    }
    live.tick(&mut session, 0.0);
    live.running = running;
    live.tick(&mut session, 0.0);
    let drawn = live.running.as_ref().map(|running| running.loaded.light_settings);
    assert_eq!((drawn, live.doing()), (Some(live.light_settings()), None));
    assert!(live.metered_ev100() != 0.0 && session.messages.is_empty());
}

#[test]
fn stopped_light_is_not_prepared_again_until_it_changes() {
    let name = "stopped_light_is_not_prepared_again_until_it_changes";
    let Some((mut live, mut session)) = loaded(name, "columns", || {}) else { return };
    let before = live.document().frame.settings.shading.window;
    let light = live.light_settings();
    for lent in [false, true] {
        change_light(&mut live, &mut session, OTHER);
        let running = if lent { live.running.take() } else { None };
        live.cancel();
        live.tick(&mut session, 0.0);
        live.running = running.or(live.running.take());
        live.tick(&mut session, 0.0);
        assert_eq!(live.doing(), None, "lent: {lent}");
        assert_eq!(live.running.as_ref().map(|running| running.loaded.light_settings), Some(light));
        // An undone and repeated change is a new request.
        let mut document = live.document().clone();
        document.frame.settings.shading.window = before;
        live.set(document, false);
        live.tick(&mut session, 0.0);
    }
    // A custom sun of the clear sky is requested by the settings, too.
    let mut document = live.document().clone();
    document.capture.sun = capture::Sun::CUSTOM;
    live.set(document, false);
    live.tick(&mut session, 0.0);
    assert!(live.doing().is_some());
    live.cancel();
    live.tick(&mut session, 0.0);
    assert_eq!(live.doing(), None);
}

#[test]
fn settings_are_never_saved_over_the_scene_while_another_thread_draws() {
    let name = "settings_are_never_saved_over_the_scene_while_another_thread_draws";
    let folder = std::env::temp_dir().join(format!("framegraph-viewer-live-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let scene = folder.join("scene.glb");
    std::fs::copy("../tests/assets/models/suzi.glb", &scene).expect("a scene");
    if let Some((mut live, _)) = loaded(name, &scene.to_string_lossy(), || {}) {
        assert_eq!(live.read(), std::slice::from_ref(&scene));
        live.running = None;
        assert_eq!(live.read(), std::slice::from_ref(&scene));
        let refused = live.save(&scene).expect_err("it is an input");
        assert!(refused.contains("input"), "{refused}");
    }
    std::fs::remove_dir_all(folder).expect("it exists");
}

#[test]
fn a_texture_is_shown_only_while_it_is_selected() {
    let name = "a_texture_is_shown_only_while_it_is_selected";
    let Some((mut live, mut session)) = loaded(name, "columns", || {}) else { return };
    drop(begin_frame(&mut live, &mut session, Modes::default()));
    assert!(live.settle(&mut session, PATIENCE));
    let textures = {
        let mut names: Vec<_> = all_targets(live.running.as_ref().expect("a frame").plan());
        names.retain(|target| target.number > 0);
        names.dedup_by(|a, b| a.name == b.name);
        [names[0].name.clone(), names[1].name.clone()]
    };
    let begin = |live: &mut Live, texture: &str| {
        live.preview.look_at(texture);
        let (running, preview) = (live.running.as_ref().expect("a frame"), &mut live.preview);
        let (target, mut inspector) = preview.begin(running, 0).expect("a new selection");
        let found = preview::read(running, &mut inspector, target.clone());
        assert!(found.is_ok() && preview.is_reading());
        (inspector, target, found)
    };
    let (inspector, target, found) = begin(&mut live, &textures[0]);
    // Another texture is selected before the first one has been read.
    live.preview.look_at(&textures[1]);
    live.preview.take(inspector, &target, found);
    assert!(live.preview.found.is_none() && !live.preview.is_reading());
    let (inspector, target, found) = begin(&mut live, &textures[1]);
    live.preview.take(inspector, &target, found);
    let title = |live: &Live| live.preview.found.as_ref().map(|found| found.title.clone()).expect("texels");
    assert!(title(&live).starts_with(&textures[1]), "{}", title(&live));
    // An error of the first texture does not belong to the second one either.
    let (inspector, target, _) = begin(&mut live, &textures[0]);
    live.preview.look_at(&textures[1]);
    live.preview.take(inspector, &target, Err("an error".into()));
    assert!(live.preview.error.is_none() && title(&live).starts_with(&textures[1]));
}
