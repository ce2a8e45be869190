//! Paths of test files: in this repository, or outside for the large ones.

use std::path::{Path, PathBuf};

/// Returns the folder `tests/`.
fn tests() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the folder of Filament's reference pictures of single surfaces and their scenes, the default of the program
/// `reference`. `tests/references/README.md` describes them.
pub fn references() -> PathBuf {
    tests().join("references/filament")
}

/// Returns an environment or model in `tests/assets`, or in `shared/assets` beside the repository. If it is in neither,
/// reports `test` as skipped and returns `None`. `tests/assets/README.md` lists the sources of files that are not
/// committed.
pub fn asset(test: &str, path: &str) -> Option<PathBuf> {
    let places = [tests().join("assets").join(path), tests().join("../../shared/assets").join(path)];
    let found = places.into_iter().find(|file| file.exists());
    if found.is_none() {
        test_report::skip(
            test,
            &format!("tests/assets/{path} is missing; tests/assets/README.md says where to find it"),
        );
    }
    found
}
