//! The files that a run renders.

use std::io;
use std::path::{Path, PathBuf};

/// Deepest folder that is looked into.
const MAX_DEPTH: usize = 64;

/// Returns the `.gltf` and `.glb` files below a folder, relative to it and sorted. Links to folders are not followed.
///
/// # Errors
/// When a folder cannot be read; the path is in the message.
pub fn below(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    look(folder, Path::new(""), 0, &mut found)?;
    found.sort();
    Ok(found)
}

fn look(root: &Path, relative: &Path, depth: usize, found: &mut Vec<PathBuf>) -> Result<(), String> {
    let folder = root.join(relative);
    let failed = |error: io::Error| format!("{}: {error}", folder.display());
    for entry in std::fs::read_dir(&folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let path = relative.join(entry.file_name());
        if entry.file_type().map_err(failed)?.is_dir() {
            if depth < MAX_DEPTH {
                look(root, &path, depth + 1, found)?;
            }
        } else if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gltf") || e.eq_ignore_ascii_case("glb")) {
            found.push(path);
        }
    }
    Ok(())
}
