//! `measure reflections`: accuracy of screen-space reflections on the default adapter.
//!
//! `cargo run --release -p tests --bin measure -- reflections` prints the table of `docs/design/reflections.md`: three mirror balls over
//! a mirror floor, compared with the formulas of `truth::reflection`.

use crate::{Outcome, adapter, no_words};
use framegraph_passes::ReflectionSettings;
use framegraph_passes::SettingsTable;
use framegraph_passes::effects::depth::structure::Resolution;
use glam::DVec3;
use tests::measure::reflection::{Found, Stage};

/// Width and height of the picture, in pixels.
const SIZE: [u32; 2] = [320, 240];

/// Prints the table.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    let gpu = adapter()?;
    program::line(
        "\n| rays | mirror | seen: found | off, median | off, 95 % | elsewhere | nothing: found | unseen: found |",
    );
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let choices = [
        ("on", Resolution::Full),
        ("on", Resolution::Half),
        ("on:stride=2", Resolution::Full),
        ("on:stride=4", Resolution::Full),
        ("on:stride=8", Resolution::Full),
        ("on:thickness=0.01", Resolution::Full),
        ("on:thickness=0.5", Resolution::Full),
        ("on:bias=0", Resolution::Full),
    ];
    for (text, resolution) in choices {
        let settings = ReflectionSettings::from_text(text)?.ok_or("it is on")?;
        let at = if resolution == Resolution::Half { ", structure at half" } else { "" };
        rows(&format!("`{text}`{at}"), Stage::balls(SIZE).found(&gpu, &settings, resolution)?);
    }
    let mut moved = Stage::balls(SIZE);
    moved.earlier.eye += DVec3::new(0.3, 0.1, -0.2);
    let settings = ReflectionSettings::DEFAULT;
    rows("`on`, the eye 0.37 m away a frame ago", moved.found(&gpu, &settings, Resolution::Full)?);
    Ok(true)
}

fn rows(what: &str, found: [Found; 2]) {
    for (mirror, found) in ["floor", "balls"].into_iter().zip(found) {
        let Found { hit, off_px: [median, most], elsewhere, made_up, mistaken, .. } = found;
        let [hit, elsewhere, made_up, mistaken] = [hit, elsewhere, made_up, mistaken].map(|share| 100.0 * share);
        program::line(format_args!(
            "| {what} | {mirror} | {hit:.1} % | {median:.2} px | {most:.2} px | {elsewhere:.2} % | {made_up:.2} % | \
             {mistaken:.0} % |"
        ));
    }
}
