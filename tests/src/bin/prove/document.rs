//! The document in the making, what speaks against a claim, and how far the work is.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// What is printed, and what was found wrong.
#[derive(Debug)]
pub struct Document {
    /// The text so far.
    pub text: String,
    /// Claims that do not hold, a sentence each.
    pub faults: Vec<String>,
    last: Instant,
    pause: Duration,
}

impl Document {
    /// A document that begins so. Progress is told often where somebody watches, seldom in a log.
    pub fn new(text: &str) -> Self {
        let seconds = if std::io::stderr().is_terminal() { 1 } else { 10 };
        Self { text: text.to_owned(), faults: Vec::new(), last: Instant::now(), pause: Duration::from_secs(seconds) }
    }

    /// Adds a section.
    pub fn section(&mut self, head: &str, body: &str) {
        self.text += &format!("\n## {head}\n\n{body}");
    }

    /// Notes that a claim does not hold, unless it does.
    pub fn claim(&mut self, holds: bool, otherwise: impl FnOnce() -> String) {
        if !holds {
            self.faults.push(otherwise());
        }
    }

    /// So much of `what` is done.
    pub fn at(&mut self, what: &str, done: usize, of: usize) {
        if self.last.elapsed() >= self.pause {
            self.last = Instant::now();
            program::note(format_args!("prove: {what}: {done} of {of}"));
        }
    }
}
