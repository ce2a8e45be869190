//! `xtask` from outside.

/// Standard output and standard error that take nothing more: an exit code says so, and nothing panics.
#[cfg(unix)]
#[test]
fn a_full_standard_output_is_an_exit_code() {
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("Linux has it");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_xtask"));
    let status = command.arg("--help").stdout(full()).stderr(full()).status();
    assert_eq!(status.expect("the program starts").code(), Some(2));
}
