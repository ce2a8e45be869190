//! Misuse that does not compile. Each file under `misuse/` contains one error, and the expected compiler output is
//! stored next to it. `misuse/sound.rs` contains the valid versions, so that no file fails for another reason.
//!
//! The expected output is that of the workspace's lowest Rust version, which continuous integration uses. The test is
//! skipped with other versions. `MISUSE=overwrite cargo test -p framegraph --test misuse` renews the files.
//!
//! The files are compiled against the library that this test is linked with, so nothing is built twice.

#[path = "misuse/sound.rs"]
mod sound;

use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns the compiler version of the expected output: `rust-version` of the workspace. The package's own is lower.
fn pinned() -> &'static str {
    let manifest = include_str!("../../Cargo.toml");
    let (_, after) = manifest.split_once("\nrust-version = \"").expect("the workspace states its Rust version");
    after.split('"').next().unwrap_or_default()
}

#[test]
fn misuse_does_not_compile() {
    let (said, pinned) = (output(rustc().arg("--version")), pinned());
    if !said.starts_with(&format!("rustc {pinned}.")) {
        return test_report::skip(
            "misuse_does_not_compile",
            &format!("the expected output is of Rust {pinned}, this is {}", said.trim()),
        );
    }
    let folder = std::fs::read_dir("tests/misuse").expect("tests run in the package folder");
    let mut files: Vec<PathBuf> = folder.map(|entry| entry.expect("a readable folder").path()).collect();
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

/// Compares the compiler output for `file` with the expected output. Returns `None` if they are equal.
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
        Some(format!("{name}: expected\n{pinned}\n{name}: found\n{found}"))
    } else {
        None
    }
}

/// Returns the compiler output for `file`; empty if it compiles.
fn refusal(file: &Path, library: &Path) -> String {
    let mut command = rustc();
    command.args(["--edition=2024", "--crate-type=bin", "--emit=metadata", "--color=never", "--cap-lints=allow"]);
    command.args(["-o", concat!(env!("CARGO_TARGET_TMPDIR"), "/misuse.rmeta")]);
    command.arg("-L").arg(format!("dependency={}", library.with_file_name("").display()));
    command.arg("--extern").arg(format!("framegraph={}", library.display())).arg(file);
    let said = output(&mut command);
    // The last lines only count the errors and refer to explanations.
    let end = said.find("error: aborting due to").unwrap_or(said.len());
    said[..end].trim_end().lines().map(|line| placed(line).to_owned() + "\n").collect()
}

/// Removes the position in a file of the library, which changes often.
fn placed(line: &str) -> &str {
    let within = line.contains(" framegraph/src/").then(|| line.find(".rs:")).flatten();
    within.map_or(line, |at| &line[..at + 3])
}

/// Returns the path of the library that this test is linked with: the newest one in the same folder.
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

/// Returns a command for the compiler that builds tests.
fn rustc() -> Command {
    Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
}

/// Returns the output of a command, both stdout and stderr.
fn output(command: &mut Command) -> String {
    let done = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    String::from_utf8_lossy(&[done.stdout, done.stderr].concat()).into_owned()
}
