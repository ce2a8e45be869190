//! Readers of files, called with arbitrary bytes. Each must return a valid value or a one-line error, without a panic
//! and within a memory limit.
//!
//! The fuzz targets in `tests/fuzz` call these functions. `tests/corpus` has small files for each; a test replays them
//! with damage ([`Damage`]).

use crate::reference::document::Document;
use crate::reference::rule;
use framegraph_passes::light::ibl::cache;
use framegraph_scene::environment::MAX_RADIANCE;
use framegraph_scene::{ColorTable, Environment, LoadOptions, Memory, import, progress};
use glam::DVec3;
use std::path::Path;

/// Name of a target and its corpus folder, and the reader.
pub type Target = (&'static str, fn(&[u8]) -> bool);

/// Every reader of external files. Each returns true if the bytes were valid.
pub const TARGETS: [Target; 5] = [
    ("gltf", gltf),
    ("environment", environment),
    ("light_cache", light_cache),
    ("statement", statement),
    ("color_table", color_table),
];

/// Memory limit for reading a file of the corpus, in bytes.
const MEMORY_BYTES: u64 = 16 << 20;

/// Returns options with a low memory limit, since a small file can claim a large size.
fn options() -> LoadOptions {
    LoadOptions { memory: Memory::new(MEMORY_BYTES).into(), ..LoadOptions::default() }
}

/// Reads a glTF or GLB file; external files are missing.
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

/// Reads a Radiance or OpenEXR picture, or a Khronos cube texture.
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
            // Panics of third-party decoders are caught. Our own decoder of Radiance files must not panic.
            assert!(!(bytes.starts_with(b"#?") && error.contains("the decoder failed")), "{error}");
            one_line(&error, "fuzz.hdr")
        }
    }
}

/// Reads an entry of the light cache.
pub fn light_cache(bytes: &[u8]) -> bool {
    cache::examine(bytes)
}

/// Reads a statement of a reference picture, in JSON.
pub fn statement(bytes: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(bytes) else { return false };
    match Document::parse(Path::new("fuzz.json"), text) {
        Ok(document) => {
            // The parsed rule is irrelevant, as long as parsing does not panic.
            drop(document.suggested_pass.as_deref().map(rule::parse));
            true
        }
        Err(error) => one_line(&error.to_string(), "fuzz.json"),
    }
}

/// Reads a `.cube` file.
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

/// Returns true if an error names the file in a single line.
fn one_line(error: &str, file: &str) -> bool {
    assert!(error.contains(file) && !error.contains('\n'), "{error}");
    false
}

/// A deterministic sequence of damage, for reproducible failures (Knuth's MMIX generator).
#[derive(Clone, Copy, Debug)]
pub struct Damage(pub u64);

impl Damage {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }

    /// Returns a copy of a file with up to four faults. A fault sets or flips bytes, replaces digits, cuts or duplicates a piece, copies a piece from another file, or cuts the end off.
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
                    // In text files, changing digits breaks numbers and keeps the structure.
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
