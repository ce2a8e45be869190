//! Results as JSON, and the state from which an interrupted run resumes.

use crate::args::Args;
use crate::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::Path;
use std::time::UNIX_EPOCH;

/// Version of [`Report`] as JSON. Readers refuse another one.
pub const VERSION: u32 = 1;

/// Result of a whole run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`VERSION`].
    pub version: u32,
    /// Everything but the files that the verdicts depend on.
    pub with: With,
    /// A record for each file, sorted by name.
    pub files: Vec<Record>,
}

impl Report {
    /// Number of files with a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.files.iter().filter(|record| record.verdict == verdict).count()
    }

    /// Returns whether a file has a verdict that is a fault of the renderer.
    #[must_use]
    pub fn has_faults(&self) -> bool {
        self.files.iter().any(|record| record.verdict.is_fault())
    }
}

/// Everything but the files that verdicts depend on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct With {
    /// Length and time of change of `render`.
    pub render: Stamp,
    /// Width and height of the pictures in pixels.
    pub size_px: [u32; 2],
    /// Time limit in seconds.
    pub seconds: u64,
    /// Memory limit in bytes.
    pub memory_bytes: u64,
    /// Further arguments of `render`.
    pub further: Vec<String>,
}

impl With {
    /// Returns what a run with these options depends on.
    ///
    /// # Errors
    /// When there is no such `render`.
    pub fn of(args: &Args) -> Result<Self, String> {
        let render = Stamp::of(&args.render).map_err(|error| format!("{}: {error}", args.render.display()))?;
        let (size_px, memory_bytes, further) = (args.size_px, args.memory_bytes, args.further.clone());
        Ok(Self { render, size_px, seconds: args.limit.as_secs(), memory_bytes, further })
    }
}

/// Length and time of change of a file; a difference means that the file was replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stamp {
    /// Length in bytes.
    pub bytes: u64,
    /// Time of change, in milliseconds since 1970.
    pub changed_ms: u64,
}

impl Stamp {
    /// Returns the stamp of a file.
    ///
    /// # Errors
    /// When the system does not tell.
    pub fn of(file: &Path) -> io::Result<Self> {
        let metadata = fs::metadata(file)?;
        let changed = metadata.modified()?.duration_since(UNIX_EPOCH).unwrap_or_default();
        Ok(Self { bytes: metadata.len(), changed_ms: changed.as_millis() as u64 })
    }
}

/// Result for one file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Path below the folder, with `/`.
    pub file: String,
    /// The file when it was rendered.
    pub stamp: Stamp,
    /// The verdict.
    pub verdict: Verdict,
    /// Reason in one line; empty for [`Verdict::Ok`].
    pub message: String,
    /// Warnings that `render` printed.
    pub warnings: Vec<String>,
    /// Wall-clock time in seconds.
    pub seconds: f64,
    /// Largest resident memory in bytes; 0 where the system does not report it.
    pub peak_bytes: u64,
    /// Picture below the output folder, if one was written.
    pub picture: Option<String>,
}

/// Finished records, appended to a file as they come: a line of JSON each, after a line with what they depend on.
#[derive(Debug)]
pub struct State(File);

impl State {
    /// Opens a state file, and returns the records that an earlier run with the same `with` left there. A line that was cut
    /// off is dropped.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn open(file: &Path, with: &With) -> io::Result<(Self, Vec<Record>)> {
        let text = fs::read_to_string(file).unwrap_or_default();
        let mut lines = text.lines();
        let is_same = lines.next().is_some_and(|head| serde_json::from_str::<With>(head).is_ok_and(|w| w == *with));
        let kept: Vec<Record> =
            if is_same { lines.filter_map(|line| serde_json::from_str(line).ok()).collect() } else { Vec::new() };
        let mut state = Self(File::create(file)?);
        state.line(with)?;
        kept.iter().try_for_each(|record| state.line(record))?;
        Ok((state, kept))
    }

    /// Appends a record.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn line(&mut self, record: &impl Serialize) -> io::Result<()> {
        let line = serde_json::to_string(record).map_err(io::Error::other)? + "\n";
        self.0.write_all(line.as_bytes())
    }
}
