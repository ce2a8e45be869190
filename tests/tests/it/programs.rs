//! Programs of this package as processes: output streams and exit codes.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

/// With a full standard output and standard error, programs exit with an error code and do not panic. The list of
/// programs comes from cargo, so new ones are included.
#[test]
fn a_full_standard_output_is_an_exit_code() {
    let folder = Path::new(env!("CARGO_BIN_EXE_prove")).parent().expect("a program lies in a folder");
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("Linux has it");
    let programs = programs();
    for expected in ["measure", "plan", "prove", "render", "viewer", "xtask"] {
        assert!(programs.iter().any(|name| name == expected), "{expected} is not among {programs:?}");
    }
    for name in programs {
        let program = folder.join(&name);
        if !program.exists() {
            // Programs of other packages are built by tests of the whole workspace.
            test_report::skip("a_full_standard_output_is_an_exit_code", &format!("{name} is not built"));
            continue;
        }
        let status = Command::new(program).arg("--help").stdout(full()).stderr(full()).status();
        let code = status.expect("the program starts").code();
        // Code 2: help was requested and could not be written. Code 1: there is no help, which could not be reported.
        assert!(matches!(code, Some(1 | 2)), "{name}: {code:?}");
    }
}

/// Returns the programs of the workspace that need no optional features.
fn programs() -> Vec<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(env!("CARGO_MANIFEST_DIR")).args(["metadata", "--no-deps", "--offline", "--format-version=1"]);
    let metadata = cargo.output().expect("cargo runs the tests").stdout;
    let metadata: serde_json::Value = serde_json::from_slice(&metadata).expect("cargo writes JSON");
    let mut names = Vec::new();
    for package in metadata["packages"].as_array().expect("there are packages") {
        let by_default = package["features"]["default"].as_array().into_iter().flatten().collect::<Vec<_>>();
        for target in package["targets"].as_array().expect("there are targets") {
            let asks = target["required-features"].as_array().into_iter().flatten();
            if target["kind"][0] == "bin" && asks.clone().all(|feature| by_default.contains(&feature)) {
                names.push(target["name"].as_str().expect("a target has a name").to_owned());
            }
        }
    }
    names
}

/// Every package uses the workspace's lints with `print_stdout`; fuzz targets, which print nothing, have their own.
#[test]
fn no_package_prints_with_a_macro_that_can_panic() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace");
    let text = |path: &Path| std::fs::read_to_string(path).expect("a manifest can be read");
    let workspace = text(&root.join("Cargo.toml"));
    assert!(workspace.contains("\nprint_stderr = \"warn\"\nprint_stdout = \"warn\"\n"));
    let members = workspace.lines().find_map(|line| line.strip_prefix("members = [")).expect("there are members");
    for member in members.split('"').skip(1).step_by(2) {
        let manifest = text(&root.join(member).join("Cargo.toml"));
        let linted = manifest.contains("\n[lints]\nworkspace = true\n");
        assert!(linted || member.ends_with("/fuzz"), "{member}");
    }
}

#[test]
fn files_that_are_read_are_not_written_over() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("programs");
    std::fs::create_dir_all(&folder).expect("the target folder can be written");
    let statement = folder.join("a.json");
    std::fs::write(&statement, "{}").expect("the folder is ours");
    let run = |args: &[&std::ffi::OsStr]| {
        let output = Command::new(env!("CARGO_BIN_EXE_reference")).arg(&folder).args(args).output();
        let output = output.expect("the program starts");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, told) = run(&["--json".as_ref(), statement.as_os_str()]);
    assert!(code == Some(2) && told.contains("a.json: it is an input of this run"), "{told}");
    let (code, told) = run(&["--out".as_ref(), folder.as_os_str()]);
    assert!(code == Some(2) && told.contains("the folder contains the references"), "{told}");
    assert_eq!(std::fs::read_to_string(&statement).ok().as_deref(), Some("{}"));
    let gone = folder.join("gone/proofs.md");
    let output = Command::new(env!("CARGO_BIN_EXE_prove")).args(["--quick", "--out"]).arg(gone).output();
    let output = output.expect("the program starts");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && told.contains("does not exist"), "{told}");
}
