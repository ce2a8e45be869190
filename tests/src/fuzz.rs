//! What is read from files, given any bytes: a value that keeps its promises, or an error of one line; never a panic, and never
//! more than a little memory.
//!
//! The fuzz targets under `tests/fuzz` are these functions. `tests/corpus` has small files for each, which a test replays with
//! damage done to them ([`Damage`]).

use crate::reference::document::Document;
use crate::reference::rule;
use framegraph_passes::ibl::cache;
use framegraph_scene::environment::MAX_RADIANCE;
use framegraph_scene::{ColorTable, Environment, LoadOptions, Memory, import, progress};
use glam::DVec3;
use std::path::Path;

/// A reader, by the name of its target and its folder in the corpus.
pub type Target = (&'static str, fn(&[u8]) -> bool);

/// Every reader of files from elsewhere. Each returns whether it found the bytes sound.
pub const TARGETS: [Target; 5] = [
    ("gltf", gltf),
    ("environment", environment),
    ("light_cache", light_cache),
    ("statement", statement),
    ("color_table", color_table),
];

/// What a file of the corpus may take once it is read.
const MEMORY_BYTES: u64 = 16 << 20;

/// Few bytes may claim to be much.
fn options() -> LoadOptions {
    LoadOptions { memory: Memory::new(MEMORY_BYTES).into(), ..LoadOptions::default() }
}

/// A glTF or GLB file. Files beside it are not there.
pub fn gltf(bytes: &[u8]) -> bool {
    let path = Path::new("no such folder/fuzz.glb");
    match import::load_bytes_with(path, bytes, &options(), &mut progress::silent) {
        Ok(scene) => {
            assert_eq!(scene.check(), Ok(()));
            true
        }
        Err(error) => one_line(&error.to_string(), "fuzz.glb"),
    }
}

/// A Radiance or OpenEXR picture, or a cube in a Khronos texture.
pub fn environment(bytes: &[u8]) -> bool {
    match Environment::load_bytes(Path::new("fuzz.hdr"), bytes, &options(), &mut progress::silent) {
        Ok(environment) => {
            let filtered = environment.filtered.iter().flat_map(|filtered| &filtered.levels).flatten().flatten();
            let radiance = environment.map.texels().iter().flatten().chain(filtered);
            assert!(radiance.copied().all(|channel| (0.0..=MAX_RADIANCE).contains(&channel)));
            true
        }
        Err(error) => {
            let error = error.to_string();
            // Panics of other crates' decoders are caught; that of Radiance files is our own and must not need it.
            assert!(!(bytes.starts_with(b"#?") && error.contains("the decoder failed")), "{error}");
            one_line(&error, "fuzz.hdr")
        }
    }
}

/// An entry of the cache of computed light.
pub fn light_cache(bytes: &[u8]) -> bool {
    cache::examine(bytes)
}

/// A statement of a reference picture, in JSON.
pub fn statement(bytes: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(bytes) else { return false };
    match Document::parse(Path::new("fuzz.json"), text) {
        Ok(document) => {
            // What is understood of its rule does not matter; that it is read without a panic does.
            drop(document.suggested_pass.as_deref().map(rule::parse));
            true
        }
        Err(error) => one_line(&error.to_string(), "fuzz.json"),
    }
}

/// A `.cube` file.
pub fn color_table(bytes: &[u8]) -> bool {
    match ColorTable::load_bytes(Path::new("fuzz.cube"), bytes) {
        Ok(table) => {
            let corners = [DVec3::ZERO, DVec3::ONE, DVec3::new(-1.0, 0.3, 1e9)];
            assert!(corners.into_iter().all(|color| table.sample(color).is_finite()));
            true
        }
        Err(error) => one_line(&error.to_string(), "fuzz.cube"),
    }
}

/// An error names the file, on one line.
fn one_line(error: &str, file: &str) -> bool {
    assert!(error.contains(file) && !error.contains('\n'), "{error}");
    false
}

/// A fixed sequence of damage, so that a failure can be repeated (Knuth's MMIX generator).
#[derive(Clone, Copy, Debug)]
pub struct Damage(pub u64);

impl Damage {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }

    /// A copy of a file with up to four faults: bytes set or flipped, digits exchanged, a piece cut out, doubled, or taken
    /// from another file, the end cut off.
    pub fn done_to(&mut self, file: &[u8], other: &[u8]) -> Vec<u8> {
        let mut bytes = file.to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len());
            let to = (at + 1 + self.below(16)).min(bytes.len());
            match self.below(9) {
                _ if bytes.is_empty() => {}
                0 => bytes[at] ^= 1 << self.below(8),
                1 => bytes[at] = [0, 0xff, 0x7f, b'"', b'-'][self.below(5)],
                2 => bytes[at] = self.below(256) as u8,
                3 | 4 => {
                    // In texts numbers go wrong while the structure stays.
                    let digits: Vec<usize> = (0..bytes.len()).filter(|at| bytes[*at].is_ascii_digit()).collect();
                    if let Some(at) = digits.get(self.below(digits.len())) {
                        bytes[*at] = b'0' + self.below(10) as u8;
                    }
                }
                5 => drop(bytes.drain(at..to)),
                6 => {
                    let piece = bytes[at..to].to_vec();
                    bytes.splice(at..at, piece);
                }
                7 => {
                    let from = self.below(other.len());
                    let piece = other[from..(from + 16).min(other.len())].to_vec();
                    bytes.splice(at..to, piece);
                }
                _ => bytes.truncate(at),
            }
        }
        bytes
    }
}
