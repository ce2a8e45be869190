//! `cargo xtask corpus`: render every glTF file below a folder, and report the verdicts.

use super::Command;
use crate::options::Options;
use crate::{Failure, adapter, workspace};
use std::ffi::OsStr;
use std::process::Command as Process;

/// The command.
pub const COMMAND: Command = Command {
    name: "corpus",
    summary: "render every glTF file below a folder, and report the verdicts",
    details: "\
Builds `render` in release, and renders every .gltf and .glb file below DIR,
each in its own process with limits of time and memory. Prints the counts of
verdicts (ok, non-finite, refused, failed, crashed, hung, memory) and each file
that is not ok with its message. An interrupted run resumes.

  DIR                the folder
  --out FOLDER       results: corpus.json, contact sheets, pictures, and the
                     state from which a run resumes (target/corpus)
  --jobs N           processes at a time (the number of cores)
  --seconds N        time limit of a file in seconds (120)
  --memory SIZE      limit on the resident memory of a process, checked on
                     Linux only; `render --memory` gets half of it (2GiB)
  --size WxH         size of the pictures in pixels (128x128)
  --render PROGRAM   a `render` that is built already
  -- OPTIONS         further options of `render`

Exit codes: 0 each file is ok or refused, 1 another verdict was given, 2 bad
input or output, 128 and its number after a signal.
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    let words = &options.words_of_corpus;
    let own = words.split(|word| word == "--").next().unwrap_or_default();
    if !own.iter().any(|word| is_render(word)) {
        adapter::ready(options)?;
        let build = ["build", "--release", "--package", "examples", "--bin", "render"];
        let built = workspace::cargo(&build).status().map_err(|error| Failure::Failed(error.to_string()))?;
        if !built.success() {
            return Err(Failure::Failed("render could not be built".to_owned()));
        }
    }
    let here = std::env::current_dir().map_err(|error| Failure::Failed(format!("the working folder: {error}")))?;
    let manifest = workspace::root().join("Cargo.toml");
    let mut command = workspace::cargo(&["run", "--quiet", "--release", "--package", "corpus", "--manifest-path"]);
    // Paths on the command line are relative to the folder of the caller.
    command.arg(manifest).arg("--").args(words).current_dir(here);
    become_it(&mut command)
}

/// Returns whether a word is the option that names `render`.
fn is_render(word: &OsStr) -> bool {
    word.to_str().is_some_and(|word| word == "--render" || word.starts_with("--render="))
}

/// Replaces this process by a command, so that signals reach it and its exit code counts.
#[cfg(unix)]
fn become_it(command: &mut Process) -> Result<(), Failure> {
    use std::os::unix::process::CommandExt as _;
    Err(Failure::Failed(format!("corpus: {}", command.exec())))
}

/// Runs a command to its end.
#[cfg(not(unix))]
fn become_it(command: &mut Process) -> Result<(), Failure> {
    let status = command.status().map_err(|error| Failure::Failed(format!("corpus: {error}")))?;
    if status.success() { Ok(()) } else { Err(Failure::Failed(format!("corpus: {status}"))) }
}
