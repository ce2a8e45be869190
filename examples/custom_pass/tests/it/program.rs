//! The program from outside: files, exit codes, and a window where there is a display.

use super::{TestResult, skip};
use framegraph_scene::picture::read_rgba8;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use test_report::display::Display;

fn folder(test: &str) -> std::io::Result<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("custom_pass").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

fn program(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_custom_pass"));
    // Mesa's device selection layer complains about a missing session on standard error; that is not the program's word.
    command.env("NODEVICE_SELECT", "1").env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command.current_dir(folder).args(args);
    command
}

fn run(folder: &Path, args: &[&str]) -> std::io::Result<(Option<i32>, String, String)> {
    let Output { status, stdout, stderr } = program(folder, args).output()?;
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Ok((status.code(), text(stdout), text(stderr)))
}

#[test]
fn a_picture_is_drawn_without_a_window() -> TestResult {
    let folder = folder("picture")?;
    let (code, out, told) = run(&folder, &["--out", "a.png", "--size", "161x91", "--frames", "2", "--plan"])?;
    if told.contains("no adapter") {
        return skip("a_picture_is_drawn_without_a_window", told.trim());
    }
    assert_eq!(code, Some(0), "{told}");
    assert!(out.contains("pass outline (merged: attachments)"), "{out}");
    let ([width, height], rgba) = read_rgba8(&folder.join("a.png"))?;
    assert_eq!([width, height], [161, 91]);
    let white = |rgba: &[u8]| rgba.chunks_exact(4).filter(|t| *t == [255; 4]).count();
    let black = rgba.chunks_exact(4).filter(|t| t[..3] == [0; 3]).count();
    assert!(black == 0 && white(&rgba) > 300, "{black} black texels, {} of lines", white(&rgba));

    let (code, out, _) = run(&folder, &["--out", "b.png", "--size", "161x91", "--no-outline", "--no-blur"])?;
    assert!(code == Some(0) && !out.contains("steps:"), "{out}");
    let (_, plain) = read_rgba8(&folder.join("b.png"))?;
    assert!(white(&plain) < 100, "the lamp alone is white: {}", white(&plain));
    assert_eq!(fs::read_dir(&folder)?.count(), 2, "no part is left behind");
    Ok(())
}

#[test]
fn bad_input_is_one_line_and_exit_code_2() -> TestResult {
    let folder = folder("bad")?;
    let cases: [(&[&str], &str); 7] = [
        (&["--size", "0x0"], "--size 0x0"),
        (&["--frames", "-1", "--out", "a.png"], "--frames -1"),
        (&["--out", "a.jpg"], "--out a.jpg"),
        (&["--blur"], "--blur"),
        (&["scene.glb"], "scene.glb"),
        (&["--out", "nowhere/a.png"], "nowhere"),
        // Neither a file nor a display.
        (&[], "--out FILE.png"),
    ];
    for (args, named) in cases {
        let (code, out, told) = run(&folder, args)?;
        assert_eq!((code, out.as_str()), (Some(2), ""), "{args:?}: {told}");
        let lines: Vec<_> = told.lines().filter(|l| l.starts_with("error: ")).collect();
        assert!(lines.len() == 1 && lines[0].contains(named) && !told.contains("panicked"), "{args:?}: {told}");
    }
    assert_eq!(fs::read_dir(&folder)?.count(), 0, "something was written");
    let (code, out, _) = run(&folder, &["--help"])?;
    assert!(code == Some(0) && out.contains("--no-outline"), "{out}");
    Ok(())
}

#[test]
fn a_window_is_drawn_into() -> TestResult {
    let name = "a_window_is_drawn_into";
    let Some(display) = Display::open() else { return skip(name, "there is no Xvfb to open a window on") };
    let folder = folder("window")?;
    let mut command = program(&folder, &["--frames", "3", "--size", "200x120", "--plan"]);
    let Output { status, stdout, stderr } = command.env("DISPLAY", &display.name).output()?;
    let (out, told) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    if told.contains("no adapter") || told.contains("no window can be opened") {
        return skip(name, told.trim());
    }
    assert!(status.success(), "{told}");
    assert!(out.contains("at 200x120") && out.contains("steps:"), "{out}");
    Ok(())
}

/// Standard output and standard error that take nothing more: an exit code says so, and nothing panics.
#[cfg(unix)]
#[test]
fn a_full_standard_output_is_an_exit_code() {
    let full = || File::options().write(true).open("/dev/full").expect("Linux has it");
    let mut command = Command::new(env!("CARGO_BIN_EXE_custom_pass"));
    let status = command.arg("--help").stdout(full()).stderr(full()).status();
    assert_eq!(status.expect("the program starts").code(), Some(2));
}

#[test]
fn a_backend_that_there_is_not_is_named() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_custom_pass"));
    let output =
        command.args(["--out", "never.png"]).env("WGPU_BACKEND", "vulcan").output().expect("the program starts");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && told.contains("\"vulcan\" names no graphics API"), "{told}");
}
