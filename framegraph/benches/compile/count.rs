//! Instructions per pass: this program runs itself under valgrind's callgrind, which counts them.

use crate::workload::Workload;
use crate::{Frames, works};
use std::process::Command;

/// What is counted.
#[derive(Clone, Copy, Debug)]
pub enum What {
    /// Resetting the graph and declaring it.
    Declare,
    /// Compiling it.
    Compile,
}

impl What {
    const fn word(self) -> &'static str {
        match self {
            Self::Declare => "declare",
            Self::Compile => "compile",
        }
    }

    fn named(word: &str) -> Option<Self> {
        [Self::Declare, Self::Compile].into_iter().find(|what| what.word() == word)
    }
}

/// Runs the frames that are counted, after two that warm up.
///
/// # Errors
/// When an argument means nothing.
pub fn run(graph: &str, what: &str, frames: &str) -> Result<(), String> {
    let found = works().into_iter().find(|(work, _)| work.name == graph);
    let (work, _) = found.ok_or_else(|| format!("there is no graph `{graph}`"))?;
    let what = What::named(what).ok_or_else(|| format!("`{what}` is neither `declare` nor `compile`"))?;
    let count: usize = frames.parse().map_err(|_| format!("`{frames}` is no number of frames"))?;
    let mut frames = Frames::new(work);
    for _ in 0..2 {
        frames.declare();
        frames.compile();
    }
    for _ in 0..count {
        match what {
            What::Declare => counted_declare(&mut frames),
            What::Compile => counted_compile(&mut frames),
        }
    }
    Ok(())
}

// Callgrind counts what happens inside of functions of these names.

#[inline(never)]
fn counted_declare(frames: &mut Frames) {
    frames.declare();
}

#[inline(never)]
fn counted_compile(frames: &mut Frames) {
    frames.compile();
}

/// Instructions per pass of a warm frame.
///
/// # Errors
/// Why they could not be counted: valgrind is not there, or it failed.
pub fn instructions(work: &Workload, what: What) -> Result<f64, String> {
    let passes = work.passes.len();
    let frames = (20_000 / passes).clamp(1, 100);
    let program = std::env::current_exe().map_err(|error| format!("this program cannot be found: {error}"))?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg(format!("--toggle-collect=*counted_{}*", what.word()))
        .arg(program)
        .args(["--count", &work.name, what.word(), &frames.to_string()])
        .output();
    let output = output.map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "valgrind is not installed".to_owned(),
        _ => format!("valgrind cannot be started: {error}"),
    })?;
    let text = String::from_utf8_lossy(&output.stderr);
    let counted = text.lines().find_map(|line| line.split("Collected :").nth(1)?.trim().parse::<u64>().ok());
    match counted {
        Some(count) if output.status.success() && count > 0 => Ok(count as f64 / (frames * passes) as f64),
        _ => Err(format!("valgrind ended with {} and said: {}", output.status, text.lines().last().unwrap_or(""))),
    }
}
