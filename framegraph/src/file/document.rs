//! Application-specific files in the same syntax as graphs and devices.

use super::error::FileErrors;
use super::spanned::Source;
use super::syntax;
use super::version::{check_version, without_mark};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Reads an application-specific file from `text`; `path` is used in errors.
///
/// The file must have a field `version`, which is checked first; `T` needs the field too.
///
/// # Errors
/// Returns an error with its position if `text` is not valid RON, or has an unsupported form or version. For an unknown
/// name, it suggests the closest known one.
pub fn document<T: DeserializeOwned>(path: &str, text: &str, version: u32) -> Result<T, FileErrors> {
    let source = Source { path, text: without_mark(text), included: &[] };
    check_version(source, version)?;
    syntax::options().from_str(source.text).map_err(|error| source.refused(&error).into())
}

/// Returns a value as text that [`document`] can read, with one field per line.
///
/// # Errors
/// Returns the message of an error that the value's `Serialize` implementation reports.
pub fn to_document<T: Serialize>(value: &T) -> Result<String, String> {
    let pretty = ron::ser::PrettyConfig::default().indentor("    ").new_line("\n");
    syntax::options().to_string_pretty(value, pretty).map(|text| text + "\n").map_err(|error| error.to_string())
}
