//! `cargo xtask bench --frames`: measures whole frames of each preset over built-in scenes, with and without
//! optimizations of the graph.

use crate::options::Options;
use crate::{Failure, workspace};
use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

/// Scenes with different workloads.
const SCENES: [&str; 6] = ["spheres", "columns", "materials", "glass", "lobes", "lamps:100"];
const PRESETS: [&str; 4] = ["low", "medium", "high", "ultra"];
const SIZES: [&str; 2] = ["1280x720", "1920x1080"];
/// Optimizations that are switched off, with the options that do so; the first row changes nothing.
const WITHOUT: [(&str, &[&str]); 6] = [
    ("as it is", &[]),
    ("a prepass", &["--enable", "prepass"]),
    ("no dropping", &["--force-effects"]),
    ("no merging", &["--debug", "no-merge"]),
    ("no inlining", &["--inline", "off"]),
    ("no aliasing", &["--alias", "none"]),
];
/// Default number of runs per variant. Variants alternate, so that all see the same state of the machine.
const ROUNDS: usize = 3;

/// Default number of frames for the median; `--with` overrides it.
const FRAMES: [&str; 2] = ["--frames", "6"];

/// Options of a table.
struct Asked<'a> {
    /// Runs per variant.
    rounds: usize,
    /// Additional arguments for `render`.
    with: Vec<String>,
    /// Command of another renderer to compare with.
    beside: Option<&'a OsString>,
}

/// Measures frames and prints a table in Markdown.
///
/// # Errors
/// An invalid option, a failed build or run of `render`, or another program that prints no time.
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
        "Median frame times in ms: GPU times if the device has timestamps. Variants alternate; {} each.\n\n| {} |\n|{}\n",
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

/// Returns the median time of each variant, then of the other program, in ms.
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

/// Reads the options other than scenes, presets and sizes.
fn asked(options: &Options) -> Result<Asked<'_>, Failure> {
    let rounds = match options.value("--rounds").map(|text| text.to_string_lossy()) {
        None => ROUNDS,
        Some(text) => text
            .parse()
            .ok()
            .filter(|rounds| *rounds > 0)
            .ok_or_else(|| Failure::Usage(format!("`--rounds {text}`: not a whole number of at least 1")))?,
    };
    let with = options.value("--with").map(|text| text.to_string_lossy().into_owned()).unwrap_or_default();
    let with = with.split_whitespace().map(str::to_owned).collect();
    Ok(Asked { rounds, with, beside: options.value("--beside") })
}

/// Inserts scene, preset and size into the command of another renderer.
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
    frame_ms(&text).ok_or_else(|| Failure::Failed(format!("render {scene}: no row `frame` in its output")))
}

/// Returns the median of the row `frame` in ms: GPU time if it was measured, else CPU time.
fn frame_ms(text: &str) -> Option<f64> {
    let row = text.lines().find(|line| line.starts_with("| frame |"))?;
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    let number = |index: usize| cells.get(index).and_then(|cell| cell.parse::<f64>().ok());
    // Columns: step, passes, then minimum, quartile and median for CPU and GPU.
    number(8).or_else(|| number(5))
}

/// Returns the time that another program prints: the last number before `ms`.
fn others(command: &str) -> Result<f64, Failure> {
    let (shell, option) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let text = output(Command::new(shell).arg(option).arg(command), command)?;
    printed_ms(&text).ok_or_else(|| Failure::Failed(format!("{command}: its output has no number before `ms`")))
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
