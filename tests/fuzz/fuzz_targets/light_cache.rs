//! Fuzz target: reads arbitrary bytes as an entry of the light cache.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    tests::fuzz::light_cache(bytes);
});
