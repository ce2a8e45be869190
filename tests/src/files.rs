//! The files that tests read: those of this repository, and the few that are too large for it.

use std::path::{Path, PathBuf};

/// The folder `tests/`.
fn tests() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The reference pictures that Filament made of single surfaces, with their scenes: what `reference` compares with
/// unless another folder is named. `tests/references/README.md` says what each is.
pub fn references() -> PathBuf {
    tests().join("references/filament")
}

/// An environment or model of `tests/assets`, or of `shared/assets` beside the repository; `None`, and a line that says
/// that `test` is skipped, where it is in neither. `tests/assets/README.md` says where to find what is not committed.
pub fn asset(test: &str, path: &str) -> Option<PathBuf> {
    let places = [tests().join("assets").join(path), tests().join("../../shared/assets").join(path)];
    let found = places.into_iter().find(|file| file.exists());
    if found.is_none() {
        test_report::skip(
            test,
            &format!("tests/assets/{path} is not here; tests/assets/README.md says where to find it"),
        );
    }
    found
}
