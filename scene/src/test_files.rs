//! The files that the tests of this crate read: those under `tests/` of the repository.

use std::path::{Path, PathBuf};

/// A file under `tests/` of the repository, or, of its `assets/`, in `shared/` beside the repository; `None`, and a line
/// that says so, where it is in neither: `tests/assets/README.md` says where to find what is not committed.
pub fn file(path: &str) -> Option<PathBuf> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let places = [repository.join("tests").join(path), repository.join("../shared").join(path)];
    let found = places.into_iter().find(|file| file.exists());
    if found.is_none() {
        test_report::skip("scene", &format!("tests/{path} is not here; tests/assets/README.md says where to find it"));
    }
    found
}
