//! Committed texts of plans, compared line by line.
//!
//! Dumps of a plan are equal byte for byte on every machine, so a committed dump shows in a review what a change costs.
//! [`check`] compares a text with a file. With the environment variable [`UPDATE`] it writes the file.

use similar::TextDiff;
use std::fmt;
use std::path::Path;

/// Name of the environment variable that makes [`check`] write files. Any value except `0` and the empty text counts.
pub const UPDATE: &str = "UPDATE_GOLDENS";

/// Returns `true` if the environment variable [`UPDATE`] is set.
#[must_use]
pub fn is_updating() -> bool {
    std::env::var_os(UPDATE).is_some_and(|value| !value.is_empty() && value != "0")
}

/// Compares a text with the file at `path`, or writes the file if [`is_updating`].
///
/// ```no_run
/// # fn test(plan: &framegraph::Plan) -> Result<(), framegraph_check::golden::GoldenError> {
/// framegraph_check::golden::check("tests/goldens/frame.plan", &framegraph::dump::text(plan))?;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The file is missing, cannot be read or written, or its text differs.
pub fn check(path: impl AsRef<Path>, text: &str) -> Result<(), GoldenError> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let failed = |error: std::io::Error| GoldenError::File { name: name.clone(), error: error.to_string() };
    if is_updating() {
        return std::fs::write(path, text).map_err(failed);
    }
    let unread = |error| failed(std::io::Error::other(format!("{error}; set {UPDATE}=1 to write it")));
    compare(&name, &std::fs::read_to_string(path).map_err(unread)?, text)
}

/// Compares a text with a committed one; `name` is its file in the error. Line ends of Windows count as line feeds.
///
/// # Errors
/// The texts differ.
pub fn compare(name: &str, committed: &str, text: &str) -> Result<(), GoldenError> {
    let committed = committed.replace("\r\n", "\n");
    if committed == text {
        return Ok(());
    }
    let diff = TextDiff::from_lines(committed.as_str(), text);
    let diff = diff.unified_diff().context_radius(3).header(name, "now").to_string();
    Err(GoldenError::Differs { name: name.to_owned(), diff })
}

/// Error: a text is not the committed one. `Debug` prints the sentences of `Display`, for tests that unwrap.
#[derive(Clone, PartialEq, Eq)]
pub enum GoldenError {
    /// The file cannot be read or written.
    File {
        /// Path of the file.
        name: String,
        /// Reason of the system.
        error: String,
    },
    /// The texts differ.
    Differs {
        /// Path of the file.
        name: String,
        /// Differing lines in the unified format, with three lines of context.
        diff: String,
    },
}

impl fmt::Display for GoldenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { name, error } => write!(f, "{name}: {error}"),
            Self::Differs { name, diff } => {
                write!(f, "{name}: the text differs; set {UPDATE}=1 to write it anew\n{}", diff.trim_end())
            }
        }
    }
}

impl fmt::Debug for GoldenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for GoldenError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_shown_with_its_lines() {
        assert_eq!(compare("a.plan", "one\r\ntwo\r\n", "one\ntwo\n"), Ok(()));
        let error = compare("a.plan", "one\ntwo\n", "one\n2\n").unwrap_err().to_string();
        assert_eq!(
            error,
            "a.plan: the text differs; set UPDATE_GOLDENS=1 to write it anew\n--- a.plan\n+++ now\n@@ -1,2 +1,2 @@\n \
             one\n-two\n+2"
        );
        let error = check("no/such/file.plan", "").unwrap_err().to_string();
        assert!(error.starts_with("no/such/file.plan: ") && error.ends_with("; set UPDATE_GOLDENS=1 to write it"));
    }
}
