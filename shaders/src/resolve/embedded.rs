//! Token cache of embedded files: each file is read once per program.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::code::Code;
use super::fault::Fault;
use crate::library;

/// Returns the tokens of the embedded file with this path, if it exists.
///
/// # Errors
///
/// If a comment or a bracket is not closed. This requires a text that replaces the embedded file.
pub(super) fn code(path: &str) -> Result<Option<&'static Code<'static>>, Fault> {
    static READ: Mutex<BTreeMap<String, &'static Code<'static>>> = Mutex::new(BTreeMap::new());
    let Some(text) = library::in_use(path) else { return Ok(None) };
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = read.get(path) {
        return Ok(Some(*known));
    }
    let code: &'static Code<'static> = Box::leak(Box::new(Code::new(text)?));
    read.insert(path.to_owned(), code);
    Ok(Some(code))
}
