//! Progress on standard error.
//!
//! On a terminal, one line is overwritten, by `indicatif`. Elsewhere a line is printed when a stage is done, and every
//! five seconds while it lasts.

use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Interval between two lines of a stage in a log.
const PAUSE: Duration = Duration::from_secs(5);

/// Progress display.
#[derive(Debug)]
pub struct Shown {
    bar: ProgressBar,
    stage: String,
    last: Instant,
}

impl Default for Shown {
    fn default() -> Self {
        Self { bar: bar(), stage: String::new(), last: Instant::now() }
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix} {pos}/{len} [{bar:24}] {wide_msg}");
    ProgressBar::no_length().with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

impl Shown {
    /// Reports `done` of `total` items of a stage. `item` names the latest one and may be empty.
    pub fn step(&mut self, stage: impl Display, done: usize, total: usize, item: &str) {
        let stage = stage.to_string();
        if io::stderr().is_terminal() {
            self.bar.set_length(total as u64);
            self.bar.set_prefix(stage);
            self.bar.set_message(item.to_owned());
            self.bar.set_position(done as u64);
            return;
        }
        // Failing to print must not stop the work.
        let mut err = io::stderr().lock();
        if done == total && self.stage != stage {
            let _ = writeln!(err, "{stage}: {total}");
            (self.stage, self.last) = (stage, Instant::now());
        } else if done < total && self.last.elapsed() >= PAUSE {
            let _ = writeln!(err, "{stage}: {done} of {total} {item}");
            self.last = Instant::now();
        }
    }

    /// Clears the progress line before other output.
    pub fn clear(&mut self) {
        std::mem::replace(&mut self.bar, bar()).finish_and_clear();
    }
}
