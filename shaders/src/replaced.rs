//! Support for mutation tests: replaces embedded texts, and records the lines that a program compiles.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// Returns the text of this path in the folder that the environment variable `FRAMEGRAPH_WGSL` names, if it exists.
/// Each text is read once and kept.
pub(crate) fn text(path: &str) -> Option<&'static str> {
    static READ: Mutex<BTreeMap<String, Option<&'static str>>> = Mutex::new(BTreeMap::new());
    let mut texts = READ.lock().unwrap_or_else(PoisonError::into_inner);
    let read = || {
        let folder = PathBuf::from(std::env::var_os("FRAMEGRAPH_WGSL")?);
        std::fs::read_to_string(folder.join(path)).ok().map(|text| &*text.leak())
    };
    *texts.entry(path.to_owned()).or_insert_with(read)
}

/// Appends each line once, as file and number, to the file that the environment variable `FRAMEGRAPH_WGSL_LINES` names.
pub(crate) fn note<'a>(lines: impl Iterator<Item = (&'a str, usize)>) {
    static NOTED: Mutex<BTreeSet<(String, usize)>> = Mutex::new(BTreeSet::new());
    let Some(file) = std::env::var_os("FRAMEGRAPH_WGSL_LINES") else { return };
    let mut noted = NOTED.lock().unwrap_or_else(PoisonError::into_inner);
    let new = lines.filter(|(file, line)| noted.insert(((*file).to_owned(), *line)));
    let text: String = new.map(|(file, line)| format!("{file}:{line}\n")).collect();
    let written = std::fs::OpenOptions::new().create(true).append(true).open(&file);
    written.and_then(|mut out| out.write_all(text.as_bytes())).expect("FRAMEGRAPH_WGSL_LINES names a file to write");
}
