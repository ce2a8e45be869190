//! Included files.

use super::error::{FileError, FileErrors};
use super::form::IncludeForm;
use super::spanned::{Source, Spanned};
use super::syntax;
use super::value::ValueReason;
use super::version::without_mark;

/// Maximum number of files that a file includes, directly or indirectly.
const MAX_FILES: usize = 64;

/// The files that a graph file includes, with their texts. Each file occurs once, after the files that it includes.
#[derive(Debug, Default)]
pub struct Included {
    pub(super) files: Vec<(String, String)>,
}

impl Included {
    /// Loads every file that the file at `path` includes, directly or indirectly, with the callback `read`.
    ///
    /// Paths are relative to the including file and must stay in its folder or below.
    ///
    /// # Errors
    /// Returns an error with its position if a text is not valid RON, a path leads out of the folder, more than 64
    /// files are included, or `read` fails.
    pub fn load(
        path: &str,
        text: &str,
        mut read: impl FnMut(&str) -> Result<String, String>,
    ) -> Result<Self, FileErrors> {
        let mut out = Self::default();
        let mut seen = vec![path.to_owned()];
        out.add(path, text, &mut seen, &mut read)?;
        Ok(out)
    }

    /// Paths of the files, as passed to `read`.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|(path, _)| path.as_str())
    }

    fn add(
        &mut self,
        path: &str,
        text: &str,
        seen: &mut Vec<String>,
        read: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Result<(), FileError> {
        // Fast path for files without includes.
        if !text.contains("include") {
            return Ok(());
        }
        let source = Source { path, text: without_mark(text), included: &[] };
        let form: IncludeForm = syntax::options().from_str(source.text).map_err(|error| source.refused(&error))?;
        for name in &form.include {
            let full = beside(path, name).ok_or_else(|| source.value(name, ValueReason::Path(name.value.clone())))?;
            if seen.contains(&full) {
                continue;
            }
            seen.push(full.clone());
            if seen.len() > MAX_FILES + 1 {
                return Err(source.value(name, ValueReason::Entries { max: MAX_FILES as u64 }));
            }
            let text = read(&full).map_err(|message| source.value(name, ValueReason::Unreadable(message)))?;
            self.add(&full, &text, seen, read)?;
            self.files.push((full, text));
        }
        Ok(())
    }
}

/// Returns the path of a file in the folder of `path` or below.
fn beside(path: &str, name: &Spanned<String>) -> Option<String> {
    let name = name.value.as_str();
    let below =
        name.split('/').all(|part| !part.is_empty() && part != ".." && part != "." && !part.contains(['\\', ':']));
    let folder = path.rfind('/').map_or("", |end| &path[..=end]);
    below.then(|| format!("{folder}{name}"))
}
