//! Pictures of the panels of a live frame: at common window sizes, and at twice the font size.
//!
//! `VIEWER_PICTURES=write cargo test -p viewer --test it live_pictures` renews the picture of `docs/reference/viewer.md`.

use crate::live::{document, viewer};
use std::path::Path;
use viewer::app::Pane;
use viewer::drawing::Theme;
use viewer::offscreen::Offscreen;

/// Pictures: file, size in pixels, pixels per point, pane on the left, pane in the center.
const SHOWN: [(&str, [u32; 2], f32, Pane, Pane); 6] = [
    ("live", [1280, 720], 1.0, Pane::Settings, Pane::Viewport),
    ("live-what-if", [1280, 720], 1.0, Pane::WhatIf, Pane::Viewport),
    ("live-effects", [1280, 720], 1.0, Pane::Effects, Pane::Viewport),
    ("live-lens", [1280, 720], 1.0, Pane::Lens, Pane::View(viewer::view::View::Timeline)),
    ("live-large", [2560, 1440], 1.0, Pane::Scene, Pane::Viewport),
    ("live-double", [2560, 1440], 2.0, Pane::Debugging, Pane::Viewport),
];

#[test]
fn panels_of_a_frame_fit_their_window() {
    let name = "panels_of_a_frame_fit_their_window";
    let mut screen = match Offscreen::open() {
        Ok(screen) => screen,
        Err(error) => return test_report::skip(name, &error),
    };
    test_report::adapter(&screen.gpu().describe());
    let mut viewer = viewer(&screen.screen(), document(), "materials");
    let (made, kept) = (crate::folder("live_pictures"), Path::new("../docs/viewer"));
    let anew = std::env::var_os("VIEWER_PICTURES").is_some_and(|word| word == "write");
    let live = viewer.live.as_mut().expect("a frame");
    // Panel sizes do not depend on the resolution of the frame, so draw a small one.
    (live.share, live.options.forced) = (if anew { 1.0 } else { 0.25 }, false);
    let shown_here = if anew { SHOWN.to_vec() } else { test_report::share(SHOWN) };
    for (file, size, scale, left, middle) in shown_here {
        viewer.turn_to(Pane::Preview);
        viewer.turn_to(left);
        viewer.turn_to(middle);
        let live = viewer.live.as_mut().expect("a frame");
        live.preview.look_at("shadow_map");
        live.again();
        let mut shown = Vec::new();
        for _ in 0..4 {
            shown = screen.picture(size, scale, Theme::Light, |ui| viewer.show(ui)).expect("a picture");
        }
        let path = made.join(format!("{file}.png"));
        let whole = image::RgbaImage::from_raw(size[0], size[1], shown).expect("so many pixels");
        image::DynamicImage::ImageRgba8(whole.clone()).to_rgb8().save(&path).expect("a file");
        if anew && file == "live" {
            std::fs::copy(&path, kept.join("live.png")).expect("a file");
        }
        // The viewport in the center shows many colors.
        if middle == Pane::Viewport {
            let mut colors = std::collections::HashSet::new();
            let [width, height] = size.map(|side| side as usize);
            for y in (height / 3..2 * height / 3).step_by(3) {
                for x in (width * 2 / 5..width * 3 / 5).step_by(3) {
                    colors.insert(whole.get_pixel(x as u32, y as u32).0);
                }
            }
            assert!(colors.len() > 500, "{file}: only {} colors in the viewport; see {}", colors.len(), path.display());
        }
    }
}
