//! Lookup of files whose names differ from a URI only in letter case, as written on case-insensitive systems.

use std::fs::read_dir;
use std::path::{Component, Path, PathBuf};

use super::uri::is_inside;

/// Maximum number of names searched in a folder.
const MAX_NAMES: usize = 1 << 16;

/// Returns the path of a file in the scene's `folder` that equals `path`, which does not exist, if letter case is
/// ignored. `None` for paths outside of the folder.
pub(super) fn candidate(folder: &Path, path: &Path) -> Option<PathBuf> {
    let mut found = PathBuf::new();
    for part in path.strip_prefix(folder).ok()?.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                if !found.pop() {
                    return None;
                }
            }
            Component::Normal(name) => {
                let below = folder.join(&found);
                let exact = below.join(name).exists().then(|| name.to_owned());
                found.push(exact.or_else(|| name_like(&below, name.to_str()?))?);
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    let file = folder.join(&found);
    (file.is_file() && is_inside(folder, &file)).then_some(found)
}

/// Returns the alphabetically first name in a folder that equals the lower-case `name` if letter case is ignored.
fn name_like(folder: &Path, name: &str) -> Option<std::ffi::OsString> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let lower = name.to_lowercase();
    let names = read_dir(here).ok()?.take(MAX_NAMES).filter_map(|entry| Some(entry.ok()?.file_name()));
    names.filter(|own| own.to_str().is_some_and(|own| own.to_lowercase() == lower)).min()
}
