//! One torus and one strip under every geometry compression (`tests/assets/compressed`). Decoded data is compared with
//! the uncompressed files, within the error of the encoder's settings. Damaged files return errors.

mod damage;
mod errors;
mod strip;
mod torus;

use std::path::Path;

use super::fixture::Fixture;
use crate::import::load_bytes_with;
use crate::progress::silent;
use crate::test_files::file;
use crate::{LoadOptions, Scene};

/// Returns the bytes of a file in `tests/assets/compressed`.
fn bytes(name: &str) -> Vec<u8> {
    let path = file(&format!("assets/compressed/{name}.glb")).expect("it is committed");
    std::fs::read(path).expect("it can be read")
}

/// Returns a file in `tests/assets/compressed`, to be modified.
fn fixture(name: &str) -> Fixture {
    Fixture::of_glb(&bytes(name))
}

/// Loads a file without reordering vertices or triangles.
fn ordered(glb: &[u8], name: &str) -> Scene {
    let options = LoadOptions { keep_order: true, ..LoadOptions::default() };
    let loaded = load_bytes_with(Path::new("torus.glb"), glb, &options, &mut silent);
    let scene = loaded.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(scene.check(), Ok(()), "{name}");
    assert!(scene.warnings.is_empty(), "{name}: {:?}", scene.warnings);
    scene
}
