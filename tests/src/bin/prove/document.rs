//! Document under construction, with refuted claims and progress.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Printed text and refuted claims.
#[derive(Debug)]
pub struct Document {
    /// Text so far.
    pub text: String,
    /// Refuted claims, one sentence each.
    pub faults: Vec<String>,
    last: Instant,
    pause: Duration,
}

impl Document {
    /// Creates a document with initial text. Progress is reported often on a terminal, seldom in a log.
    pub fn new(text: &str) -> Self {
        let seconds = if std::io::stderr().is_terminal() { 1 } else { 10 };
        Self { text: text.to_owned(), faults: Vec::new(), last: Instant::now(), pause: Duration::from_secs(seconds) }
    }

    /// Adds a section.
    pub fn section(&mut self, head: &str, body: &str) {
        self.text += &format!("\n## {head}\n\n{body}");
    }

    /// Records a refuted claim if `holds` is false.
    pub fn claim(&mut self, holds: bool, otherwise: impl FnOnce() -> String) {
        if !holds {
            self.faults.push(otherwise());
        }
    }

    /// Reports progress: `done` of `of` items of `what`.
    pub fn at(&mut self, what: &str, done: usize, of: usize) {
        if self.last.elapsed() >= self.pause {
            self.last = Instant::now();
            program::note(format_args!("prove: {what}: {done} of {of}"));
        }
    }
}
