//! How far the work is, on standard error: one line that is written over on a terminal; elsewhere a line when a stage is
//! done, and now and then while it lasts.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Between two lines of a stage in a log.
const PAUSE: Duration = Duration::from_secs(5);

/// Shows progress.
#[derive(Debug)]
pub struct Shown {
    terminal: bool,
    stage: String,
    last: Instant,
}

impl Default for Shown {
    fn default() -> Self {
        Self { terminal: io::stderr().is_terminal(), stage: String::new(), last: Instant::now() }
    }
}

impl Shown {
    /// `done` of `total` items of a stage are finished, the latest of them `item`, which may be empty.
    pub fn step(&mut self, stage: impl Display, done: usize, total: usize, item: &str) {
        let mut err = io::stderr().lock();
        // What cannot be shown must not stop the work.
        if self.terminal {
            let _ = write!(err, "\r\x1b[K{stage} {done}/{total} {item}");
            let _ = err.flush();
            return;
        }
        let stage = stage.to_string();
        if done == total && self.stage != stage {
            let _ = writeln!(err, "{stage}: {total}");
            (self.stage, self.last) = (stage, Instant::now());
        } else if done < total && self.last.elapsed() >= PAUSE {
            let _ = writeln!(err, "{stage}: {done} of {total} {item}");
            self.last = Instant::now();
        }
    }

    /// Leaves the line free for other words.
    pub fn clear(&self) {
        if self.terminal {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }
}
