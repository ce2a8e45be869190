//! What faults are planted in, and which tests judge them.

use crate::mutant::plant::{Language, Mutant, mutants};
use crate::{Failure, workspace};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Some files with the tests that hold them.
#[derive(Debug)]
pub struct Room {
    /// What is typed after `cargo xtask mutants`.
    pub name: &'static str,
    pub language: Language,
    /// Files and folders, from the workspace's root, and beginnings of files in them that are another room's.
    pub paths: &'static [&'static str],
    pub without: &'static [&'static str],
    /// How many faults are tried where not all are asked for.
    pub sample: usize,
    /// The programs of tests that judge its faults.
    pub judges: &'static [Judge],
}

/// Tests of one program.
#[derive(Debug)]
pub struct Judge {
    /// Options of `cargo test` that choose the program.
    pub binary: &'static [&'static str],
    /// Beginnings of names of tests, and of those among them that are left out.
    pub filters: &'static [&'static str],
    pub without: &'static [&'static str],
}

const PASSES: Judge = Judge { binary: &["--package", "framegraph-passes", "--lib"], filters: &[""], without: &[] };
const SHADERS: Judge =
    Judge { binary: &["--package", "framegraph-shaders", "--lib"], filters: &["layout::"], without: &[] };
/// The tests across rooms, but for those of plans, documents and programs, and those that take a minute.
const IT: Judge = Judge {
    binary: &["--package", "tests", "--test", "it"],
    filters: &[
        "bloom::",
        "cubes::",
        "degenerate::",
        "dof::",
        "even_light::",
        "facts::",
        "fog::",
        "furnace::",
        "grading::",
        "half::",
        "hard_cases::",
        "inline::",
        "inputs::",
        "instances::",
        "kept_shadows::",
        "lamps::",
        "lens::",
        "levels::",
        "light::",
        "lights::",
        "lobes::",
        "mirrors::",
        "normals::",
        "occlusion::",
        "optics::",
        "parts::",
        "picture::",
        "prepass::",
        "reference::",
        "reflections::",
        "samplers::",
        "shadow_atlas::",
        "shadow_rays::",
        "shadows::",
        "skies::",
        "taa::",
        "tone_resolve::",
        "transmission::",
        "upscale::",
        "velocity::",
        "views::",
    ],
    without: &[],
};

/// Those of them that tell how scenes are uploaded, placed and drawn: of a fault in Rust nobody knows which tests it reaches, so that all
/// are asked.
const DRAWN: Judge = Judge {
    binary: IT.binary,
    filters: &[
        "degenerate::",
        "inputs::",
        "instances::",
        "kept_shadows::",
        "lamps::",
        "levels::",
        "lights::",
        "parts::",
        "prepass::",
        "samplers::",
        "shadow_atlas::",
        "shadows::",
        "skies::",
        "transmission::",
        "velocity::",
        "views::",
    ],
    without: &[],
};

/// The passes of ambient occlusion.
const OCCLUSION: &[&str] =
    &["shaders/wgsl/pass/occlusion.wgsl", "shaders/wgsl/pass/structure.wgsl", "shaders/wgsl/pass/bilateral.wgsl"];

/// All rooms.
pub const ROOMS: &[Room] = &[
    Room {
        name: "wgsl",
        language: Language::Wgsl,
        paths: &["shaders/wgsl"],
        without: OCCLUSION,
        sample: 220,
        judges: &[IT],
    },
    Room { name: "occlusion", language: Language::Wgsl, paths: OCCLUSION, without: &[], sample: 40, judges: &[IT] },
    Room {
        name: "passes",
        language: Language::Rust,
        without: &[],
        paths: &["passes/src/upload", "passes/src/view.rs", "passes/src/sun.rs", "passes/src/draw.rs"],
        sample: 20,
        judges: &[PASSES, DRAWN],
    },
    Room {
        name: "layout",
        language: Language::Rust,
        paths: &["shaders/src/layout"],
        without: &[],
        sample: 20,
        judges: &[SHADERS, IT],
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

    /// Its files' texts by their names from the workspace's root.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn sources(&self) -> Result<BTreeMap<String, String>, Failure> {
        let root = workspace::root();
        let mut found = BTreeMap::new();
        let paths: Vec<PathBuf> = self.paths.iter().map(|path| root.join(path)).collect();
        for path in files(&paths, self.language)? {
            let file = path.strip_prefix(&root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            if !self.without.iter().any(|start| file.starts_with(start)) {
                found.insert(file, std::fs::read_to_string(&path).map_err(|error| unread(&path, &error))?);
            }
        }
        Ok(found)
    }

    /// Every fault that can be planted in it, in the order in which samples are drawn.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn mutants(&self) -> Result<Vec<Mutant>, Failure> {
        let sources = self.sources()?;
        let mut found: Vec<Mutant> =
            sources.iter().flat_map(|(file, text)| mutants(file, text, self.language)).collect();
        found.sort_by_key(|m| (m.rank(), m.file.clone(), m.line));
        Ok(found)
    }
}

/// The files of a language in `open`, files and folders, but for tests; in alphabetical order.
///
/// # Errors
/// When a folder cannot be read.
pub fn files(open: &[PathBuf], language: Language) -> Result<Vec<PathBuf>, Failure> {
    let (mut open, mut files) = (open.to_vec(), Vec::new());
    let ending = if language == Language::Wgsl { "wgsl" } else { "rs" };
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

fn unread(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: {error}", path.display()))
}
