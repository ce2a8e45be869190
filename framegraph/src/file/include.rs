//! Files that a file includes.

use super::error::{FileError, FileErrors};
use super::form::IncludeForm;
use super::spanned::{Source, Spanned};
use super::syntax;
use super::value::ValueFault;
use super::version::without_mark;

/// The most files that one may include, itself left out, and what they include in turn.
const MOST_FILES: usize = 64;

/// The files that a graph file includes, with their texts: each once, those that are included before those that include
/// them.
#[derive(Debug, Default)]
pub struct Included {
    pub(super) files: Vec<(String, String)>,
}

impl Included {
    /// Asks `read` for the text of every file that the file called `path` includes, and that those include. Paths are
    /// relative to the file that names them, and lead to its folder or below.
    ///
    /// # Errors
    /// Text that is no RON, paths that lead elsewhere, more than 64 files, and what `read` says, at the place of the path.
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

    fn add(
        &mut self,
        path: &str,
        text: &str,
        seen: &mut Vec<String>,
        read: &mut dyn FnMut(&str) -> Result<String, String>,
    ) -> Result<(), FileError> {
        // Most files include none, and are not read for that.
        if !text.contains("include") {
            return Ok(());
        }
        let source = Source { path, text: without_mark(text), included: &[] };
        let form: IncludeForm = syntax::options().from_str(source.text).map_err(|error| source.refused(&error))?;
        for name in &form.include {
            let full = beside(path, name).ok_or_else(|| source.value(name, ValueFault::Path(name.value.clone())))?;
            if seen.contains(&full) {
                continue;
            }
            seen.push(full.clone());
            if seen.len() > MOST_FILES + 1 {
                return Err(source.value(name, ValueFault::Entries { max: MOST_FILES as u64 }));
            }
            let text = read(&full).map_err(|message| source.value(name, ValueFault::Unreadable(message)))?;
            self.add(&full, &text, seen, read)?;
            self.files.push((full, text));
        }
        Ok(())
    }
}

/// The path of a file that lies beside or below the file at `path`.
fn beside(path: &str, name: &Spanned<String>) -> Option<String> {
    let name = name.value.as_str();
    let below =
        name.split('/').all(|part| !part.is_empty() && part != ".." && part != "." && !part.contains(['\\', ':']));
    let folder = path.rfind('/').map_or("", |end| &path[..=end]);
    below.then(|| format!("{folder}{name}"))
}
