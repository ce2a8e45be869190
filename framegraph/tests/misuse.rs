//! Misuse that does not compile. Each file under `misuse/` is about one fault, and what the compiler says of it is pinned
//! beside it; `misuse/sound.rs` has all of it right, so that none fails for another reason.
//!
//! The words are those of the oldest compiler that the workspace supports, the one that continuous integration uses; with
//! another the test is skipped, which is reported. `MISUSE=overwrite cargo test -p framegraph --test misuse` renews them.
//!
//! The compiler is given the library that this test is linked with, so nothing is built a second time.

#[path = "misuse/sound.rs"]
mod sound;

use std::path::{Path, PathBuf};
use std::process::Command;

/// The compiler of the pinned words: `rust-version` of the workspace.
const PINNED: &str = env!("CARGO_PKG_RUST_VERSION");

#[test]
fn misuse_does_not_compile() {
    let said = output(rustc().arg("--version"));
    if !said.starts_with(&format!("rustc {PINNED}.")) {
        return test_report::skip(
            "misuse_does_not_compile",
            &format!("the words are those of Rust {PINNED}, and this is {}", said.trim()),
        );
    }
    let folder = std::fs::read_dir("tests/misuse").expect("tests run in the folder of their package");
    let mut files: Vec<PathBuf> = folder.map(|entry| entry.expect("the folder can be read").path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "rs") && !path.ends_with("sound.rs"));
    files.sort();
    assert!(files.len() >= 12, "only {files:?}");
    let library = library();
    let overwrite = std::env::var_os("MISUSE").is_some_and(|word| word == "overwrite");
    let wrong: Vec<String> = files.iter().filter_map(|file| differs(file, &library, overwrite)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_same_done_right_compiles_and_runs() {
    sound::main();
}

/// What is wrong with what the compiler says of `file`; None where it is what stands beside it.
fn differs(file: &Path, library: &Path, overwrite: bool) -> Option<String> {
    let (found, beside) = (refusal(file, library), file.with_extension("stderr"));
    if overwrite && !found.is_empty() {
        std::fs::write(&beside, &found).unwrap_or_else(|error| panic!("{}: {error}", beside.display()));
    }
    let pinned = std::fs::read_to_string(&beside).unwrap_or_default();
    let name = file.display();
    if found.is_empty() {
        Some(format!("{name}: it compiles"))
    } else if found != pinned {
        Some(format!("{name}: pinned\n{pinned}\n{name}: found\n{found}"))
    } else {
        None
    }
}

/// What the compiler says of `file`; empty if it has nothing against it.
fn refusal(file: &Path, library: &Path) -> String {
    let mut command = rustc();
    command.args(["--edition=2024", "--crate-type=bin", "--emit=metadata", "--color=never", "--cap-lints=allow"]);
    command.args(["-o", concat!(env!("CARGO_TARGET_TMPDIR"), "/misuse.rmeta")]);
    command.arg("-L").arg(format!("dependency={}", library.with_file_name("").display()));
    command.arg("--extern").arg(format!("framegraph={}", library.display())).arg(file);
    let said = output(&mut command);
    // The last lines count the errors and say where they are explained.
    let end = said.find("error: aborting due to").unwrap_or(said.len());
    said[..end].trim_end().lines().map(|line| placed(line).to_owned() + "\n").collect()
}

/// A line without the place in a file of the library, which changes for other reasons.
fn placed(line: &str) -> &str {
    let within = line.contains(" framegraph/src/").then(|| line.find(".rs:")).flatten();
    within.map_or(line, |at| &line[..at + 3])
}

/// The library that this test is linked with: the newest beside it, since cargo has just made sure of it.
fn library() -> PathBuf {
    let this = std::env::current_exe().expect("a running program has a path");
    let folder = std::fs::read_dir(this.parent().expect("it is in a folder")).expect("the folder can be read");
    let libraries = folder.map(|entry| entry.expect("the folder can be read")).filter(|entry| {
        let name = entry.file_name();
        name.to_string_lossy().starts_with("libframegraph-") && name.to_string_lossy().ends_with(".rlib")
    });
    let newest = libraries.max_by_key(|entry| entry.metadata().and_then(|data| data.modified()).ok());
    newest.expect("the library is beside the test").path()
}

/// The compiler that tests are built with.
fn rustc() -> Command {
    Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
}

/// What a command prints, on both of its outputs.
fn output(command: &mut Command) -> String {
    let done = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    String::from_utf8_lossy(&[done.stdout, done.stderr].concat()).into_owned()
}
