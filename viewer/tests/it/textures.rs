//! The texture viewer in use.

use crate::folder;
use crate::live::{harness, live};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use viewer::app::{Pane, Viewer};

/// Controls are limited to what the format has; the picture is zoomed, moved and saved.
#[test]
fn a_texture_is_looked_at_closely_and_saved() {
    let name = "a_texture_is_looked_at_closely_and_saved";
    let Some(mut harness) = harness(name, "columns") else { return };
    harness.state_mut().turn_to(Pane::Preview);
    let look_at = |harness: &mut Harness<'_, Viewer>, name: &str| {
        live(harness).preview.look_at(name);
        harness.run();
        harness.run();
    };
    look_at(&mut harness, "shadow_map");
    harness.get_by_label("distance");
    for label in ["R", "A", "sRGB", "average"] {
        assert_eq!(harness.query_all_by_label(label).count(), 0, "{label}: a depth map has one channel and sample");
    }
    let span = live(&mut harness).preview.found.as_ref().expect("texels").span;
    assert_eq!(live(&mut harness).preview.look.range, span, "depth is stretched");
    look_at(&mut harness, "picture");
    assert_eq!(harness.query_all_by_label("distance").count(), 0);
    let colored = |harness: &mut Harness<'_, Viewer>| {
        let picture = live(harness).preview.picture.as_ref().expect("a picture");
        picture.rgba8.chunks(4).any(|texel| texel[0] != texel[1] || texel[1] != texel[2])
    };
    assert!(colored(&mut harness));
    for label in ["G", "B"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    assert!(!colored(&mut harness), "the red channel alone is gray");
    // A texel is clicked and its values stay.
    let size = live(&mut harness).preview.found.as_ref().expect("texels").texels.size;
    let rect = harness.get_by_label_contains("texture picture@").rect();
    harness.hover_at(rect.center());
    harness.run();
    harness.drag_at(rect.center());
    harness.drop_at(rect.center());
    harness.run();
    let pinned = live(&mut harness).preview.pinned.expect("a texel");
    assert!(pinned[0].abs_diff(size[0] / 2) <= 1 && pinned[1].abs_diff(size[1] / 2) <= 1, "{pinned:?} of {size:?}");
    harness.get_by_label_contains("pinned ");
    // The wheel zooms, dragging moves, *Fit* resets.
    let before = live(&mut harness).preview.pan;
    let modifiers = egui::Modifiers::NONE;
    let (unit, phase) = (egui::MouseWheelUnit::Point, egui::TouchPhase::Move);
    let (delta, source) = (egui::vec2(0.0, 120.0), egui::MouseWheelSource::Wheel);
    harness.hover_at(rect.center());
    harness.run();
    harness.event(egui::Event::MouseWheel { unit, delta, phase, source, modifiers });
    harness.run();
    let panel = [rect.width(), rect.height()];
    let zoomed = live(&mut harness).preview.pan;
    assert!(zoomed.zoom(size, panel) > before.zoom(size, panel));
    harness.get_all_by_label("Fit").last().expect("the button of the texture");
    live(&mut harness).preview.pan.fit();
    // Saving is confirmed; an unknown extension is an error.
    let place = folder("texture");
    for (file, said) in [("a.png", "saved "), ("a.exr", "saved "), ("a.bmp", "unknown extension")] {
        live(&mut harness).preview.path = place.join(file).display().to_string();
        harness.run();
        harness.get_all_by_label("Save").last().expect("the button of the texture").click();
        harness.run();
        assert!(harness.query_all_by_label_contains(said).count() > 0, "{file}");
    }
    let (shown, _) = framegraph_scene::picture::read_rgba8(&place.join("a.png")).expect("a picture");
    assert_eq!(shown, size);
    assert!(std::fs::metadata(place.join("a.exr")).is_ok_and(|file| file.len() > 100));
}
