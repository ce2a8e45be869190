//! Panels in use: clicks and keys, and what they lead to.

use crate::{case, folder, session};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::time::Duration;
use viewer::app::{SHORTCUTS, Viewer};
use viewer::drawing::Item;
use viewer::view::View;

fn shown(name: &str) -> Harness<'static, Viewer> {
    let viewer = Viewer::new(session(&case(name)));
    let mut harness =
        Harness::builder().with_size([1280.0, 720.0]).build_ui_state(|ui, viewer: &mut Viewer| viewer.show(ui), viewer);
    harness.run();
    harness
}

/// Waits for other threads, then shows what they brought.
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
    // A link leads on: to the texture that it reads.
    harness.get_by_label("read same pixel hdr").click();
    harness.run();
    harness.get_by_label("resource hdr");
    // And Escape back to the frame.
    harness.key_press(egui::Key::Escape);
    harness.run();
    assert_eq!(harness.state().session.selected, None);
    harness.get_by_label("Filament's frame");
}

#[test]
fn a_search_finds_a_culled_pass_and_says_why() {
    let mut harness = shown("filament");
    // The frame without its last two passes: nothing reads what the color pass makes.
    harness.get_by_label("what-if").click();
    harness.run();
    harness.get_by_label("fxaa").click();
    harness.run();
    settled(&mut harness);
    let session = &harness.state().session;
    let (base, now) = (session.base().expect("a base"), session.plan.clone().expect("a plan"));
    assert!(now.pass("fxaa").is_none() && base.pass("fxaa").is_some(), "the feature takes its pass along");
    assert!(now.form.totals.resolve_bytes <= base.form.totals.resolve_bytes);
    let ghost = now.form.passes.iter().position(|pass| pass.culled);
    harness.get_by_label("search").click();
    harness.run();
    if let Some(ghost) = ghost {
        harness.get_by_label(&format!("{}  (culled)", now.form.passes[ghost].name)).click();
        harness.run();
        assert!(harness.query_all_by_label_contains("culled").count() > 1);
    }
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
    harness.get_by_label("As it is").click();
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
    assert!(harness.query_all_by_label_contains("ends too early").count() == 1);
    assert!(std::sync::Arc::ptr_eq(&before, harness.state().session.plan.as_ref().expect("a plan")));
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
