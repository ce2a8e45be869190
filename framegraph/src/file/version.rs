//! What is looked at before a file is read: the mark in front of its text, and its version.

use super::error::{FileError, FileReason};
use super::form::VersionForm;
use super::spanned::{Source, Spanned};
use super::syntax::options;

/// The version of the format that is read and written.
pub const GRAPH_VERSION: u32 = 1;

/// The text behind the mark that some editors put in front of UTF-8.
pub(super) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Refuses a file of another version before anything else in it is looked at.
pub(super) fn check_version(source: Source<'_>, known: u32) -> Result<(), FileError> {
    let form: VersionForm = options().from_str(source.text).map_err(|error| source.refused(&error))?;
    self::known(source, &form.version, known)
}

/// Refuses any version but the known one.
pub(super) fn known(source: Source<'_>, version: &Spanned<u32>, known: u32) -> Result<(), FileError> {
    let found = version.value;
    if found == known { Ok(()) } else { Err(source.error(version, FileReason::Version { found, known })) }
}
