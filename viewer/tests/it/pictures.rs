//! Compares the pictures of `docs/reference/viewer.md` with the current panels.
//!
//! `VIEWER_PICTURES=write cargo test -p viewer --test it pictures` renews them.

use crate::{case, folder, session_of, trace_of};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::fs::File;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use viewer::app::{Pane, Viewer};
use viewer::drawing::{Item, Theme};
use viewer::offscreen::Offscreen;
use viewer::trace_data::read;
use viewer::view::View;

/// Size of the pictures in pixels.
const SIZE: [u32; 2] = [1280, 720];
/// Minimum difference of a channel that counts, since drivers round the edges of glyphs differently.
const STEP: u8 = 24;
/// Maximum number of differing pixels: 0.1 %.
const MAX_DIFFERENT: usize = (SIZE[0] * SIZE[1] / 1000) as usize;

/// Counts differing pixels.
fn differing(a: &[u8], b: &[u8]) -> usize {
    let far = |(p, q): (&[u8], &[u8])| p.iter().zip(q).any(|(p, q)| p.abs_diff(*q) >= STEP);
    a.chunks_exact(4).zip(b.chunks_exact(4)).filter(|pair| far(*pair)).count()
}

fn write(path: &Path, rgba: &[u8]) {
    let file = File::create(path).expect("a file");
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    // Flat areas compress best without a filter.
    let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::NoFilter);
    encoder.write_image(&rgb, SIZE[0], SIZE[1], ExtendedColorType::Rgb8).expect("a picture");
}

/// Returns a viewer of Filament's frame on a tiler, or of a deferred frame for queues, with a selection for the view.
fn shown(pane: Pane) -> (Viewer, Option<Item>) {
    // Filament's frame has no work for another queue.
    let view = match pane {
        Pane::View(view) => Some(view),
        _ => None,
    };
    let mut session = match view {
        Some(View::Queues) => session_of(&case("deferred"), &[]),
        _ => session_of(&case("filament"), &["shadows", "sao"]),
    };
    let plan = session.plan.clone().expect("a plan");
    if matches!(view, Some(View::Timeline | View::Trace)) {
        session.trace = Some(Arc::new(read(trace_of(&plan, 120, 77).as_bytes()).expect("a trace")));
    }
    if matches!(view, Some(View::Bandwidth | View::Diff)) {
        let asked = &mut session.questions.as_mut().expect("a graph can be planned anew").asked;
        asked.frame = Some([3840, 2160]);
        asked.merge = view == Some(View::Bandwidth);
        session.ask();
        assert!(session.settle(Duration::from_secs(60)));
    }
    let mut viewer = Viewer::new(session);
    viewer.turn_to(pane);
    if viewer.session.against().is_some() {
        viewer.turn_to(Pane::WhatIf);
    }
    let selected = match view {
        Some(View::Graph) => plan.resource("shadow").map(Item::Resource),
        Some(View::Timeline) => plan.pass("grade").map(Item::Pass),
        Some(View::Memory) => plan.resource("structure").map(Item::Resource),
        Some(View::Queues) => plan.pass("lighting").map(Item::Pass),
        _ => None,
    };
    if pane == Pane::Accuracy {
        viewer.session.open(Path::new("tests/it/accuracy.json"), viewer::app::Role::Shown);
        assert!(viewer.session.settle(Duration::from_secs(60)));
        viewer.session.allow_ms(120.0);
    }
    (viewer, selected)
}

#[test]
fn panels_look_as_in_the_document() {
    let name = "panels_look_as_in_the_document";
    let mut screen = match Offscreen::open() {
        Ok(screen) => screen,
        Err(error) => return test_report::skip(name, &error),
    };
    test_report::adapter(&screen.gpu().describe());
    let (made, kept) = (folder("pictures"), Path::new("../docs/viewer"));
    let anew = std::env::var_os("VIEWER_PICTURES").is_some_and(|word| word == "write");
    let mut before: Option<Vec<u8>> = None;
    for pane in Pane::drawn().filter(|pane| *pane != Pane::View(View::Inspector)) {
        let (mut viewer, selected) = shown(pane);
        let theme = if pane == Pane::View(View::Memory) { Theme::Dark } else { Theme::Light };
        let rgba = screen.picture(SIZE, 1.0, theme, |ui| {
            viewer.show(ui);
            viewer.select(selected);
        });
        let rgba = rgba.expect("a picture");
        let file = format!("{}.png", pane.word());
        write(&made.join(&file), &rgba);
        if anew {
            write(&kept.join(&file), &rgba);
        }
        let expected = image::open(kept.join(&file)).unwrap_or_else(|e| panic!("{file}: {e}")).to_rgba8();
        assert_eq!(expected.dimensions(), (SIZE[0], SIZE[1]));
        let differ = differing(&rgba, expected.as_raw());
        assert!(differ <= MAX_DIFFERENT, "{file}: {differ} pixels differ; see {}", made.display());
        // Negative control: different views are message apart.
        if let Some(before) = before.replace(rgba.clone()) {
            assert!(differing(&before, &rgba) > MAX_DIFFERENT, "{file} is the picture before it");
        }
    }
}
