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
/// How often each is run unless it is said, in turns, so that all see the same machine.
const ROUNDS: usize = 3;

/// Of how many frames the median is taken, unless `--with` says so.
const FRAMES: [&str; 2] = ["--frames", "6"];

/// What a table is made with.
struct Asked<'a> {
    /// Runs of each.
    rounds: usize,
    /// More arguments for `render`.
    with: Vec<String>,
    /// Another renderer's command.
    beside: Option<&'a OsString>,
}

/// Measures, and prints a table in Markdown.
///
/// # Errors
/// When an option has no meaning, when `render` cannot be built, when a run fails, and when another program prints no time.
pub fn run(options: &Options) -> Result<(), Failure> {
    let asked = asked(options)?;
    let build = ["build", "--quiet", "--release", "--package", "examples", "--bin", "render"];
    let built = workspace::cargo(&build).status().map_err(|error| Failure::Failed(error.to_string()))?;
    if !built.success() {
        return Err(Failure::Failed("render could not be built".to_owned()));
    }
    let chosen = |name: &str, all: &[&str]| match options.value(name) {
        Some(one) => vec![one.to_string_lossy().into_owned()],
        None => all.iter().map(|one| (*one).to_owned()).collect(),
    };
    let mut heads: Vec<&str> = vec!["scene", "preset", "size"];
    heads.extend(WITHOUT.iter().map(|(name, _)| *name));
    heads.extend(asked.beside.iter().flat_map(|_| ["the other", "ratio"]));
    program::print(format!(
        "Medians of frames in ms, by the device's clock where it has one; {} of each in turns.\n\n| {} |\n|{}\n",
        if asked.rounds == 1 { "one run".to_owned() } else { format!("{} runs", asked.rounds) },
        heads.join(" | "),
        " --- |".repeat(heads.len())
    ));
    for scene in chosen("--scene", &SCENES) {
        for preset in chosen("--preset", &PRESETS) {
            for size in chosen("--size", &SIZES) {
                let mut times = row([&scene, &preset, &size], &asked)?;
                times.extend(asked.beside.and_then(|_| Some(times.first()? / times.last()?)));
                let cells: Vec<String> = times.iter().map(|ms| format!("{ms:.2}")).collect();
                program::print(format!("| {scene} | {preset} | {size} | {} |\n", cells.join(" | ")));
            }
        }
    }
    Ok(())
}

/// The median of each variant's rounds, and of the other program's.
fn row(frame: [&str; 3], asked: &Asked<'_>) -> Result<Vec<f64>, Failure> {
    let mut times = vec![Vec::new(); WITHOUT.len() + usize::from(asked.beside.is_some())];
    for _ in 0..asked.rounds {
        for (found, (_, more)) in times.iter_mut().zip(WITHOUT) {
            found.push(ours(frame, more, &asked.with)?);
        }
        if let (Some(command), Some(found)) = (asked.beside, times.last_mut()) {
            found.push(others(&filled(&command.to_string_lossy(), frame))?);
        }
    }
    let median = |mut of: Vec<f64>| {
        of.sort_by(f64::total_cmp);
        of[of.len() / 2]
    };
    Ok(times.into_iter().map(median).collect())
}

/// What the command line says beside scenes, presets and sizes.
fn asked(options: &Options) -> Result<Asked<'_>, Failure> {
    let rounds = match options.value("--rounds").map(|text| text.to_string_lossy()) {
        None => ROUNDS,
        Some(text) => text
            .parse()
            .ok()
            .filter(|rounds| *rounds > 0)
            .ok_or_else(|| Failure::Usage(format!("`--rounds {text}`: a whole number of at least 1 is needed")))?,
    };
    let with = options.value("--with").map(|text| text.to_string_lossy().into_owned()).unwrap_or_default();
    let with = with.split_whitespace().map(str::to_owned).collect();
    Ok(Asked { rounds, with, beside: options.value("--beside") })
}

/// Another renderer's command for the frame of a row.
fn filled(command: &str, [scene, preset, size]: [&str; 3]) -> String {
    command.replace("{scene}", scene).replace("{preset}", preset).replace("{size}", size)
}

fn ours([scene, preset, size]: [&str; 3], more: &[&str], with: &[String]) -> Result<f64, Failure> {
    let program = workspace::root().join("target/release").join(format!("render{}", std::env::consts::EXE_SUFFIX));
    let out = workspace::scratch()?.join("bench.png");
    let mut command = Command::new(program);
    command.args([scene, "--preset", preset, "--size", size, "--timing", "--out"]).arg(&out);
    if !with.iter().any(|word| word == "--frames" || word.starts_with("--frames=")) {
        command.args(FRAMES);
    }
    let text = output(command.args(more).args(with), &format!("render {scene} --preset {preset}"))?;
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
fn others(command: &str) -> Result<f64, Failure> {
    let (shell, option) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let text = output(Command::new(shell).arg(option).arg(command), command)?;
    printed_ms(&text).ok_or_else(|| Failure::Failed(format!("{command}: it prints no number before `ms`")))
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
        assert_eq!(
            printed_ms("items: 4\nterms of use"),
            None,
            "the last words end in `ms`, and no number stands before"
        );
    }

    #[test]
    fn another_command_is_that_of_the_row() {
        let frame = ["spheres", "low", "640x360"];
        assert_eq!(
            filled("other --size {size} {scene} -q{preset} {scene}", frame),
            "other --size 640x360 spheres -qlow spheres"
        );
        assert_eq!(filled("other {speed}", frame), "other {speed}");
    }

    #[test]
    fn more_is_said_by_options_of_their_own() {
        let parsed = |words: &[&str]| {
            let words = ["bench", "--frames"].iter().chain(words).map(OsString::from);
            match crate::options::parse(words, &[super::super::bench::COMMAND]) {
                Ok(crate::options::Request::Run(_, options)) => options,
                other => panic!("{other:?}"),
            }
        };
        let options = parsed(&["--with", "--threads 1  --alias heap", "--rounds", "1", "--beside", "other"]);
        let all = asked(&options).unwrap_or_else(|_| panic!("these are right"));
        assert_eq!((all.rounds, all.with.join("|")), (1, "--threads|1|--alias|heap".to_owned()));
        assert_eq!(all.beside.map(|text| text.to_string_lossy().into_owned()), Some("other".to_owned()));
        let plain = parsed(&[]);
        assert!(
            asked(&plain).is_ok_and(|asked| asked.rounds == ROUNDS && asked.with.is_empty() && asked.beside.is_none())
        );
        for wrong in ["0", "-1", "many"] {
            assert!(matches!(asked(&parsed(&["--rounds", wrong])), Err(Failure::Usage(told)) if told.contains(wrong)));
        }
    }
}
