//! The command line of `corpus`.

use lexopt::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

/// Text of `corpus --help`.
pub const HELP: &str = "\
Renders every .gltf and .glb file below a folder, and reports the verdict on each.

usage: cargo xtask corpus DIR [options] [-- OPTIONS OF render]

Each file is rendered by its own `render` process. Verdicts:
  ok          a picture, all of whose radiance is finite
  non-finite  a picture with NaN or infinity in its radiance
  refused     exit status 2: one line says what is wrong with the file
  failed      exit status 1: the device failed, or no picture was written
  crashed     ended by a signal, by a panic, or with another exit status
  hung        stopped after --seconds
  memory      stopped above --memory

  --out FOLDER         results: corpus.json, sheet-1.png and further pages, pictures/, and the state from which an
                       interrupted run resumes (target/corpus)
  --jobs N             processes at a time (the number of cores)
  --seconds N          time limit of a file in seconds (120)
  --memory SIZE        limit on the resident memory of a process, checked on Linux only; `render --memory` gets half of
                       it (2GiB)
  --size WxH           size of the pictures in pixels (128x128)
  --render PROGRAM     the `render` program (beside this program)
  --help               this text

A second run with the same options takes finished files from the state, unless the file or `render` has changed since.
Exit codes: 0 each file is ok or refused, 1 another verdict was given, 2 bad input or output, 128 and its number after a
signal.";

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
    Help,
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
    let mut folder = None;
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
    let mut parser = lexopt::Parser::from_args(arguments);
    while let Some(argument) = parser.next().map_err(|error| error.to_string())? {
        let name = match &argument {
            Long(name) => format!("--{name}"),
            Short(letter) => format!("-{letter}"),
            Value(path) => {
                if folder.replace(PathBuf::from(path)).is_some() {
                    return Err(format!("`{}`: one folder is rendered at a time", path.to_string_lossy()));
                }
                continue;
            }
        };
        if matches!(name.as_str(), "--help" | "-h") {
            return Ok(Command::Help);
        }
        let mut value = || parser.value().map_err(|error| error.to_string());
        match name.as_str() {
            "--out" => args.out = value()?.into(),
            "--render" => args.render = value()?.into(),
            "--jobs" => args.jobs = whole(&name, &text(value()?)?, 1024)? as usize,
            "--seconds" => args.limit = Duration::from_secs(whole(&name, &text(value()?)?, 86400)?),
            "--memory" => {
                let size = text(value()?)?;
                let bytes = program::bytes(&size).filter(|bytes| *bytes > 0);
                args.memory_bytes = bytes.ok_or(format!("--memory {size}: give bytes, such as 2GiB or 500MB"))?;
            }
            "--size" => {
                let size = text(value()?)?;
                args.size_px = sides(&size).ok_or(format!("--size {size}: give WxH in pixels, 16 to 1024 each"))?;
            }
            _ => return Err(format!("unknown option `{name}`; see --help")),
        }
    }
    args.folder = folder.ok_or("no folder is named; see --help")?;
    if args.render.as_os_str().is_empty() {
        let own = std::env::current_exe().map_err(|error| format!("the path of this program: {error}"))?;
        args.render = own.with_file_name(format!("render{}", std::env::consts::EXE_SUFFIX));
    }
    Ok(Command::Run(args))
}

fn text(word: OsString) -> Result<String, String> {
    word.into_string().map_err(|word| format!("`{}` is not UTF-8", word.to_string_lossy()))
}

fn whole(name: &str, value: &str, max: u64) -> Result<u64, String> {
    let number = value.parse().ok().filter(|number| (1..=max).contains(number));
    number.ok_or_else(|| format!("{name} {value}: give a whole number from 1 to {max}"))
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
        assert_eq!(read("--help"), Ok(Command::Help));
    }

    #[test]
    fn wrong_options_are_named() {
        for (line, named) in [
            ("", "no folder"),
            ("a b", "`b`"),
            ("a --fast", "`--fast`"),
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
