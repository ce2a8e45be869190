//! Byte order mark and version of a file, checked before anything else.

use super::error::{FileError, FileReason};
use super::form::VersionForm;
use super::spanned::{Source, Spanned};
use super::syntax::options;

/// Version of the graph file format that is read and written.
pub const GRAPH_VERSION: u32 = 1;

/// Removes the byte order mark that some editors write at the start of UTF-8 files.
pub(super) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Rejects a file with another version, without parsing anything else.
pub(super) fn check_version(source: Source<'_>, known: u32) -> Result<(), FileError> {
    let form: VersionForm = options().from_str(source.text).map_err(|error| source.refused(&error))?;
    self::known(source, &form.version, known)
}

/// Rejects any version except the known one.
pub(super) fn known(source: Source<'_>, version: &Spanned<u32>, known: u32) -> Result<(), FileError> {
    let found = version.value;
    if found == known { Ok(()) } else { Err(source.error(version, FileReason::Version { found, known })) }
}
