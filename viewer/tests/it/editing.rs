//! Edits in the window: materials and curves; and exported files.

use crate::folder;
use crate::live::{harness, live, plan, settled};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use framegraph_wgpu::read_texture;
use std::collections::BTreeMap;
use std::path::Path;
use viewer::app::dialog::Purpose;
use viewer::app::{Pane, Role, Viewer};
use viewer::drawing::Theme;
use viewer::graph_source::GraphSource;
use viewer::live::factors::Factors;
use viewer::trace_data;
use viewer::view::View;
use viewer::what_if::{Planner, WhatIf};

/// Returns the pixels of the viewport.
fn picture(harness: &mut Harness<'_, Viewer>) -> Vec<u8> {
    settled(harness);
    let running = live(harness).running.as_ref().expect("a frame");
    let texture = running.picture_texture().expect("a picture");
    read_texture(&running.screen().gpu, texture).expect("it can be read").rgba8()
}

#[test]
fn a_material_is_changed_and_comes_back() {
    let Some(mut harness) = harness("a_material_is_changed_and_comes_back", "columns") else { return };
    // Dither differs in every frame.
    let mut document = live(&mut harness).document().clone();
    document.frame.settings.post.dither = 0.0;
    live(&mut harness).set(document, false);
    let before = picture(&mut harness);
    harness.state_mut().turn_to(Pane::Scene);
    harness.run();
    let scene = &live(&mut harness).running.as_ref().expect("a frame").loaded.scene;
    let number = scene.instances[0].material.index();
    let name = scene.materials[number].name.clone();
    let buttons = harness.get_all_by_role_and_label(egui::accesskit::Role::Button, &name);
    buttons.into_iter().next().expect("the material of an instance").click();
    harness.run();
    assert_eq!(live(&mut harness).material, Some(number));
    // Selecting a material changes nothing.
    assert_eq!(live(&mut harness).document().materials, BTreeMap::new());
    assert!(picture(&mut harness) == before, "the frame is the same");

    let mut document = live(&mut harness).document().clone();
    let own = live(&mut harness).running.as_ref().and_then(|r| r.material(number)).map(Factors::of).expect("factors");
    let red = Factors { base_color: glam::Vec4::new(1.0, 0.0, 0.0, 1.0), metallic: 0.0, ..own };
    document.materials = BTreeMap::from([(number, red)]);
    live(&mut harness).set(document, false);
    let painted = picture(&mut harness);
    assert!(painted != before, "the ground is red");
    let survey = |harness: &mut Harness<'_, Viewer>| {
        live(harness).running.as_ref().map(|r| r.loaded.scene.materials[number].metallic).expect("a frame")
    };
    assert_eq!(survey(&mut harness), 0.0, "facts are decided for what is drawn");
    harness.run();
    harness.get_by_label("Reset").click();
    harness.run();
    assert!(live(&mut harness).document().materials.is_empty());
    assert!(picture(&mut harness) == before, "the picture is restored");
    assert!(live(&mut harness).history.undo());
    live(&mut harness).again();
    assert!(picture(&mut harness) == painted, "undo paints it again");
    // Another scene has other materials.
    live(&mut harness).load("glass");
    settled(&mut harness);
    assert!(live(&mut harness).document().materials.is_empty() && live(&mut harness).material.is_none());
}

#[test]
fn a_curve_is_dragged_by_its_handle() {
    let Some(mut harness) = harness("a_curve_is_dragged_by_its_handle", "columns") else { return };
    harness.state_mut().turn_to(Pane::Settings);
    harness.run();
    harness.get_by_label("curves").click();
    harness.run();
    harness.get_by_label("green").click();
    harness.run();
    let grading = |harness: &mut Harness<'_, Viewer>| live(harness).document().frame.settings.post.look.grading;
    let before = grading(&mut harness);
    let at = harness.get_by_label("shadow gamma").rect().center();
    harness.drag_at(at);
    harness.run();
    harness.hover_at(at + egui::vec2(0.0, 30.0));
    harness.run();
    harness.drop_at(at + egui::vec2(0.0, 30.0));
    harness.run();
    let after = grading(&mut harness);
    assert!(after.shadow_gamma.y > 1.2 && after.shadow_gamma.x == 1.0, "darker greens: {after:?}");
    assert_eq!((after.middle, after.highlight_scale), (before.middle, before.highlight_scale));
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run();
    assert_eq!(grading(&mut harness), before, "a drag is one step of undo");
}

#[test]
fn plans_graphs_and_times_are_written_and_read_again() {
    let Some(mut harness) = harness("plans_graphs_and_times_are_written_and_read_again", "columns") else { return };
    let shown = plan(&harness);
    let place = folder("live_export");
    let write = |harness: &mut Harness<'_, Viewer>, purpose, name: &str| {
        let path = place.join(name);
        harness.state_mut().chosen(purpose, &path, Theme::Light);
        path
    };
    let graph = Pane::View(View::Graph);
    let ron = write(&mut harness, Purpose::Export(graph), "frame.ron");
    let source = GraphSource::open(&ron).expect("the graph can be read");
    let caps = live(&mut harness).running.as_ref().expect("a frame").screen().gpu.caps();
    let again = source.plan(&WhatIf::on(caps)).expect("it can be planned");
    assert_eq!(
        (again.form.totals.passes, again.form.totals.steps),
        (shown.form.totals.passes, shown.form.totals.steps)
    );
    // Exports never overwrite input files of the session.
    let kept = std::fs::read(&ron).expect("a file");
    harness.state_mut().session.read.push(ron.clone());
    for purpose in [Purpose::Trace, Purpose::Export(graph)] {
        harness.state_mut().session.messages.clear();
        write(&mut harness, purpose, "frame.ron");
        let messages = harness.state().session.messages.join("\n");
        assert!(messages.contains("frame.ron: it is an input"), "{messages}");
    }
    assert_eq!(std::fs::read(&ron).expect("a file"), kept);
    let trace = write(&mut harness, Purpose::Trace, "times.json");
    let text = std::fs::read(&trace).expect("a file");
    let trace = trace_data::read(&text).expect("a trace");
    assert!(!trace.frames.is_empty() && !trace.steps.is_empty(), "{trace:?}");
    for name in ["frame.json", "frame.dot", "frame.mmd", "frame.svg", "frame.txt"] {
        assert!(std::fs::metadata(write(&mut harness, Purpose::Export(graph), name)).is_ok_and(|f| f.len() > 100));
    }
    let settings = write(&mut harness, Purpose::SaveSettings, "own.ron");
    harness.state_mut().chosen(Purpose::Open(Role::Shown), &settings, Theme::Light);
    harness.state_mut().session.messages.clear();
    write(&mut harness, Purpose::Export(graph), "frame.tiff");
    harness.state_mut().chosen(Purpose::Trace, Path::new("/no/such/folder/trace.json"), Theme::Light);
    let messages = harness.state().session.messages.join("\n");
    assert!(
        messages.contains("frame.tiff: unknown extension") && messages.contains("trace.json: cannot be written"),
        "{messages}"
    );
}
