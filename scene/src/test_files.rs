//! The files that the tests of this crate read: those under `tests/` of the repository.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// A file under `tests/` of the repository, or, of its `assets/`, in `shared/` beside the repository; `None`, and a line
/// that says so, where it is in neither: `tests/assets/README.md` says where to find what is not committed.
pub fn file(path: &str) -> Option<PathBuf> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let places = [repository.join("tests").join(path), repository.join("../shared").join(path)];
    let found = places.into_iter().find(|file| file.exists());
    if found.is_none() {
        skip(&format!("SKIP: scene: tests/{path} is not here; tests/assets/README.md says where to find it\n"));
    }
    found
}

/// Shows a line, and adds it to the file in which `cargo xtask test` counts skipped tests.
fn skip(line: &str) {
    print!("{line}");
    let Some(log) = std::env::var_os("FRAMEGRAPH_SKIP_LOG") else { return };
    // A log that cannot be written loses a line, not the test.
    if let Ok(mut file) = std::fs::OpenOptions::new().create(true).append(true).open(log) {
        let _ = file.write_all(line.as_bytes());
    }
}
