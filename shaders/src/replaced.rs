//! For tests that plant faults: shaders made of other texts than the embedded ones, and which lines a program compiles.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::{Mutex, OnceLock};

use crate::library::SOURCES;

/// The text of this path in the folder that the variable `FRAMEGRAPH_WGSL` names, if it has one. Read once, when the first
/// file is asked for.
pub(crate) fn text(path: &str) -> Option<&'static str> {
    static REPLACED: OnceLock<BTreeMap<&str, String>> = OnceLock::new();
    let replaced = REPLACED.get_or_init(|| {
        let folder = std::env::var_os("FRAMEGRAPH_WGSL").map(PathBuf::from);
        let read = |path| Some((path, std::fs::read_to_string(folder.as_ref()?.join(path)).ok()?));
        SOURCES.iter().filter_map(|source| read(source.path)).collect()
    });
    replaced.get(path).map(String::as_str)
}

/// Adds lines, as file and number, to the file that the variable `FRAMEGRAPH_WGSL_LINES` names, each once.
pub(crate) fn note<'a>(lines: impl Iterator<Item = (&'a str, usize)>) {
    static NOTED: Mutex<BTreeSet<(String, usize)>> = Mutex::new(BTreeSet::new());
    let Some(file) = std::env::var_os("FRAMEGRAPH_WGSL_LINES") else { return };
    let mut noted = NOTED.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let new = lines.filter(|(file, line)| noted.insert(((*file).to_owned(), *line)));
    let text: String = new.map(|(file, line)| format!("{file}:{line}\n")).collect();
    let written = std::fs::OpenOptions::new().create(true).append(true).open(&file);
    written.and_then(|mut out| out.write_all(text.as_bytes())).expect("FRAMEGRAPH_WGSL_LINES names a file to write");
}
