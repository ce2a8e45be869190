//! The verdict on a file.

use crate::child::{End, Ended};
use serde::{Deserialize, Serialize};
use std::process::ExitStatus;

/// The verdict on a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Rendered; all radiance is finite.
    Ok,
    /// Rendered; the radiance has NaN or infinity.
    NonFinite,
    /// Refused with a message.
    Refused,
    /// The device failed, or no picture was written.
    Failed,
    /// Ended by a signal, by a panic, or with an exit status that `render` does not have.
    Crashed,
    /// Stopped at the time limit.
    Hung,
    /// Stopped above the memory limit.
    Memory,
}

impl Verdict {
    /// All verdicts, in the order of reports.
    pub const ALL: [Self; 7] =
        [Self::Ok, Self::NonFinite, Self::Refused, Self::Failed, Self::Crashed, Self::Hung, Self::Memory];

    /// Word for reports.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::NonFinite => "non-finite",
            Self::Refused => "refused",
            Self::Failed => "failed",
            Self::Crashed => "crashed",
            Self::Hung => "hung",
            Self::Memory => "memory",
        }
    }

    /// Returns whether the verdict is a fault of the renderer, rather than of the file.
    #[must_use]
    pub fn is_fault(self) -> bool {
        !matches!(self, Self::Ok | Self::Refused)
    }
}

/// A verdict with its reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Judged {
    /// The verdict.
    pub verdict: Verdict,
    /// Reason in one line; empty for [`Verdict::Ok`].
    pub message: String,
    /// Warnings that `render` printed.
    pub warnings: Vec<String>,
}

/// Judges a file by how its process ended; `has_picture` says that the picture was written. Returns none for a process
/// that was stopped with the whole run.
#[must_use]
pub fn judge(ended: &Ended, has_picture: bool) -> Option<Judged> {
    let (verdict, message) = match ended.end {
        End::Interrupted => return None,
        End::Time => (Verdict::Hung, format!("stopped after {:.0} s", ended.took.as_secs_f64())),
        End::Memory => (Verdict::Memory, format!("stopped at {} MiB", ended.peak_bytes >> 20)),
        End::Status(status) => match (status.code(), error_line(&ended.err)) {
            (Some(0), _) if !has_picture => (Verdict::Failed, "no picture was written".to_owned()),
            (Some(0), _) => match non_finite(&ended.out) {
                Some(0) => (Verdict::Ok, String::new()),
                Some(count) => (Verdict::NonFinite, format!("{count} texels are not finite")),
                None => (Verdict::Failed, "the radiance was not inspected".to_owned()),
            },
            (Some(1), Some(line)) => (Verdict::Failed, line.to_owned()),
            (Some(2), Some(line)) => (Verdict::Refused, line.to_owned()),
            _ => (Verdict::Crashed, crash(status, &ended.err)),
        },
    };
    let warnings = ended.err.lines().filter_map(|line| line.strip_prefix("warning: ")).map(str::to_owned).collect();
    Some(Judged { verdict, message, warnings })
}

/// Returns the message of `render`: its last line that begins with `error: `.
fn error_line(err: &str) -> Option<&str> {
    err.lines().rev().find_map(|line| line.strip_prefix("error: "))
}

/// Returns the number of texels that `render --inspect hdr` reports as not finite; none if it reports nothing.
fn non_finite(out: &str) -> Option<u64> {
    let line = out.lines().find(|line| line.contains(": hdr@"))?;
    match line.strip_suffix(" texels not finite") {
        Some(line) => line.rsplit(' ').next()?.parse().ok(),
        None => Some(0),
    }
}

/// Describes a crash: its status, and the message of a panic.
fn crash(status: ExitStatus, err: &str) -> String {
    let mut lines = err.lines().skip_while(|line| !line.contains(" panicked at "));
    let panic = lines.next().map(|place| format!("; {place} {}", lines.next().unwrap_or_default()));
    format!("{status}{}", panic.unwrap_or_default())
}
