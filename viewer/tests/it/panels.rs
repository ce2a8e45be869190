//! Panels in use: clicks, keys, and their effects.

use crate::{case, folder, session};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use framegraph::Caps;
use std::sync::Arc;
use std::time::Duration;
use viewer::app::{SHORTCUTS, Session, Viewer};
use viewer::drawing::Item;
use viewer::standard_frame::StandardFrame;
use viewer::view::View;
use viewer::what_if::{Planner, WhatIf};

fn shown(name: &str) -> Harness<'static, Viewer> {
    of(session(&case(name)))
}

pub fn of(session: Session) -> Harness<'static, Viewer> {
    of_viewer(Viewer::new(session))
}

pub fn of_viewer(viewer: Viewer) -> Harness<'static, Viewer> {
    let mut harness = Harness::builder()
        .with_size([1280.0, 720.0])
        .with_max_steps(16)
        .build_ui_state(|ui, viewer: &mut Viewer| viewer.show(ui), viewer);
    harness.run();
    harness
}

/// Waits for background work and shows its results.
fn settled(harness: &mut Harness<'_, Viewer>) {
    assert!(harness.state_mut().session.settle(Duration::from_secs(60)));
    harness.run();
}

#[test]
fn a_pass_that_is_clicked_is_explained() {
    let mut harness = shown("filament");
    let plan = harness.state().session.plan.clone().expect("a plan");
    let grade = Item::Pass(plan.pass("grade").expect("a pass"));
    let place = harness.state().place_of(View::Graph, grade).expect("it is in sight");
    harness.hover_at(place);
    harness.run();
    harness.drag_at(place);
    harness.drop_at(place);
    harness.run();
    assert_eq!(harness.state().session.selected, Some(grade));
    harness.get_by_label("pass grade");
    let reason = &plan.form.passes[plan.pass("grade").expect("a pass")].reason;
    assert!(harness.query_all_by_label_contains(reason).count() > 0, "{reason}");
    // A link selects the texture that the pass reads.
    harness.get_by_label("read same pixel hdr").click();
    harness.run();
    harness.get_by_label("resource hdr");
    // Escape returns to the frame.
    harness.key_press(egui::Key::Escape);
    harness.run();
    assert_eq!(harness.state().session.selected, None);
    harness.get_by_label("Filament's frame");
}

#[test]
fn an_effect_that_is_switched_off_leaves_ghosts_and_other_counts() {
    let mut session = Session::new(WhatIf::on(Caps::tiler()), || {});
    session.show(Arc::new(StandardFrame::open("high").expect("there is a preset `high`")));
    assert!(session.settle(Duration::from_secs(60)));
    let mut harness = of(session);
    let before = harness.state().session.plan.clone().expect("a plan");
    let made: Vec<_> = before.form.passes.iter().map(|p| p.name.clone()).filter(|p| p.contains("occlusion")).collect();
    assert!(made.len() > 2, "{made:?}");
    harness.get_by_label("what-if").click();
    harness.run();
    harness.get_by_label("ao").click();
    harness.run();
    settled(&mut harness);
    let now = harness.state().session.plan.clone().expect("a plan");
    assert!(made.iter().all(|name| now.pass(name).is_none()));
    let (was, is) = (before.form.totals, now.form.totals);
    assert!(is.passes < was.passes && is.resolve_bytes < was.resolve_bytes, "{was:?} {is:?}");
    let ghosts = viewer::view::graph::drawing(&now, harness.state().session.against()).words();
    assert!(made.iter().all(|name| ghosts.contains(name.as_str())) && ghosts.contains("not declared here"), "{ghosts}");
    harness.get_by_label("search").click();
    harness.run();
    assert!(harness.query_all_by_label_contains("occlusion_blur").count() == 0, "the list has what is declared");
}

#[test]
fn presets_and_files_of_settings_are_planned() {
    for which in ["low", "medium", "high", "ultra"] {
        let frame = StandardFrame::open(which).expect("a preset");
        let plan = frame.plan(&WhatIf::on(Caps::wgpu())).expect("it can be planned");
        assert!(plan.pass("color").is_some() && plan.declared_at[0].contains(".rs:"), "{which}");
    }
    // Passes of equal names are numbered.
    let ultra = StandardFrame::open("ultra").and_then(|frame| frame.plan(&WhatIf::on(Caps::tiler()))).expect("a plan");
    let map = ultra.resource("shadow/shadow_map").expect("a resource");
    let lit = viewer::view::graph::lit(&ultra, Item::Resource(map));
    let drawn = ultra.form.passes.iter().filter(|pass| pass.name.starts_with("shadow/")).count();
    assert!(drawn > 20 && lit.len() == 1 + drawn + 1, "{drawn} passes draw, the color pass reads: {lit:?}");
    assert!(ultra.pass("shadow/local#2") > ultra.pass("shadow/local"));
    let alone = |drawing: &viewer::drawing::Drawing| drawing.marks.iter().filter(|m| m.1 == lit[0]).count();
    assert_eq!(alone(&viewer::view::graph::drawing(&ultra, None)), drawn, "a line from each to the color pass");
    let error = StandardFrame::open("best").expect_err("there is no such preset");
    assert!(error.contains("`best`") && error.contains("ultra"), "{error}");
    let path = folder("settings").join("bad.ron");
    std::fs::write(&path, "(version: 1, frame: (settings: (samples: 3)))").expect("a file");
    let error = StandardFrame::open(path.to_str().expect("a name")).expect_err("three samples");
    assert!(error.contains("bad.ron") && error.contains("samples"), "{error}");
}

#[test]
fn four_k_is_asked_and_the_bytes_are_seen() {
    let mut harness = shown("filament");
    let before = harness.state().session.plan.clone().expect("a plan").form.totals;
    harness.get_by_label("what-if").click();
    harness.run();
    harness.get_by_label("4K").click();
    harness.run();
    settled(&mut harness);
    let after = harness.state().session.plan.clone().expect("a plan");
    assert_eq!(after.form.frame, [3840, 2160]);
    assert_eq!(after.form.totals.resolve_bytes, 4 * before.resolve_bytes, "four times the texels of 1080p");
    let bytes = viewer::view::bytes(after.form.totals.resolve_bytes);
    assert!(harness.query_all_by_label_contains(&bytes).count() > 0, "{bytes} is on the panel");
    assert!(harness.state().session.against().is_some(), "the difference is against the frame as it is");
    harness.get_by_label("Reset").click();
    harness.run();
    settled(&mut harness);
    assert_eq!(harness.state().session.plan.clone().expect("a plan").form.totals, before);
    assert!(harness.state().session.against().is_none());
}

#[test]
fn a_bad_file_is_a_message_and_what_was_shown_stays() {
    let mut harness = shown("diamond");
    let before = harness.state().session.plan.clone().expect("a plan");
    let path = folder("bad").join("broken.json");
    std::fs::write(&path, "{\"schema\": \"framegraph-plan\", \"version\": 1, \"passes\": [").expect("a file");
    harness.state_mut().session.open(&path, viewer::app::Role::Shown);
    settled(&mut harness);
    assert!(harness.query_all_by_label_contains("truncated").count() == 1);
    assert!(Arc::ptr_eq(&before, harness.state().session.plan.as_ref().expect("a plan")));
    harness.get_by_label("Close").click();
    harness.run();
    assert!(harness.state().session.messages.is_empty());
}

#[test]
fn tabs_keys_and_an_arrangement_that_is_kept() {
    let mut harness = shown("diamond");
    for (key, view) in
        [(egui::Key::Num2, "timeline view"), (egui::Key::Num3, "memory view"), (egui::Key::Num4, "bandwidth view")]
    {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, key);
        harness.run();
        harness.get_by_label(view);
    }
    let kept = harness.state().arrangement().expect("an arrangement");
    let mut again = shown("diamond");
    again.get_by_label("graph view");
    again.state_mut().arrange(&kept);
    again.state_mut().arrange("no arrangement");
    again.run();
    again.get_by_label("bandwidth view");
    again.key_press(egui::Key::F1);
    again.run();
    for (keys, what) in SHORTCUTS {
        assert!(
            again.query_all_by_label(keys).count() > 0 && again.query_all_by_label(what).count() > 0,
            "{keys}: {what}"
        );
    }
}

#[test]
fn nothing_is_drawn_while_nothing_happens() {
    let mut harness = shown("filament");
    let idle = harness.output().viewport_output.values().map(|viewport| viewport.repaint_delay).min();
    assert!(idle.is_some_and(|delay| delay > Duration::from_secs(3600)), "{idle:?}");
    harness.step();
    assert_eq!(harness.state().session.doing(), None);
}

/// The slider chooses frames, and the list shows comparison pictures of choices, if their folder exists.
#[test]
fn a_frame_is_chosen_within_a_time_and_an_option_is_seen() {
    let folder = folder("accuracy_panel");
    let pictures = folder.join("pictures");
    std::fs::create_dir_all(&pictures).expect("a folder");
    std::fs::copy("tests/it/accuracy.json", folder.join("accuracy.json")).expect("the sample");
    std::fs::copy("../docs/viewer/graph.png", pictures.join("shadow-filter.pcss.png")).expect("a picture");
    std::fs::write(pictures.join("shadow-filter.vsm.png"), "no picture").expect("a file");
    let mut harness = shown("filament");
    harness.state_mut().session.open(&folder.join("accuracy.json"), viewer::app::Role::Shown);
    settled(&mut harness);
    harness.state_mut().turn_to(viewer::app::Pane::Accuracy);
    harness.run();
    let data = harness.state().session.accuracy.clone().expect("it is open");
    let [fastest, finest] = data.span_ms().expect("frames were measured");
    assert_eq!(harness.state().session.budget_ms, finest, "it begins with the finest frame");
    harness.state_mut().session.allow_ms(fastest);
    harness.run();
    harness.get_by_label("picture").click();
    harness.run();
    assert!(harness.query_by_label("shadow-filter: DPCF").is_none(), "there is no picture of it");
    harness.get_by_label("shadow-filter: PCSS").click();
    harness.run();
    harness.get_by_label_contains("reference, choice, and difference times sixteen");
    harness.get_by_label("picture").click();
    harness.run();
    harness.get_by_label("shadow-filter: VSM").click();
    harness.run();
    harness.get_by_label_contains("shadow-filter.vsm.png");
    std::fs::remove_dir_all(&pictures).expect("it is there");
    harness.state_mut().session.open(&folder.join("accuracy.json"), viewer::app::Role::Shown);
    settled(&mut harness);
    assert!(harness.query_by_label("picture").is_none());
}

/// Another file resets zoom and search and closes messages; a file that changed on disk keeps them.
#[test]
fn another_file_starts_afresh() {
    let folder = folder("afresh");
    let (first, second) = (folder.join("first.ron"), folder.join("second.ron"));
    std::fs::copy(case("filament"), &first).expect("a file");
    std::fs::copy(case("deferred"), &second).expect("a file");
    let mut harness = of(session(&first));
    harness.get_by_label("search").click();
    harness.run();
    let open = |harness: &mut Harness<'_, Viewer>, path| {
        harness.state_mut().open(path, viewer::app::Role::Shown);
        settled(harness);
    };
    let place = |harness: &Harness<'_, Viewer>| harness.state().place_of(View::Graph, Item::Step(0));
    let initial = place(&harness).expect("it is in sight");
    let middle = egui::pos2(700.0, 400.0);
    harness.hover_at(middle);
    harness.run();
    harness.drag_at(middle);
    harness.hover_at(middle + egui::vec2(50.0, 40.0));
    harness.drop_at(middle + egui::vec2(50.0, 40.0));
    harness.run();
    harness.state_mut().session.say("an error".into());
    harness.run();
    let moved = place(&harness).expect("it is in sight");
    assert!((moved.x - initial.x).abs() > 10.0);
    open(&mut harness, &first);
    assert_eq!(place(&harness), Some(moved), "the same file keeps the view");
    assert_eq!(harness.state().session.messages.len(), 1);
    open(&mut harness, &second);
    assert!(harness.state().session.messages.is_empty(), "messages of the other file are closed");
    open(&mut harness, &first);
    assert_eq!(place(&harness), Some(initial), "zoom and position start afresh");
    assert_eq!(harness.state().recent.len(), 2);
    assert!(harness.state().recent[0].ends_with("first.ron"));
}

/// *Fit* shows the whole view, however large it is.
#[test]
fn fit_fits() {
    let mut session = Session::new(WhatIf::on(Caps::tiler()), || {});
    session.show(Arc::new(StandardFrame::open("ultra").expect("a preset")));
    assert!(session.settle(Duration::from_secs(60)));
    let mut harness = of(session);
    let steps = harness.state().session.plan.as_ref().map_or(0, |plan| plan.form.steps.len());
    let hidden = |harness: &Harness<'_, Viewer>| {
        (0..steps).filter(|step| harness.state().place_of(View::Graph, Item::Step(*step)).is_none()).count()
    };
    assert!(hidden(&harness) > 0);
    harness.get_by_label("Fit").click();
    harness.run();
    assert_eq!(hidden(&harness), 0);
}

/// A selection in the search pans the graph to it.
#[test]
fn a_selection_is_scrolled_to_in_every_view() {
    let mut session = Session::new(WhatIf::on(Caps::tiler()), || {});
    session.show(Arc::new(StandardFrame::open("ultra").expect("a preset")));
    assert!(session.settle(Duration::from_secs(60)));
    let mut harness = of(session);
    let plan = harness.state().session.plan.clone().expect("a plan");
    let last = Item::Pass(plan.form.passes.iter().rposition(|pass| !pass.culled).expect("a pass"));
    assert_eq!(harness.state().place_of(View::Graph, last), None);
    harness.state_mut().select(Some(last));
    harness.run();
    assert!(harness.state().place_of(View::Graph, last).is_some());
}

/// Without a desktop portal, *Open…* focuses the field of the path.
#[cfg(target_os = "linux")]
#[test]
fn without_a_file_dialog_the_path_is_typed() {
    if std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_some() {
        return test_report::skip("without_a_file_dialog_the_path_is_typed", "this desktop may have a portal");
    }
    let mut harness = shown("diamond");
    harness.get_by_label("Open…").click();
    for _ in 0..200 {
        harness.step();
        if harness.query_all_by_label_contains("no file dialog").count() > 0 {
            harness.step();
            let mut fields = harness.query_all_by_role(egui::accesskit::Role::TextInput);
            assert!(fields.any(|field| field.is_focused()), "the path can be typed at once");
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("no answer of the dialog: {:?}", harness.state().session.notice);
}
