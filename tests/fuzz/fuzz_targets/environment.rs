//! Fuzz target: reads arbitrary bytes as a Radiance or OpenEXR picture.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    tests::fuzz::environment(bytes);
});
