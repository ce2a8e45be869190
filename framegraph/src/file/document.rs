//! Files of other kinds than graphs and devices, read and written as these are.

use super::error::FileErrors;
use super::spanned::Source;
use super::syntax;
use super::version::{check_version, without_mark};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Reads a file of an application's own kind from `text`; `path` is what errors call it. The file has a field `version`, which
/// is checked before everything else; `T` has the field too.
///
/// # Errors
/// Text that is no RON, or not of this form or version, with its place and, for an unknown name, the nearest that is known.
pub fn document<T: DeserializeOwned>(path: &str, text: &str, version: u32) -> Result<T, FileErrors> {
    let source = Source { path, text: without_mark(text), included: &[] };
    check_version(source, version)?;
    syntax::options().from_str(source.text).map_err(|error| source.refused(&error).into())
}

/// A value as [`document`] reads it, a field a line.
///
/// # Errors
/// What the value itself refuses, in words.
pub fn to_document<T: Serialize>(value: &T) -> Result<String, String> {
    let pretty = ron::ser::PrettyConfig::default().indentor("    ").new_line("\n");
    syntax::options().to_string_pretty(value, pretty).map(|text| text + "\n").map_err(|error| error.to_string())
}
