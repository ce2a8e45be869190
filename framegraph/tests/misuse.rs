//! Misuse that does not compile. Each file under `misuse/` is about one fault, and what the compiler says of it is pinned
//! beside it; `misuse/sound.rs` has all of it right, so that none fails for another reason.
//!
//! The words are those of the oldest compiler that the workspace supports, the one that continuous integration uses; with
//! another the test is skipped, which is reported. `TRYBUILD=overwrite cargo test -p framegraph --test misuse` renews them.

#[path = "misuse/sound.rs"]
mod sound;

use std::process::Command;

/// The compiler of the pinned words: `rust-version` of the workspace.
const PINNED: &str = env!("CARGO_PKG_RUST_VERSION");

#[test]
fn misuse_does_not_compile() {
    let compiler = compiler();
    if !compiler.starts_with(&format!("rustc {PINNED}.")) {
        return test_report::skip(
            "misuse_does_not_compile",
            &format!("the words are those of Rust {PINNED}, and this is {compiler}"),
        );
    }
    let cases = trybuild::TestCases::new();
    let folder = std::fs::read_dir("tests/misuse").expect("tests run in the folder of their package");
    let mut count = 0;
    for entry in folder {
        let path = entry.expect("the folder can be read").path();
        let is_case = path.extension().is_some_and(|e| e == "rs") && !path.ends_with("sound.rs");
        if is_case {
            cases.compile_fail(&path);
            count += 1;
        }
    }
    assert!(count >= 12, "only {count} cases");
}

#[test]
fn the_same_done_right_compiles_and_runs() {
    sound::main();
}

/// What the compiler that tests are built with calls itself.
fn compiler() -> String {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("--version").output();
    output.map_or_else(|error| error.to_string(), |o| String::from_utf8_lossy(&o.stdout).trim().to_owned())
}
