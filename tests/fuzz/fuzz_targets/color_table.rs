//! Fuzz target: reads arbitrary bytes as a `.cube` file.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    tests::fuzz::color_table(bytes);
});
