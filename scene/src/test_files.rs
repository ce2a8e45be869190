//! Test files of this crate: those under `tests/` of the repository.

use std::path::{Path, PathBuf};

/// Returns a file under `tests/` of the repository; for `assets/`, also in `shared/` beside the repository. If it is
/// missing, returns `None` and prints a line. `tests/assets/README.md` describes how to get files that are not
/// committed.
pub fn file(path: &str) -> Option<PathBuf> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let places = [repository.join("tests").join(path), repository.join("../shared").join(path)];
    let found = places.into_iter().find(|file| file.exists());
    if found.is_none() {
        test_report::skip("scene", &format!("tests/{path} is not here; tests/assets/README.md says where to find it"));
    }
    found
}
