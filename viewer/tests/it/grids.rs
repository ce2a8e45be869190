//! The timeline and the memory table in use.

use crate::panels::{of, of_viewer};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use framegraph::Caps;
use std::sync::Arc;
use std::time::Duration;
use viewer::app::{Pane, Session, Viewer};
use viewer::drawing::Item;
use viewer::standard_frame::StandardFrame;
use viewer::view::View;
use viewer::what_if::WhatIf;

fn shown(preset: &str, view: View) -> Harness<'static, Viewer> {
    let mut session = Session::new(WhatIf::on(Caps::tiler()), || {});
    session.show(Arc::new(StandardFrame::open(preset).expect("a preset")));
    assert!(session.settle(Duration::from_secs(60)));
    let mut harness = of(session);
    harness.state_mut().turn_to(Pane::View(view));
    harness.run();
    harness
}

fn resource(harness: &Harness<'_, Viewer>, name: &str) -> Item {
    let plan = harness.state().session.plan.as_ref().expect("a plan");
    let is = |r: &viewer::plan_data::Resource| r.name.ends_with(name) && r.held_steps.is_some();
    Item::Resource(plan.form.resources.iter().position(is).unwrap_or_else(|| panic!("{name}")))
}

fn click(harness: &mut Harness<'_, Viewer>, at: egui::Pos2) {
    harness.hover_at(at);
    harness.run();
    harness.drag_at(at);
    harness.drop_at(at);
    harness.run();
    harness.hover_at(at);
    harness.run();
}

#[test]
fn rows_are_clicked_and_walked_with_keys_and_every_view_follows() {
    let mut harness = shown("high", View::Timeline);
    let plan = harness.state().session.plan.clone().expect("a plan");
    let first = plan.form.resources.iter().position(|r| r.first_step == Some(0)).expect("a resource");
    let place = harness.state().place_of(View::Timeline, Item::Resource(first)).expect("it is in sight");
    click(&mut harness, place);
    assert_eq!(harness.state().session.selected, Some(Item::Resource(first)));
    // The arrow keys go to the next row, and End to the last.
    harness.key_press(egui::Key::ArrowDown);
    harness.run();
    assert_eq!(harness.state().session.selected, Some(Item::Resource(first + 1)));
    harness.key_press(egui::Key::End);
    harness.run();
    let last = Item::Resource(plan.form.resources.len() - 1);
    assert_eq!(harness.state().session.selected, Some(last));
    assert!(harness.state().place_of(View::Timeline, last).is_some(), "it is scrolled to");
    // Without a selected row, End goes to the last row, too.
    harness.state_mut().select(None);
    harness.run();
    harness.key_press(egui::Key::End);
    harness.run();
    assert_eq!(harness.state().session.selected, Some(last));
    harness.key_press(egui::Key::ArrowRight);
    harness.run();
    assert!(matches!(harness.state().session.selected, Some(Item::Pass(_))));
    // A selection elsewhere scrolls the table.
    let pass = Item::Pass(plan.form.passes.iter().rposition(|pass| !pass.culled).expect("a pass"));
    harness.state_mut().select(Some(pass));
    harness.run();
    assert!(harness.state().place_of(View::Timeline, pass).is_some());
    harness.state_mut().turn_to(Pane::View(View::Graph));
    harness.run();
    assert!(harness.state().place_of(View::Graph, pass).is_some(), "the hidden graph follows when it is shown");
}

#[test]
fn rows_are_filtered_by_the_selected_pass_and_grouped() {
    let mut harness = shown("high", View::Timeline);
    let plan = harness.state().session.plan.clone().expect("a plan");
    let pass = plan.form.passes.iter().position(|pass| !pass.culled && pass.accesses.len() > 1).expect("a pass");
    let own = plan.resource(&plan.form.passes[pass].accesses[0].resource).expect("a resource");
    let other = (0..plan.form.resources.len())
        .find(|index| plan.form.passes[pass].accesses.iter().all(|a| a.resource != plan.form.resources[*index].name))
        .expect("a resource of another pass");
    harness.state_mut().select(Some(Item::Pass(pass)));
    harness.run();
    harness.get_by_label("of pass").click();
    harness.run();
    let seen = |harness: &Harness<'_, Viewer>, index| {
        harness.state().place_of(View::Timeline, Item::Resource(index)).is_some()
    };
    assert!(seen(&harness, own) && !seen(&harness, other), "only resources of the pass are rows");
    harness.get_by_label("of pass").click();
    harness.run();
    // *Fit* shows all rows.
    harness.get_by_label("Fit").click();
    harness.run();
    assert!(seen(&harness, own) && seen(&harness, other));
    let all = (0..plan.form.passes.len())
        .filter(|pass| harness.state().place_of(View::Timeline, Item::Pass(*pass)).is_some())
        .count();
    harness.get_by_label("culled").click();
    harness.run();
    let culled = (0..plan.form.passes.len())
        .filter(|pass| harness.state().place_of(View::Timeline, Item::Pass(*pass)).is_some())
        .count();
    assert!(culled < all, "{culled} of {all} passes are columns");
}

#[test]
fn memory_is_a_map_and_a_table() {
    let mut harness = shown("high", View::Memory);
    let map = resource(&harness, "shadow_map");
    harness.get_by_label("table").click();
    harness.run();
    harness.get_by_label("Fit").click();
    harness.run();
    let place = harness.state().place_of(View::Memory, map).expect("it has memory");
    click(&mut harness, place);
    assert_eq!(harness.state().session.selected, Some(map));
    harness.check_accessibility();
    harness.get_by_label("map").click();
    harness.run();
    harness.get_by_label("memory view");
}

/// Two thousand passes and resources: only visible cells are drawn, and a selection at the end is scrolled to.
#[test]
fn two_thousand_rows_are_scrolled() {
    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    session.show_plan(viewer::synthetic::large(2000).expect("a plan"));
    let mut viewer = Viewer::new(session);
    viewer.turn_to(Pane::View(View::Timeline));
    let mut harness = of_viewer(viewer);
    harness.get_by_label("minimap");
    let plan = harness.state().session.plan.clone().expect("a plan");
    let last = Item::Resource(plan.resource("texture 1999").expect("a resource"));
    harness.state_mut().select(Some(last));
    harness.run();
    assert!(harness.state().place_of(View::Timeline, last).is_some(), "it is scrolled to");
    harness.hover_at(harness.get_by_label("timeline view").rect().center());
    harness.run();
    harness.key_press(egui::Key::ArrowUp);
    harness.run();
    let before = Item::Resource(plan.resource("texture 1998").expect("a resource"));
    assert_eq!(harness.state().session.selected, Some(before));
    drop(harness);
    // The number of painted shapes does not depend on the number of rows.
    let [few, many] = [200, 2000].map(painted);
    assert!(many > 0 && many < few + few / 4, "{few} and {many} shapes");
}

/// Returns the maximum number of shapes of a frame while the selection moves through a plan.
fn painted(passes: usize) -> usize {
    let mut session = Session::new(WhatIf::on(Caps::wgpu()), || {});
    session.show_plan(viewer::synthetic::large(passes).expect("a plan"));
    let mut viewer = Viewer::new(session);
    viewer.turn_to(Pane::View(View::Timeline));
    let ctx = egui::Context::default();
    let shown = |index| {
        viewer.select(Some(Item::Resource(passes * index / 30 + 5)));
        crate::sizes::frame(&ctx, &mut viewer, [1280.0, 720.0], Vec::new())
    };
    (0..30).map(shown).max().expect("frames")
}
