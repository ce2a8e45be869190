//! Live frame next to its plan: settings and panels.

use crate::folder;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use framegraph::Caps;
use framegraph_passes::{Effect, FrameSettings, Preset, Settings};
use framegraph_wgpu::debug::{Mode, Modes};
use framegraph_wgpu::{AdapterRequest, Gpu};
use std::sync::Arc;
use std::time::Duration;
use viewer::app::{Pane, Session, Viewer};
use viewer::live::Live;
use viewer::live::capture::Document;
use viewer::live::screen::Screen;
use viewer::plan_data::PlanData;
use viewer::what_if::WhatIf;

/// Timeout of loading and preparing light.
const PATIENCE: Duration = Duration::from_secs(300);

/// Returns the cheapest preset with ambient occlusion, for a scene with a shadow-casting light. Levels of detail are
/// disabled, because creating them dominates the test time.
pub fn document() -> Document {
    let mut frame = FrameSettings { lod_error_px: 0.0, ..Preset::Low.frame() };
    frame.settings = Settings::with(frame.settings, Effect::Occlusion);
    Document { frame, ..Document::default() }
}

/// Creates a viewer with a live frame on a device.
pub fn viewer(screen: &Screen, document: Document, scene: &str) -> Viewer {
    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    let mut live = Live::new(screen.clone(), document, scene, None, || {});
    assert!(live.settle(&mut session, PATIENCE), "loading takes five minutes");
    assert!(live.running.is_some(), "{:?}", session.messages);
    live.options.forced = true;
    live.share = 0.1;
    live.wait_for_frames();
    Viewer::with(session, live)
}

/// Creates a harness of a viewer with a live frame; `None` without a device.
pub fn harness(name: &str, scene: &str) -> Option<Harness<'static, Viewer>> {
    let gpu = match Gpu::open(&AdapterRequest::from_env()) {
        Ok(gpu) => gpu,
        Err(error) => {
            test_report::skip(name, &error.to_string());
            return None;
        }
    };
    test_report::adapter(&gpu.describe());
    let mut viewer = viewer(&Screen::new(&gpu, None), document(), scene);
    viewer.turn_to(Pane::Viewport);
    let mut harness = Harness::builder()
        .with_size([1280.0, 720.0])
        .with_max_steps(200)
        .build_ui_state(|ui, viewer: &mut Viewer| viewer.show(ui), viewer);
    harness.run();
    Some(harness)
}

pub fn live<'a>(harness: &'a mut Harness<'_, Viewer>) -> &'a mut Live {
    harness.state_mut().live.as_mut().expect("a frame is drawn")
}

pub fn plan(harness: &Harness<'_, Viewer>) -> Arc<PlanData> {
    harness.state().session.plan.clone().expect("a plan")
}

/// Shows changes until nothing changes.
pub fn settled(harness: &mut Harness<'_, Viewer>) {
    let viewer = harness.state_mut();
    let Viewer { live, session, .. } = viewer;
    assert!(live.as_mut().expect("a frame").settle(session, PATIENCE) && session.settle(PATIENCE));
    harness.run();
    assert!(harness.state_mut().session.settle(PATIENCE));
    harness.run();
}

#[test]
fn an_effect_that_is_switched_off_is_not_drawn_and_undo_draws_it_again() {
    let name = "an_effect_that_is_switched_off_is_not_drawn_and_undo_draws_it_again";
    let Some(mut harness) = harness(name, "columns") else { return };
    let before = plan(&harness);
    let made: Vec<_> = before.form.passes.iter().map(|p| p.name.clone()).filter(|p| p.contains("occlusion")).collect();
    assert!(made.len() > 2, "{made:?}");
    // The displayed plan is the executed one.
    let counts = |harness: &mut Harness<'_, Viewer>| live(harness).running.as_ref().expect("a frame").plan().counts();
    let (executed, shown) = (counts(&mut harness), before.form.totals);
    assert_eq!((u64::from(executed.passes), u64::from(executed.steps)), (shown.passes, shown.steps));
    assert!(before.declared_at.iter().all(|place| place.contains(".rs:")));

    harness.state_mut().turn_to(Pane::Effects);
    harness.run();
    harness.get_by_label("ao").click();
    harness.run();
    settled(&mut harness);
    let now = plan(&harness);
    assert!(made.iter().all(|name| now.pass(name).is_none()));
    assert!(now.form.totals.passes < shown.passes && u64::from(counts(&mut harness).passes) == now.form.totals.passes);
    let ghosts = viewer::view::graph::drawing(&now, harness.state().session.against()).words();
    assert!(made.iter().all(|name| ghosts.contains(name.as_str())), "{ghosts}");

    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run();
    settled(&mut harness);
    assert_eq!(plan(&harness).form.totals, shown);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Y);
    harness.run();
    settled(&mut harness);
    assert_eq!(plan(&harness).form.totals, now.form.totals);
}

/// The frame is planned whatever pane is visible.
#[test]
fn the_graph_follows_an_effect_while_the_viewport_is_hidden() {
    let name = "the_graph_follows_an_effect_while_the_viewport_is_hidden";
    let Some(mut harness) = harness(name, "columns") else { return };
    let arrangement = harness.state().arrangement().expect("an arrangement");
    // Viewport and graph stand side by side.
    for label in ["viewport", "graph view"] {
        assert!(harness.query_all_by_label(label).count() > 0, "{label}");
    }
    let before = plan(&harness);
    // One container of tabs has every pane, so that only one is visible.
    let state = harness.state_mut();
    state.arrange_all_in_tabs();
    state.turn_to(Pane::View(viewer::view::View::Graph));
    harness.run();
    assert_eq!(harness.query_all_by_label("settings").count(), 1, "only its tab");
    let mut document = live(&mut harness).document().clone();
    document.frame.settings.occlusion = None;
    live(&mut harness).set(document, false);
    harness.run();
    let after = plan(&harness);
    assert!(after.form.totals.passes < before.form.totals.passes, "the graph shows the frame without occlusion");
    harness.state_mut().arrange(&arrangement);
    harness.run();
}

/// Pipelines are created on another thread: the panels continue, show the progress, and *Stop* undoes the change.
#[test]
fn pipelines_do_not_block_the_panels() {
    let name = "pipelines_do_not_block_the_panels";
    let Some(mut harness) = harness(name, "columns") else { return };
    live(&mut harness).draw_in_background();
    let before = live(&mut harness).document().clone();
    let mut document = before.clone();
    // The pipelines of all effects take longer than the panels wait for a frame.
    for effect in Effect::ALL {
        document.frame.settings = Settings::with(document.frame.settings, effect);
    }
    live(&mut harness).set(document, false);
    let (mut steps, mut stopped, mut ended) = (0, false, false);
    let begun = std::time::Instant::now();
    while !ended && begun.elapsed() < PATIENCE {
        harness.step();
        let live = live(&mut harness);
        steps += u32::from(live.is_drawing());
        if !stopped && live.can_cancel() {
            live.cancel();
            stopped = true;
        }
        ended = !live.is_drawing() && !live.wants_frame();
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(ended, "the frame settles; {steps} steps while it was drawn");
    assert!(steps >= 2, "the panels continue while the frame is drawn on another thread: {steps} steps");
    assert!(stopped, "the compilation of pipelines can be stopped");
    assert_eq!(*live(&mut harness).document(), before, "the change is undone");
}

#[test]
fn what_facts_drop_is_told_beside_its_switch() {
    let name = "what_facts_drop_is_told_beside_its_switch";
    let Some(mut harness) = harness(name, "columns") else { return };
    live(&mut harness).options.forced = false;
    live(&mut harness).again();
    harness.run();
    harness.state_mut().turn_to(Pane::Effects);
    harness.run();
    let facts = live(&mut harness).running.as_ref().expect("a frame").facts.clone();
    let row =
        facts.rows.iter().find(|row| facts.dropped().contains(row.effect)).expect("the scene needs not everything");
    let told = format!("dropped: {}", row.reason);
    assert!(harness.query_all_by_label_contains(&told).count() > 0, "{told}");
}

/// Requesting levels of detail creates them once.
#[test]
fn levels_of_detail_are_made_when_they_are_asked_for() {
    let Some(mut harness) = harness("levels_of_detail_are_made_when_they_are_asked_for", "spheres") else { return };
    let levels = |harness: &mut Harness<'_, Viewer>| {
        let loaded = &live(harness).running.as_ref().expect("a frame").loaded;
        loaded.scene.meshes.iter().map(|mesh| mesh.levels.len()).sum::<usize>()
    };
    assert_eq!(levels(&mut harness), 0);
    let asked = live(&mut harness).document().clone();
    let frame = FrameSettings { lod_error_px: 1.0, ..asked.frame };
    live(&mut harness).set(Document { frame, ..asked }, false);
    settled(&mut harness);
    assert!(levels(&mut harness) > 2);
}

#[test]
fn four_k_is_asked_of_the_frame_that_is_drawn() {
    let name = "four_k_is_asked_of_the_frame_that_is_drawn";
    let Some(mut harness) = harness(name, "columns") else { return };
    let before = plan(&harness).form.clone();
    harness.state_mut().arrange_all_in_tabs();
    harness.state_mut().turn_to(Pane::WhatIf);
    harness.run();
    harness.get_by_label("4K").click();
    harness.run();
    settled(&mut harness);
    let after = plan(&harness);
    let session = &harness.state().session;
    let told = (&session.messages, session.questions.as_ref().map(|questions| questions.asked.frame));
    assert_eq!(after.form.frame, [3840, 2160], "{told:?}");
    assert!(after.form.totals.resolve_bytes > before.totals.resolve_bytes);
    let drawn = live(&mut harness).running.as_ref().expect("a frame").plan().frame();
    assert_eq!(drawn, before.frame, "only the plan is of another size");
    harness.get_by_label("Reset").click();
    harness.run();
    settled(&mut harness);
    assert_eq!(plan(&harness).form.totals, before.totals);
}

#[test]
fn a_bad_file_keeps_the_scene() {
    let name = "a_bad_file_keeps_the_scene";
    let Some(mut harness) = harness(name, "columns") else { return };
    let place = folder("live_bad");
    let (gltf, hdr) = (place.join("broken.gltf"), place.join("broken.hdr"));
    std::fs::write(&gltf, "{\"asset\": {").expect("a file");
    std::fs::write(&hdr, "#?RADIANCE\n").expect("a file");
    for path in [gltf, hdr] {
        harness.state_mut().open(&path, viewer::app::Role::Shown);
        settled(&mut harness);
        let named = path.file_name().expect("a name").to_string_lossy().into_owned();
        assert!(harness.query_all_by_label_contains(&named).count() > 0, "{named} is in a message");
        let loaded = &live(&mut harness).running.as_ref().expect("a scene").loaded;
        assert_eq!(loaded.name, "columns");
        assert!(matches!(loaded.environment, viewer::live::loading::EnvironmentSource::Sky(_)));
        harness.get_by_label("Close").click();
        harness.run();
    }
    // A valid scene replaces it.
    live(&mut harness).load("glass");
    settled(&mut harness);
    assert_eq!(live(&mut harness).running.as_ref().expect("a scene").loaded.name, "glass");
}

#[test]
fn looking_at_textures_changes_no_count() {
    let name = "looking_at_textures_changes_no_count";
    let Some(mut harness) = harness(name, "columns") else { return };
    let before = plan(&harness);
    harness.state_mut().turn_to(Pane::Preview);
    harness.run();
    for texture in before.form.resources.iter().filter(|r| r.format.is_some()).map(|r| r.name.clone()) {
        live(&mut harness).preview.look_at(&texture);
        harness.run();
        let preview = &live(&mut harness).preview;
        let found = preview.found.as_ref().map(|found| (found.title.clone(), found.numbers.len()));
        let plain = texture.split('#').next().expect("a name");
        assert!(
            found.is_some_and(|(title, texels)| title.starts_with(plain) && texels > 0),
            "{texture}: {:?}",
            preview.error
        );
    }
    let running = live(&mut harness).running.as_ref().expect("a frame");
    assert_eq!(u64::from(running.plan().counts().passes), before.form.totals.passes);
    assert_eq!(plan(&harness).form.totals, before.form.totals);
    // The preview shows the contents of the picture: more than one color.
    live(&mut harness).preview.look_at("picture");
    harness.run();
    let preview = &live(&mut harness).preview;
    let (found, picture) = (preview.found.as_ref().expect("texels"), preview.picture.as_ref().expect("a picture"));
    let first = picture.rgba8[..4].to_vec();
    assert!(picture.rgba8.chunks(4).any(|texel| texel != first), "the picture is one color");
    assert!(found.texel([0, 0]).is_some() && found.texel(found.texels.size).is_none());
}

#[test]
fn debug_modes_are_executed_and_compared() {
    let name = "debug_modes_are_executed_and_compared";
    let Some(mut harness) = harness(name, "columns") else { return };
    let before = plan(&harness);
    live(&mut harness).options.modes = Modes(vec![Mode::Immediate]);
    live(&mut harness).again();
    harness.run();
    let immediate = plan(&harness);
    assert!(immediate.form.totals.steps > before.form.totals.steps);
    live(&mut harness).options.modes = Modes::default();
    live(&mut harness).again();
    harness.run();
    harness.state_mut().turn_to(Pane::Debugging);
    harness.run();
    harness.get_by_label("Compare").click();
    harness.run();
    let bisecting = live(&mut harness).bisecting.as_ref().expect("it has begun");
    assert!(bisecting.is_done() && bisecting.outcomes.len() == Mode::ALL.len() + 1);
    // A separate grading pass reads radiance rounded by a small float format, and FXAA then finds other edges.
    let differ: Vec<_> = bisecting.outcomes.iter().filter(|o| !o.is_same()).map(|o| o.name()).collect();
    assert_eq!(differ, ["no-inline", "immediate"]);
    assert_eq!(bisecting.pictures(0).map(|pictures| pictures[2].iter().step_by(4).any(|code| *code > 0)), Some(false));
    // An exceeded budget is reported with the responsible decisions.
    live(&mut harness).budget = "steps=0".into();
    harness.run();
    assert!(harness.query_all_by_label_contains("budget exceeded: steps").count() > 0);
}

#[test]
fn settings_go_to_a_file_and_come_back() {
    let name = "settings_go_to_a_file_and_come_back";
    let Some(mut harness) = harness(name, "columns") else { return };
    let path = folder("live_settings").join("own.ron");
    let document = live(&mut harness).document().clone();
    live(&mut harness).save(&path).expect("a file");
    harness.state_mut().turn_to(Pane::Settings);
    harness.run();
    harness.get_by_label("medium").click();
    harness.run();
    assert_eq!(live(&mut harness).document().frame, Preset::Medium.frame());
    harness.state_mut().open(&path, viewer::app::Role::Shown);
    harness.run();
    assert_eq!(*live(&mut harness).document(), document);
    // Saving is confirmed, and the search finds names as they are displayed.
    live(&mut harness).path = path.display().to_string();
    harness.run();
    harness.get_by_label("Save").click();
    harness.run();
    harness.get_by_label_contains("saved ");
    live(&mut harness).settings.search = "LOD error px".into();
    harness.run();
    assert!(harness.query_all_by_label("lod error px").count() > 0);
    assert_eq!(harness.query_all_by_label("quality").count(), 0);
    live(&mut harness).settings.search = "no such field".into();
    harness.run();
    harness.get_by_label("no field matches `no such field`");
}

#[test]
fn a_frame_that_stands_still_is_not_drawn() {
    let name = "a_frame_that_stands_still_is_not_drawn";
    let Some(mut harness) = harness(name, "columns") else { return };
    harness.run();
    let drawn = live(&mut harness).running.as_ref().expect("a frame").drawn();
    let idle = harness.output().viewport_output.values().map(|viewport| viewport.repaint_delay).min();
    assert!(idle.is_some_and(|delay| delay > Duration::from_secs(3600)), "{idle:?}");
    harness.step();
    assert_eq!(live(&mut harness).running.as_ref().expect("a frame").drawn(), drawn);
}

#[test]
fn every_panel_is_there_and_every_widget_has_a_name() {
    let name = "every_panel_is_there_and_every_widget_has_a_name";
    let Some(mut harness) = harness(name, "materials") else { return };
    let everything = Effect::ALL.into_iter().fold(Settings::DEFAULT, Settings::with);
    for settings in [Settings::DEFAULT, everything] {
        let mut document = live(&mut harness).document().clone();
        document.frame.settings = Settings { taa: None, reflections: None, ..settings };
        live(&mut harness).set(document, false);
        for pane in [Pane::Settings, Pane::Effects, Pane::Lens, Pane::Scene, Pane::Debugging, Pane::Preview] {
            harness.state_mut().turn_to(pane);
            harness.run();
            harness.check_accessibility();
            assert!(harness.query_all_by_label(pane.word()).count() > 0, "{pane:?}");
        }
    }
    assert!(harness.state().session.messages.is_empty(), "{:?}", harness.state().session.messages);
}
