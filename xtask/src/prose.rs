//! Style check of documentation, comments, messages and Markdown.
//!
//! ```text
//! files ─ text ─> paragraphs ─ rules ─> flagged sentences ─ ratchet ─> failed, or limits to lower
//! ```
//!
//! The rules are heuristics: a sentence that passes can still read badly, and a few good sentences are flagged.

pub mod ratchet;
pub mod rules;
pub mod text;

use std::collections::BTreeMap;
use std::path::Path;

/// Sentences of one top-level folder, or of one file in the root.
#[derive(Debug, Default)]
pub struct Folder {
    /// Number of sentences.
    pub sentences: usize,
    /// Flagged sentences, in order of files and lines.
    pub flagged: Vec<Flagged>,
}

/// One flagged sentence.
#[derive(Debug)]
pub struct Flagged {
    /// Path from the workspace's root, `:`, and the line on which the paragraph starts.
    pub place: String,
    /// Reasons, joined by `; `.
    pub reasons: String,
    /// The sentence; code is replaced by `X`.
    pub sentence: String,
}

impl Folder {
    /// Returns the share of flagged sentences in tenths of a percent, rounded up.
    pub fn permille(&self) -> usize {
        (1000 * self.flagged.len()).div_ceil(self.sentences.max(1))
    }
}

/// Checks every Rust, WGSL and Markdown file below `root`, except hidden folders and build outputs.
///
/// # Errors
/// A folder or file cannot be read.
pub fn check(root: &Path) -> Result<BTreeMap<String, Folder>, String> {
    let mut folders: BTreeMap<String, Folder> = BTreeMap::new();
    for path in files(root)? {
        let text = std::fs::read_to_string(root.join(&path)).map_err(|error| format!("{path}: {error}"))?;
        let folder = folders.entry(path.split('/').next().unwrap_or_default().to_owned()).or_default();
        for text::Paragraph { line, text } in text::paragraphs(&text, path.ends_with(".md")) {
            for sentence in text::sentences(&text) {
                folder.sentences += 1;
                let reasons = rules::reasons(&sentence);
                if !reasons.is_empty() {
                    let (place, reasons) = (format!("{path}:{line}"), reasons.join("; "));
                    folder.flagged.push(Flagged { place, reasons, sentence });
                }
            }
        }
    }
    folders.retain(|_, folder| folder.sentences > 0);
    Ok(folders)
}

/// Returns the paths of the checked files from `root`, with `/` between folders, sorted.
fn files(root: &Path) -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    let mut folders = vec![String::new()];
    while let Some(folder) = folders.pop() {
        let unread = |error: std::io::Error| format!("{}: {error}", root.join(&folder).display());
        for entry in std::fs::read_dir(root.join(&folder)).map_err(unread)? {
            let entry = entry.map_err(unread)?;
            let Ok(name) = entry.file_name().into_string() else { continue };
            let path = if folder.is_empty() { name.clone() } else { format!("{folder}/{name}") };
            if name.starts_with('.') || ["target", "node_modules", "shared"].contains(&&*name) {
                continue;
            }
            if entry.file_type().map_err(unread)?.is_dir() {
                folders.push(path);
            } else if [".rs", ".wgsl", ".md"].iter().any(|ending| name.ends_with(ending)) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}
