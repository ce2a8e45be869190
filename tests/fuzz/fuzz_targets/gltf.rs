//! Fuzz target: reads arbitrary bytes as a glTF or GLB file.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    tests::fuzz::gltf(bytes);
});
