//! `measure prediction`: predicts times and errors of options on held-out scenes.

use crate::{Outcome, adapter};
use program::outputs::Outputs;
use program::progress::Shown;
use std::path::Path;
use tests::measure::facts::Easel;
use tests::measure::prediction::{Sample, judged, measure};

const SIZES_PX: [[u32; 2]; 3] = [[48, 32], [72, 48], [96, 64]];

/// Measures N random scenes (default 100) at three sizes into FILE.json, which an interrupted run resumes.
pub fn run(words: &[&str]) -> Outcome {
    let (file, count) = match words {
        [file] => (Path::new(file), 100),
        [file, count] => (Path::new(file), count.parse().map_err(|_| format!("{count}: expected a number of scenes"))?),
        _ => return Err("usage: measure prediction FILE.json [N]".into()),
    };
    let mut samples: Vec<Sample> = match std::fs::read_to_string(file) {
        Ok(text) => serde_json::from_str(&text).map_err(|error| format!("{}: {error}", file.display()))?,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
        Err(error) => return Err(format!("{}: {error}", file.display()).into()),
    };
    let gpu = adapter()?;
    let (mut easel, mut shown) = (Easel::new(&gpu), Shown::default());
    for scene in 0..count {
        shown.step("scenes", scene as usize, count as usize, "");
        for size_px in SIZES_PX {
            if !samples.iter().any(|sample| (sample.scene, sample.size_px) == (scene, size_px)) {
                samples.extend(measure(&gpu, &mut easel, scene, size_px)?);
            }
        }
        Outputs::one(file, serde_json::to_string(&samples)?.as_bytes())?;
    }
    shown.clear();
    let scenes = |held: bool| (0..count).filter(|scene| (scene % 3 == 0) == held).count();
    program::line(format_args!(
        "{} training scenes, {} held-out scenes, sizes 48×32, 72×48 and 96×64:\n",
        scenes(false),
        scenes(true)
    ));
    program::line("| option | time: median | 95th percentile | error: median | 95th percentile |");
    program::line("| --- | ---: | ---: | ---: | ---: |");
    // The file may have more scenes than this run asks for.
    samples.retain(|sample| sample.scene < count);
    for own in judged(&samples) {
        let [a, b, c, d] = [own.ms[0], own.ms[1], own.steps[0], own.steps[1]].map(|share| 100.0 * share);
        program::line(format_args!("| {} | {a:.0} % | {b:.0} % | {c:.0} % | {d:.0} % |", own.option));
    }
    Ok(true)
}
