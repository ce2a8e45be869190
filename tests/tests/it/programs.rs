//! The programs of this package from outside: where their words and files go.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

/// Standard output and standard error that take nothing more: an exit code says so, and nothing panics.
#[test]
fn a_full_standard_output_is_an_exit_code() {
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("Linux has it");
    for (program, args) in [
        (env!("CARGO_BIN_EXE_prove"), &["--help"][..]),
        (env!("CARGO_BIN_EXE_reference"), &["--help"]),
        (env!("CARGO_BIN_EXE_ibl_errors"), &["no such section"]),
    ] {
        let status = Command::new(program).args(args).stdout(full()).stderr(full()).status();
        let expected = if args == ["--help"] { 2 } else { 1 };
        assert_eq!(status.expect("the program starts").code(), Some(expected), "{program}");
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
    assert!(code == Some(2) && told.contains("a.json: it is read"), "{told}");
    let (code, told) = run(&["--out".as_ref(), folder.as_os_str()]);
    assert!(code == Some(2) && told.contains("files of this folder are read"), "{told}");
    assert_eq!(std::fs::read_to_string(&statement).ok().as_deref(), Some("{}"));
    let gone = folder.join("gone/proofs.md");
    let output = Command::new(env!("CARGO_BIN_EXE_prove")).args(["--quick", "--out"]).arg(gone).output();
    let output = output.expect("the program starts");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && told.contains("there is no folder"), "{told}");
}
