//! Documents name only files that exist in the repository.

use std::path::{Path, PathBuf};

/// Returns the repository's files, without build folders.
fn files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    let mut open = vec![root];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of the repository").flatten() {
            let (path, name) = (entry.path(), entry.file_name());
            let name = name.to_string_lossy();
            if path.is_dir() && name != "target" && !name.starts_with('.') {
                open.push(path);
            } else if path.is_file() {
                found.push(path);
            }
        }
    }
    found
}

/// Returns the repository's documents.
fn documents() -> Vec<PathBuf> {
    let mut files = files();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "md"));
    assert!(files.len() > 10, "{files:?}");
    files
}

/// Returns a document's links, without anchors and external sites.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    let files = targets.map(|target| target.split('#').next().unwrap_or_default());
    files.filter(|file| !file.is_empty() && !file.contains("://") && !file.contains(' '))
}

#[test]
fn every_link_leads_to_a_file() {
    for document in documents() {
        let text = std::fs::read_to_string(&document).expect("a document");
        let folder = document.parent().expect("a folder");
        for link in links(&text) {
            assert!(folder.join(link).exists(), "{}: there is no {link}", document.display());
        }
    }
}

/// Top-level folders, the first parts of paths.
const ROOMS: [&str; 10] =
    ["framegraph/", "renderer/", "scene/", "shaders/", "passes/", "tests/", "docs/", "examples/", "viewer/", "xtask/"];

/// Text may name a file without its folder where that is unambiguous.
#[test]
fn every_file_that_is_named_is_there() {
    let files = files();
    for document in documents() {
        let text = std::fs::read_to_string(&document).expect("a document");
        let code = text.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
        for name in code.filter(|code| code.ends_with(".rs") && !code.contains([' ', '*', '<', '{', '…'])) {
            assert!(files.iter().any(|file| file.ends_with(name)), "{}: there is no {name}", document.display());
        }
    }
}

/// Commands and files named in top-level documents and in `docs` must work in this repository alone.
#[test]
fn commands_and_sentences_name_files_of_the_repository() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut looked_at = 0;
    for document in documents() {
        let folder = document.parent().expect("a folder");
        let of_the_whole = folder == root || folder.starts_with(root.join("docs"));
        let text = std::fs::read_to_string(&document).expect("a document");
        for line in text.lines().filter(|_| of_the_whole) {
            let command = line.starts_with("cargo ").then(|| line.split(' ').skip(1));
            assert!(command.is_none() || !line.contains("../"), "{}: {line}", document.display());
            let code = line.split('`').skip(1).step_by(2).filter(|code| !code.contains([' ', '*']));
            for word in command.into_iter().flatten().chain(code) {
                // A model that is too large to be committed; tests/assets/README.md says where to find it.
                let elsewhere = word.starts_with("tests/assets/models/FlightHelmet");
                if ROOMS.iter().any(|room| word.starts_with(room)) && !elsewhere {
                    assert!(root.join(word).exists(), "{}: there is no {word}", document.display());
                    looked_at += 1;
                }
            }
        }
    }
    assert!(looked_at > 50, "only {looked_at} names were looked at");
}
