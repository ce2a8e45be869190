//! `cargo xtask bench --frames`: whole frames of each preset over built-in scenes, with and without what a graph is for.

use crate::options::Options;
use crate::{Failure, workspace};
use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

/// Scenes that differ in what they call for.
const SCENES: [&str; 6] = ["spheres", "columns", "materials", "glass", "lobes", "lamps:100"];
const PRESETS: [&str; 4] = ["low", "medium", "high", "ultra"];
const SIZES: [&str; 2] = ["1280x720", "1920x1080"];
/// What is left out of the frame, or kept in it that it would leave out, with the options that do so; the first changes nothing.
const WITHOUT: [(&str, &[&str]); 6] = [
    ("as it is", &[]),
    ("a prepass", &["--enable", "prepass"]),
    ("no dropping", &["--force-effects"]),
    ("no merging", &["--debug", "no-merge"]),
    ("no inlining", &["--inline", "off"]),
    ("no aliasing", &["--alias", "none"]),
];
/// How often each is run, in turns, so that all see the same machine.
const ROUNDS: usize = 3;

/// Measures, and prints a table in Markdown.
///
/// # Errors
/// When `render` cannot be built, when a run fails, and when another program prints no time.
pub fn run(options: &Options) -> Result<(), Failure> {
    let build = ["build", "--quiet", "--release", "--package", "examples", "--bin", "render"];
    let built = workspace::cargo(&build).status().map_err(|error| Failure::Failed(error.to_string()))?;
    if !built.success() {
        return Err(Failure::Failed("render could not be built".to_owned()));
    }
    let chosen = |name: &str, all: &[&str]| match options.value(name) {
        Some(one) => vec![one.to_string_lossy().into_owned()],
        None => all.iter().map(|one| (*one).to_owned()).collect(),
    };
    let beside = options.value("--beside");
    let mut heads: Vec<&str> = vec!["scene", "preset", "size"];
    heads.extend(WITHOUT.iter().map(|(name, _)| *name));
    heads.extend(beside.is_some().then_some("the other"));
    program::print(format!(
        "Medians of frames in ms, by the device's clock where it has one; {ROUNDS} runs of each in turns.\n\n| {} |\n|{}\n",
        heads.join(" | "),
        " --- |".repeat(heads.len())
    ));
    for scene in chosen("--scene", &SCENES) {
        for preset in chosen("--preset", &PRESETS) {
            for size in chosen("--size", &SIZES) {
                let times = row([&scene, &preset, &size], beside)?;
                let cells: Vec<String> = times.iter().map(|ms| format!("{ms:.2}")).collect();
                program::print(format!("| {scene} | {preset} | {size} | {} |\n", cells.join(" | ")));
            }
        }
    }
    Ok(())
}

/// The median of each variant's rounds, and of the other program's.
fn row(frame: [&str; 3], beside: Option<&OsString>) -> Result<Vec<f64>, Failure> {
    let mut times = vec![Vec::new(); WITHOUT.len() + usize::from(beside.is_some())];
    for _ in 0..ROUNDS {
        for (found, (_, more)) in times.iter_mut().zip(WITHOUT) {
            found.push(ours(frame, more)?);
        }
        if let (Some(command), Some(found)) = (beside, times.last_mut()) {
            found.push(others(command)?);
        }
    }
    let median = |mut of: Vec<f64>| {
        of.sort_by(f64::total_cmp);
        of[of.len() / 2]
    };
    Ok(times.into_iter().map(median).collect())
}

fn ours([scene, preset, size]: [&str; 3], more: &[&str]) -> Result<f64, Failure> {
    let root = workspace::root();
    let program = root.join("target/release").join(format!("render{}", std::env::consts::EXE_SUFFIX));
    let out = root.join("target/xtask/bench.png");
    let mut command = Command::new(program);
    command.args([scene, "--preset", preset, "--size", size, "--frames", "6", "--timing", "--out"]).arg(&out);
    let text = output(command.args(more), &format!("render {scene} --preset {preset}"))?;
    frame_ms(&text).ok_or_else(|| Failure::Failed(format!("render {scene}: no row of the frame was printed")))
}

/// The median of the row `frame`: the GPU's where there is one.
fn frame_ms(text: &str) -> Option<f64> {
    let row = text.lines().find(|line| line.starts_with("| frame |"))?;
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    let number = |index: usize| cells.get(index).and_then(|cell| cell.parse::<f64>().ok());
    // Step, passes, and least, quartile and median of both sides.
    number(8).or_else(|| number(5))
}

/// The time that another program prints: the last number before `ms`.
fn others(command: &OsString) -> Result<f64, Failure> {
    let shown = command.to_string_lossy();
    let (shell, option) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let text = output(Command::new(shell).arg(option).arg(command), &shown)?;
    printed_ms(&text).ok_or_else(|| Failure::Failed(format!("{shown}: it prints no number before `ms`")))
}

fn printed_ms(text: &str) -> Option<f64> {
    text.rmatch_indices("ms").find_map(|(at, _)| text[..at].split_whitespace().next_back()?.parse().ok())
}

fn output(command: &mut Command, shown: &str) -> Result<String, Failure> {
    let failed = |why: &dyn std::fmt::Display| Failure::Failed(format!("{shown}: {why}"));
    let output = command.current_dir(Path::new(&workspace::root())).output().map_err(|error| failed(&error))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() { Ok(text + &told) } else { Err(failed(&told.trim())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_found_in_what_is_printed() {
        let row = "| step | x |\n| frame |     |   0.652 | 0.652 |  0.663 | 150.008 | 150.008 | 154.011 |      4 |\n";
        assert_eq!(frame_ms(row), Some(154.011));
        let cpu = "| frame |     |   0.652 | 0.652 |  0.663 |       - |       - |       - |      4 |\n";
        assert_eq!(frame_ms(cpu), Some(0.663));
        assert_eq!(frame_ms("| frames |"), None);
        assert_eq!(printed_ms("frame 0: 9.5 ms\nmedian 12.25 ms over 30 frames (items)"), Some(12.25));
        assert_eq!(printed_ms("12.25ms"), Some(12.25));
        assert_eq!(printed_ms("no time"), None);
    }
}
