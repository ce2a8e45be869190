//! Counts instructions per pass: the program runs itself under valgrind's callgrind.

use crate::workload::Workload;
use crate::{Frames, works};
use std::process::Command;

/// The measured operation.
#[derive(Clone, Copy, Debug)]
pub enum What {
    /// Resets and declares the graph.
    Declare,
    /// Compiles the graph.
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

/// Runs the measured frames, after two warm-up frames.
///
/// # Errors
/// Returns an error for an invalid argument.
pub fn run(graph: &str, what: &str, frames: &str) -> Result<(), String> {
    let found = works().into_iter().find(|(work, _)| work.name == graph);
    let (work, _) = found.ok_or_else(|| format!("unknown graph `{graph}`"))?;
    let what = What::named(what).ok_or_else(|| format!("`{what}` is not `declare` or `compile`"))?;
    let count: usize = frames.parse().map_err(|_| format!("`{frames}` is not a number of frames"))?;
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

// Callgrind counts instructions inside of functions with these names.

#[inline(never)]
fn counted_declare(frames: &mut Frames) {
    frames.declare();
}

#[inline(never)]
fn counted_compile(frames: &mut Frames) {
    frames.compile();
}

/// Returns the number of instructions per pass of a warm frame.
///
/// # Errors
/// Returns an error if valgrind is not installed or fails.
pub fn instructions(work: &Workload, what: What) -> Result<f64, String> {
    let passes = work.passes.len();
    let frames = (20_000 / passes).clamp(1, 100);
    let program = std::env::current_exe().map_err(|error| format!("the path of this program is unknown: {error}"))?;
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
        _ => Err(format!("valgrind failed with {}: {}", output.status, text.lines().last().unwrap_or(""))),
    }
}
