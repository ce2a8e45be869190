//! Compiler wrapper that runs clippy and rustdoc on the workspace's own crates.
//!
//! `cargo clippy` and `cargo doc` would first check every dependency, which the tests compile anyway, and clippy would
//! read each crate a second time. Clippy's driver is a compiler with more lints, so it can build programs too, although
//! with fewer optimizations before LLVM's. Cargo starts the program named in `RUSTC_WORKSPACE_WRAPPER` with the
//! compiler and its arguments. If clippy or rustdoc report a warning, the crate counts as not compiled.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use crate::Failure;

/// Environment variable that selects the documented crates: [`LIBRARIES`], or [`PROGRAMS`] too. If it is set, this
/// program acts as the wrapper.
pub const DOCUMENT: &str = "FRAMEGRAPH_DOCUMENT";
const LIBRARIES: &str = "libraries";
const PROGRAMS: &str = "programs";
/// Argument that marks fuzz targets. They are compiled but not linked, since linking needs a C++ compiler and nightly
/// Rust.
const FUZZER: &str = "feature=\"fuzzer\"";

/// Compiler wrapper for cargo.
pub struct Wrapper {
    program: PathBuf,
    /// Empty library in place of libFuzzer, whose build would need a C++ compiler.
    fuzzer: PathBuf,
}

impl Wrapper {
    /// Copies this program into a folder, since building the workspace may replace it.
    ///
    /// # Errors
    /// The copy cannot be written.
    pub fn new(folder: &Path) -> Result<Self, Failure> {
        let program = folder.join(format!("lints{}", std::env::consts::EXE_SUFFIX));
        let fuzzer = folder.join(if cfg!(target_env = "msvc") { "fuzzer.lib" } else { "libfuzzer.a" });
        // An unchanged file keeps its time stamp, so that crates are not compiled again.
        let written = std::env::current_exe().and_then(|own| {
            renew(&program, &fs::read(&own)?, Some(fs::metadata(&own)?.permissions()))?;
            renew(&fuzzer, b"!<arch>\n", None)
        });
        written.map_err(|error| Failure::Failed(format!("{}: {error}", folder.display())))?;
        Ok(Self { program, fuzzer })
    }

    /// Makes a cargo command lint and document the crates it compiles. Programs are documented only if `programs` is
    /// set: each takes as long as a library.
    pub fn around(&self, cargo: &mut Command, programs: bool) {
        cargo.env("RUSTC_WORKSPACE_WRAPPER", &self.program).env("CUSTOM_LIBFUZZER_PATH", &self.fuzzer);
        cargo.env(DOCUMENT, if programs { PROGRAMS } else { LIBRARIES });
    }
}

/// Writes a file if its contents differ, optionally with permissions.
fn renew(file: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> std::io::Result<()> {
    if fs::read(file).is_ok_and(|there| there == bytes) {
        return Ok(());
    }
    // The existing file may be in use by another build.
    let part = file.with_extension(format!("{}.part", std::process::id()));
    fs::write(&part, bytes)?;
    if let Some(permissions) = permissions {
        fs::set_permissions(&part, permissions)?;
    }
    fs::rename(&part, file)
}

/// Compiles, lints and documents a crate; `arguments` are the compiler's path and arguments.
pub fn wrap(mut arguments: impl Iterator<Item = OsString>, document: &OsStr) -> ExitCode {
    let Some(compiler) = arguments.next().map(PathBuf::from) else { return ExitCode::from(2) };
    let arguments: Vec<OsString> = arguments.collect();
    // Cargo also queries the compiler for its version and targets.
    if !arguments.iter().any(|word| word.to_string_lossy().starts_with("--emit")) {
        return code(Command::new(&compiler).args(&arguments));
    }
    let is = |kind: &str| value(&arguments, "--crate-type").is_some_and(|value| value == kind);
    let tested = arguments.iter().any(|word| word == "--test");
    let mut compiled = arguments.clone();
    if is("bin") && arguments.iter().any(|word| word == FUZZER) {
        // Cargo expects the program to exist.
        if let Err(error) = fs::write(program(&arguments), []) {
            program::note(format_args!("xtask: {}: {error}", program(&arguments).display()));
            return ExitCode::FAILURE;
        }
        compiled = with(&arguments, &["--emit"], &["--emit=dep-info,metadata".into()]);
    }
    compiled.push("-Dwarnings".into());
    let compiled = code(Command::new(compiler.with_file_name("clippy-driver")).args(compiled));
    if compiled != ExitCode::SUCCESS || tested || !(is("lib") || document == PROGRAMS && is("bin")) {
        return compiled;
    }
    let folder = PathBuf::from(value(&arguments, "--out-dir").unwrap_or_default()).join("../doc_lints");
    let document = ["--document-private-items".into(), "-Dwarnings".into(), "--out-dir".into(), folder.into()];
    let left_out = ["--emit", "--out-dir", "-C", "--warn", "--deny", "--allow", "--forbid", "--diagnostic-width"];
    code(Command::new(compiler.with_file_name("rustdoc")).args(quiet(with(&arguments, &left_out, &document))))
}

/// Returns the path of the linked program.
fn program(arguments: &[OsString]) -> PathBuf {
    let folder = PathBuf::from(value(arguments, "--out-dir").unwrap_or_default());
    let own = |word: &OsString| word.to_str().and_then(|word| word.strip_prefix("extra-filename=")).map(str::to_owned);
    let mut name = value(arguments, "--crate-name").unwrap_or_default();
    name.push(arguments.iter().find_map(own).unwrap_or_default());
    name.push(std::env::consts::EXE_SUFFIX);
    folder.join(name)
}

/// Returns the value that follows an option.
fn value(arguments: &[OsString], option: &str) -> Option<OsString> {
    arguments.iter().skip_while(|word| *word != option).nth(1).cloned()
}

/// Removes options with their values, given as `--option value` or `--option=value`, and appends other arguments.
fn with(arguments: &[OsString], left_out: &[&str], more: &[OsString]) -> Vec<OsString> {
    let mut kept = Vec::with_capacity(arguments.len() + more.len());
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        let text = word.to_string_lossy();
        let option = text.split('=').next().unwrap_or_default();
        if left_out.contains(&option) {
            if !text.contains('=') {
                words.next();
            }
        } else {
            kept.push(word.clone());
        }
    }
    kept.extend(more.iter().cloned());
    kept
}

/// Stops rustc from reporting written files, since cargo already knows them.
fn quiet(arguments: Vec<OsString>) -> Vec<OsString> {
    let plain = |word: OsString| match word.to_str().and_then(|text| text.strip_prefix("--json=")) {
        Some(kinds) => {
            let kinds: Vec<&str> = kinds.split(',').filter(|kind| *kind != "artifacts").collect();
            format!("--json={}", kinds.join(",")).into()
        }
        None => word,
    };
    arguments.into_iter().map(plain).collect()
}

/// Runs a command and returns its exit code.
fn code(command: &mut Command) -> ExitCode {
    match command.status() {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(status) => ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)),
        Err(error) => {
            program::note(format_args!("xtask: {}: {error}", command.get_program().display()));
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<OsString> {
        text.split(' ').map(OsString::from).collect()
    }

    const ASKED: &str = "--crate-name one --edition=2024 src/main.rs --json=future-incompat,artifacts --emit=dep-info,link \
                         -C opt-level=1 -C incremental=/t/i -C extra-filename=-1f --out-dir /t/deps --warn=missing_docs";

    #[test]
    fn options_are_left_out_with_their_values() {
        let linked = "--crate-name one --edition=2024 src/main.rs --json=future-incompat -C opt-level=1 -C \
                      incremental=/t/i -C extra-filename=-1f --out-dir /t/deps --warn=missing_docs --emit=metadata";
        assert_eq!(quiet(with(&words(ASKED), &["--emit"], &["--emit=metadata".into()])), words(linked));
        let documented = "--crate-name one --edition=2024 src/main.rs --json=future-incompat,artifacts";
        assert_eq!(with(&words(ASKED), &["--emit", "--out-dir", "-C", "--warn"], &[]), words(documented));
    }

    #[test]
    fn a_program_lies_where_cargo_looks_for_it() {
        let name = format!("/t/deps/one-1f{}", std::env::consts::EXE_SUFFIX);
        assert_eq!(program(&words(ASKED)), PathBuf::from(name));
    }
}
