//! Files that are mutated, and the tests that judge the mutants.

use crate::mutant::plant::{Mutant, mutants};
use crate::{Failure, workspace};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A set of files with their tests.
#[derive(Debug)]
pub struct Room {
    /// Name on the command line, after `cargo xtask mutants`.
    pub name: &'static str,
    /// Files and folders from the workspace's root, and prefixes of files in them that belong to another room.
    pub paths: &'static [&'static str],
    pub without: &'static [&'static str],
    /// Default number of mutants to try.
    pub sample: usize,
    /// Test programs that judge the mutants.
    pub judges: &'static [Judge],
}

/// Tests of one program.
#[derive(Debug)]
pub struct Judge {
    /// Options of `cargo test` that select the program.
    pub binary: &'static [&'static str],
    /// Prefixes of the names of tests to run, and of those to leave out.
    pub filters: &'static [&'static str],
    pub without: &'static [&'static str],
}

/// Tests across packages, except tests of plans, documents and programs, and tests that take a minute.
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
        "punctual_lights::",
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

/// Passes of ambient occlusion.
const OCCLUSION: &[&str] =
    &["shaders/wgsl/pass/occlusion.wgsl", "shaders/wgsl/pass/structure.wgsl", "shaders/wgsl/pass/bilateral.wgsl"];

/// All rooms.
pub const ROOMS: &[Room] = &[
    Room { name: "wgsl", paths: &["shaders/wgsl"], without: OCCLUSION, sample: 220, judges: &[IT] },
    Room { name: "occlusion", paths: OCCLUSION, without: &[], sample: 40, judges: &[IT] },
];

impl Room {
    /// Returns the room with a name.
    ///
    /// # Errors
    /// [`Failure::Usage`], which lists the valid names.
    pub fn named(name: &str) -> Result<&'static Self, Failure> {
        let names = || ROOMS.iter().map(|room| room.name).collect::<Vec<_>>().join(", ");
        let unknown = || Failure::Usage(format!("unknown set of files `{name}`; known are {}", names()));
        ROOMS.iter().find(|room| room.name == name).ok_or_else(unknown)
    }

    /// Returns the texts of the files by path from the workspace's root.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn sources(&self) -> Result<BTreeMap<String, String>, Failure> {
        let root = workspace::root();
        let mut found = BTreeMap::new();
        let paths: Vec<PathBuf> = self.paths.iter().map(|path| root.join(path)).collect();
        for path in files(&paths)? {
            let file = path.strip_prefix(&root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            if !self.without.iter().any(|start| file.starts_with(start)) {
                found.insert(file, std::fs::read_to_string(&path).map_err(|error| unread(&path, &error))?);
            }
        }
        Ok(found)
    }

    /// Returns every possible mutant, in sampling order.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn mutants(&self) -> Result<Vec<Mutant>, Failure> {
        let sources = self.sources()?;
        let mut found: Vec<Mutant> = sources.iter().flat_map(|(file, text)| mutants(file, text)).collect();
        found.sort_by_key(|m| (m.rank(), m.file.clone(), m.line));
        Ok(found)
    }
}

/// Returns the WGSL files in `open`, a list of files and folders, sorted.
///
/// # Errors
/// A folder cannot be read.
pub fn files(open: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let (mut open, mut files) = (open.to_vec(), Vec::new());
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).map_err(|error| unread(&path, &error))?;
            open.extend(entries.flatten().map(|entry| entry.path()));
        } else if path.extension().is_some_and(|e| e == "wgsl") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn unread(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: {error}", path.display()))
}
