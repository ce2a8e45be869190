//! Damaged compressed files: each loads as a valid scene or returns a one-line error.

use std::path::Path;

use super::{bytes, fixture};
use crate::import::load_bytes_with;
use crate::progress::silent;
use crate::{LoadOptions, Memory};

/// Loads a damaged file with a budget of 16 MiB.
fn survive(glb: &[u8], what: &str) -> bool {
    let options = LoadOptions { memory: Memory::new(16 << 20).into(), ..LoadOptions::default() };
    match load_bytes_with(Path::new("damaged.glb"), glb, &options, &mut silent) {
        Ok(scene) => {
            assert_eq!(scene.check(), Ok(()), "{what}");
            true
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.starts_with("damaged.glb: ") && !text.contains('\n'), "{what}: {text}");
            assert!(!text.contains("the decoder failed"), "{what}: {text}");
            false
        }
    }
}

const FILES: [&str; 10] = [
    "draco_edgebreaker_0",
    "draco_edgebreaker_5",
    "draco_coarse",
    "draco_sequential",
    "draco_bitstream_2_1",
    "strip_draco",
    "meshopt_v0",
    "meshopt_v1",
    "meshopt_filters_wide",
    "strip_meshopt",
];

/// Flips one bit in each part of the data. For the small files of the fuzzing corpus every byte is changed
/// (`tests/it/replay.rs` adds heavier damage).
#[test]
fn flipped_bits_never_panic() {
    let (mut sound, mut broken) = (0, 0);
    for name in FILES {
        let glb = bytes(name);
        let start = glb.len() - fixture(name).bin.len();
        let step = (glb.len() - start) / 16 + 1;
        for place in (start..glb.len()).step_by(step) {
            let mut damaged = glb.clone();
            damaged[place] ^= 1 << (place % 8);
            match survive(&damaged, &format!("{name}: byte {place}")) {
                true => sound += 1,
                false => broken += 1,
            }
        }
    }
    assert!(sound > 20 && broken > 20, "{sound} sound, {broken} broken");
}

/// Truncates the compressed data at many lengths.
#[test]
fn truncated_data_is_an_error() {
    for name in FILES {
        let whole = fixture(name);
        let views = whole.json["bufferViews"].as_array().expect("views").len();
        let compressed = |view: usize| {
            let extensions = format!("/bufferViews/{view}/extensions");
            let names = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
            let found = names.into_iter().find(|name| whole.json.pointer(&format!("{extensions}/{name}")).is_some());
            found.map(|name| format!("{extensions}/{name}/byteLength"))
        };
        let draco = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView";
        let draco = whole.json.pointer(draco).map(|view| format!("/bufferViews/{view}/byteLength"));
        let lengths: Vec<String> = (0..views).filter_map(compressed).chain(draco).collect();
        assert!(!lengths.is_empty(), "{name}");
        for pointer in lengths {
            let length = whole.json.pointer(&pointer).and_then(|length| length.as_u64()).expect("a length");
            for cut in (0..length).step_by(length as usize / 12 + 1).chain([length - 1]) {
                let mut damaged = whole.clone();
                damaged.set(&pointer, cut.into());
                let is_sound = survive(&damaged.glb(), &format!("{name}: {pointer} = {cut}"));
                assert!(!is_sound, "{name}: {pointer} = {cut} of {length}");
            }
        }
    }
}
