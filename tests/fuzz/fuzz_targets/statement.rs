//! Fuzz target: reads arbitrary bytes as the statement of a reference picture.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    tests::fuzz::statement(bytes);
});
