//! The command line of `corpus`.

use program::clap;
use program::cli::{self, Parsed, argument, option};
use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

const ABOUT: &str = "Renders every .gltf and .glb file below a folder, and reports the verdict on each.";

const AFTER: &str = "\
Each file is rendered by its own `render` process. Verdicts:
  ok          a picture, all of whose radiance is finite
  non-finite  a picture with NaN or infinity in its radiance
  refused     exit status 2: one line says what is wrong with the file
  failed      exit status 1: the device failed, or no picture was written
  crashed     ended by a signal, by a panic, or with another exit status
  hung        stopped after --seconds
  memory      stopped above --memory

A second run with the same options takes finished files from the state, unless the file or `render` has changed since.
Exit codes: 0 each file is ok or refused, 1 another verdict was given, 2 bad input or output, 128 and its number after a
signal.";

/// Returns the declaration of all options.
fn command() -> clap::Command {
    cli::command("corpus", ABOUT, AFTER)
        .override_usage("cargo xtask corpus DIR [OPTIONS] [-- OPTIONS OF render]")
        .args([
            argument("DIR", "Folder whose files are rendered"),
            option(
                "out",
                "FOLDER",
                "Results: corpus.json, sheet-1.png and further pages, pictures/, and the state from which an interrupted \
                 run resumes (target/corpus)",
            ),
            option("jobs", "N", "Processes at a time (the number of cores)"),
            option("seconds", "N", "Time limit of a file in seconds (120)"),
            option(
                "memory",
                "SIZE",
                "Limit on the resident memory of a process, checked on Linux only; `render --memory` gets half of it \
                 (2GiB)",
            ),
            option("size", "WxH", "Size of the pictures in pixels (128x128)"),
            option("render", "PROGRAM", "The `render` program (in the folder of this program)"),
        ])
}

/// Options of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Args {
    /// Folder whose files are rendered.
    pub folder: PathBuf,
    /// Folder of the results.
    pub out: PathBuf,
    /// Processes at a time.
    pub jobs: usize,
    /// Time limit of a file.
    pub limit: Duration,
    /// Limit on the resident memory of a process in bytes.
    pub memory_bytes: u64,
    /// Width and height of the pictures in pixels.
    pub size_px: [u32; 2],
    /// The `render` program.
    pub render: PathBuf,
    /// Further arguments of `render`.
    pub further: Vec<String>,
}

/// Parsed command line.
#[derive(Debug, PartialEq, Eq)]
pub enum Command {
    /// Print the help text.
    Help(String),
    /// Render the files of a folder.
    Run(Args),
}

/// Parses the command line, without the name of the program.
///
/// # Errors
/// One line that names the option and what it takes.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Command, String> {
    let mut arguments: Vec<OsString> = arguments.into_iter().collect();
    let further = match arguments.iter().position(|word| word == "--") {
        Some(at) => arguments.split_off(at).into_iter().skip(1).map(text).collect::<Result<_, _>>()?,
        None => Vec::new(),
    };
    let mut args = Args {
        folder: PathBuf::new(),
        out: PathBuf::from("target/corpus"),
        jobs: std::thread::available_parallelism().map_or(1, usize::from),
        limit: Duration::from_secs(120),
        memory_bytes: 2 << 30,
        size_px: [128, 128],
        render: PathBuf::new(),
        further,
    };
    let given = match cli::parse(command(), arguments)? {
        Parsed::Help(text) => return Ok(Command::Help(text)),
        Parsed::Given(given) => given,
    };
    if !given.has("DIR") {
        return Err("DIR: no folder is named; see --help".into());
    }
    for item in given {
        let whole = |max: u64| {
            let number = |text: &str| text.parse().ok().filter(|number| (1..=max).contains(number));
            item.parse(&format!("a whole number from 1 to {max}"), number)
        };
        match item.name() {
            "DIR" => args.folder = item.raw().into(),
            "out" => args.out = item.raw().into(),
            "render" => args.render = item.raw().into(),
            "jobs" => args.jobs = whole(1024)? as usize,
            "seconds" => args.limit = Duration::from_secs(whole(86400)?),
            "memory" => {
                let bytes = |text: &str| framegraph_check::budget::bytes(text).filter(|bytes| *bytes > 0);
                args.memory_bytes = item.parse("bytes, such as 2GiB or 500MB", bytes)?;
            }
            _ => args.size_px = item.parse("WxH in pixels, 16 to 1024 each", sides)?,
        }
    }
    if args.render.as_os_str().is_empty() {
        let own = std::env::current_exe().map_err(|error| format!("the path of this program: {error}"))?;
        args.render = own.with_file_name(format!("render{}", std::env::consts::EXE_SUFFIX));
    }
    Ok(Command::Run(args))
}

fn text(word: OsString) -> Result<String, String> {
    word.into_string().map_err(|word| format!("`{}` is not UTF-8", word.to_string_lossy()))
}

fn sides(size: &str) -> Option<[u32; 2]> {
    let (width, height) = size.split_once('x')?;
    let side = |side: &str| side.parse().ok().filter(|side| (16..=1024).contains(side));
    Some([side(width)?, side(height)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<Command, String> {
        parse(line.split_whitespace().map(OsString::from))
    }

    #[test]
    fn options_are_read_up_to_those_of_render() {
        let line = "models --out o --jobs 3 --seconds 7 --memory 1GiB --size 64x32 --render r -- --msaa 1 --size";
        let Ok(Command::Run(args)) = read(line) else { panic!("it is sound") };
        let expected = Args {
            folder: "models".into(),
            out: "o".into(),
            jobs: 3,
            limit: Duration::from_secs(7),
            memory_bytes: 1 << 30,
            size_px: [64, 32],
            render: "r".into(),
            further: ["--msaa", "1", "--size"].map(str::to_owned).into(),
        };
        assert_eq!(args, expected);
        assert!(matches!(read("--help"), Ok(Command::Help(_))));
    }

    #[test]
    fn wrong_options_are_named() {
        for (line, named) in [
            ("", "no folder"),
            ("a b", "b: unexpected argument"),
            ("a --fast", "--fast: unknown option"),
            ("a --jobs 0", "--jobs 0"),
            ("a --seconds x", "--seconds x"),
            ("a --memory much", "--memory much"),
            ("a --size 8x64", "--size 8x64"),
            ("a --out", "--out"),
        ] {
            assert!(read(line).is_err_and(|error| error.contains(named)), "{line}");
        }
    }
}
