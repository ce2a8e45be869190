//! What faults are planted in, and which tests judge them.

use crate::mutant::plant::{Language, Mutant, mutants};
use crate::{Failure, workspace};
use std::path::{Path, PathBuf};

/// Some files with the tests that hold them.
#[derive(Debug)]
pub struct Room {
    /// What is typed after `cargo xtask mutants`.
    pub name: &'static str,
    pub language: Language,
    /// Files and folders, from the workspace's root.
    pub paths: &'static [&'static str],
    /// How many faults are tried where not all are asked for.
    pub sample: usize,
    /// Options of `cargo test` that name what is built, and the filters of the tests: those of a group run at once, and the
    /// next group only if they pass. What falls soonest stands first.
    pub groups: &'static [Group],
}

/// Tests of one binary.
#[derive(Debug)]
pub struct Group {
    /// Options of `cargo test` that choose the binary.
    pub binary: &'static [&'static str],
    /// Parts of names of tests; none for all.
    pub filters: &'static [&'static str],
}

const IT: &[&str] = &["--package", "tests", "--test", "it"];
const PASSES: &[&str] = &["--package", "framegraph-passes", "--lib"];
const SHADERS: &[&str] = &["--package", "framegraph-shaders", "--lib"];

/// Cards with known numbers.
const CARDS: &[&str] = &["normals::", "inputs::", "lamps::", "samplers::", "shadows::", "skies::", "lobes::"];
/// Single effects and light.
const EFFECTS: &[&str] = &["lens::", "light::", "furnace::", "transmission::"];
/// Whole pictures.
const PICTURES: &[&str] = &["parts::", "picture::", "inline::", "half::", "reference::", "views::"];

/// All rooms.
pub const ROOMS: &[Room] = &[
    Room {
        name: "wgsl",
        language: Language::Wgsl,
        paths: &["shaders/wgsl"],
        sample: 80,
        groups: &[
            Group { binary: IT, filters: &["mirrors::"] },
            Group { binary: IT, filters: CARDS },
            Group { binary: IT, filters: EFFECTS },
            Group { binary: IT, filters: PICTURES },
        ],
    },
    Room {
        name: "passes",
        language: Language::Rust,
        paths: &["passes/src/upload", "passes/src/view.rs", "passes/src/sun.rs", "passes/src/draw.rs"],
        sample: 20,
        groups: &[
            Group { binary: PASSES, filters: &[] },
            Group { binary: IT, filters: CARDS },
            Group { binary: IT, filters: EFFECTS },
            Group { binary: IT, filters: PICTURES },
        ],
    },
    Room {
        name: "layout",
        language: Language::Rust,
        paths: &["shaders/src/layout"],
        sample: 20,
        groups: &[
            Group { binary: SHADERS, filters: &["layout::"] },
            Group { binary: IT, filters: CARDS },
            Group { binary: IT, filters: EFFECTS },
        ],
    },
];

impl Room {
    /// The room of that name.
    ///
    /// # Errors
    /// [`Failure::Usage`] with those that there are.
    pub fn named(name: &str) -> Result<&'static Self, Failure> {
        let names = || ROOMS.iter().map(|room| room.name).collect::<Vec<_>>().join(", ");
        let unknown = || Failure::Usage(format!("there is no room `{name}` to plant faults in; there are {}", names()));
        ROOMS.iter().find(|room| room.name == name).ok_or_else(unknown)
    }

    /// Every fault that can be planted in it, in the order in which samples are drawn.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn mutants(&self) -> Result<Vec<Mutant>, Failure> {
        let root = workspace::root();
        let mut found = Vec::new();
        for path in self.files()? {
            let file = path.strip_prefix(&root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            found.extend(mutants(&file, &read(&path)?, self.language));
        }
        found.sort_by_key(|m| (m.rank(), m.file.clone(), m.line));
        Ok(found)
    }

    fn files(&self) -> Result<Vec<PathBuf>, Failure> {
        let mut open: Vec<PathBuf> = self.paths.iter().map(|path| workspace::root().join(path)).collect();
        let mut files = Vec::new();
        let ending = if self.language == Language::Wgsl { "wgsl" } else { "rs" };
        while let Some(path) = open.pop() {
            if path.is_dir() {
                let entries = std::fs::read_dir(&path).map_err(|error| unread(&path, &error))?;
                open.extend(entries.flatten().map(|entry| entry.path()));
            } else if path.extension().is_some_and(|e| e == ending) && !path.ends_with("tests.rs") {
                files.push(path);
            }
        }
        files.sort();
        Ok(files)
    }
}

/// The text of a file.
///
/// # Errors
/// The file with the reason.
pub fn read(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|error| unread(path, &error))
}

fn unread(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: {error}", path.display()))
}
