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
    /// Beginnings of the files whose faults these tests can notice.
    pub of: &'static [&'static str],
}

const IT: &[&str] = &["--package", "tests", "--test", "it"];
const PASSES: &[&str] = &["--package", "framegraph-passes", "--lib"];
const SHADERS: &[&str] = &["--package", "framegraph-shaders", "--lib"];

/// Cards with known numbers.
const CARDS: &[&str] = &["normals::", "inputs::", "lamps::", "samplers::", "shadows::", "skies::", "lobes::"];
/// Whole pictures, small ones.
const PICTURES: &[&str] = &["picture::", "inline::"];
const ALL: &[&str] = &[""];
/// The passes of ambient occlusion.
const OCCLUSION: &[&str] =
    &["shaders/wgsl/pass/occlusion", "shaders/wgsl/pass/structure", "shaders/wgsl/pass/bilateral"];

/// All rooms.
pub const ROOMS: &[Room] = &[
    Room {
        name: "wgsl",
        language: Language::Wgsl,
        paths: &["shaders/wgsl"],
        without: OCCLUSION,
        sample: 80,
        groups: &[
            Group { binary: IT, filters: &["mirrors::"], of: &["shaders/wgsl/lib"] },
            Group {
                binary: IT,
                filters: &["lens::"],
                of: &["shaders/wgsl/effect", "shaders/wgsl/lib", "shaders/wgsl/pass/sky", "shaders/wgsl/pass/post"],
            },
            Group {
                binary: IT,
                filters: CARDS,
                of: &[
                    "shaders/wgsl/interface",
                    "shaders/wgsl/shading",
                    "shaders/wgsl/lib",
                    "shaders/wgsl/pass/color",
                    "shaders/wgsl/pass/prepass",
                    "shaders/wgsl/pass/shadow",
                ],
            },
            Group {
                binary: IT,
                filters: &["transmission::"],
                of: &[
                    "shaders/wgsl/interface",
                    "shaders/wgsl/lib/refraction",
                    "shaders/wgsl/lib/fullscreen",
                    "shaders/wgsl/pass/color",
                    "shaders/wgsl/pass/scene",
                ],
            },
            Group {
                binary: IT,
                filters: &["light::"],
                of: &["shaders/wgsl/lib", "shaders/wgsl/pass/ibl", "shaders/wgsl/pass/dfg"],
            },
            Group {
                binary: IT,
                filters: &["parts::", "reference::references_pass"],
                of: &["shaders/wgsl/pass/copy", "shaders/wgsl/pass/fxaa", "shaders/wgsl/lib/fxaa"],
            },
            Group {
                binary: IT,
                filters: &["shadow_rays::"],
                of: &["shaders/wgsl/shading/shadow", "shaders/wgsl/lib/shadow", "shaders/wgsl/interface/frame"],
            },
            Group { binary: IT, filters: PICTURES, of: ALL },
        ],
    },
    Room {
        name: "occlusion",
        language: Language::Wgsl,
        paths: &[
            "shaders/wgsl/pass/occlusion.wgsl",
            "shaders/wgsl/pass/structure.wgsl",
            "shaders/wgsl/pass/bilateral.wgsl",
        ],
        without: &[],
        sample: 20,
        groups: &[Group { binary: IT, filters: &["occlusion::"], of: ALL }],
    },
    Room {
        name: "passes",
        language: Language::Rust,
        without: &[],
        paths: &["passes/src/upload", "passes/src/view.rs", "passes/src/sun.rs", "passes/src/draw.rs"],
        sample: 20,
        groups: &[
            Group { binary: PASSES, filters: &[], of: ALL },
            Group { binary: IT, filters: CARDS, of: ALL },
            Group { binary: IT, filters: &["lens::", "transmission::", "light::", "parts::"], of: ALL },
            Group { binary: IT, filters: PICTURES, of: ALL },
        ],
    },
    Room {
        name: "layout",
        language: Language::Rust,
        paths: &["shaders/src/layout"],
        without: &[],
        sample: 20,
        groups: &[
            Group { binary: SHADERS, filters: &["layout::"], of: ALL },
            Group { binary: IT, filters: CARDS, of: ALL },
            Group { binary: IT, filters: &["lens::", "transmission::"], of: ALL },
            Group { binary: IT, filters: PICTURES, of: ALL },
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

    /// Its files' texts by their names from the workspace's root.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn sources(&self) -> Result<BTreeMap<String, String>, Failure> {
        let root = workspace::root();
        let mut found = BTreeMap::new();
        for path in self.files()? {
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

fn unread(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: {error}", path.display()))
}
