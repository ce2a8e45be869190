//! Progress on standard error.
//!
//! On a terminal, one line is overwritten. Elsewhere a line is printed when a stage is done, and every five seconds
//! while it lasts.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Interval between two lines of a stage in a log.
const PAUSE: Duration = Duration::from_secs(5);

/// Progress display.
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
    /// Reports `done` of `total` items of a stage. `item` names the latest one and may be empty.
    pub fn step(&mut self, stage: impl Display, done: usize, total: usize, item: &str) {
        let mut err = io::stderr().lock();
        // Failing to print must not stop the work.
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

    /// Clears the progress line before other output.
    pub fn clear(&self) {
        if self.terminal {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }
}
