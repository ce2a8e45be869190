//! The program as a process: files, exit codes, and a window if a display exists.

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
    // Mesa's device selection layer complains about a missing session on standard error.
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
    let (code, out, error) = run(&folder, &["--out", "a.png", "--size", "161x91", "--frames", "2", "--plan"])?;
    if error.contains("no adapter") {
        return skip("a_picture_is_drawn_without_a_window", error.trim());
    }
    assert_eq!(code, Some(0), "{error}");
    assert!(out.contains("pass outline (merged: attachments)"), "{out}");
    let ([width, height], rgba) = read_rgba8(&folder.join("a.png"))?;
    assert_eq!([width, height], [161, 91]);
    let white = |rgba: &[u8]| rgba.chunks_exact(4).filter(|t| *t == [255; 4]).count();
    let black = rgba.chunks_exact(4).filter(|t| t[..3] == [0; 3]).count();
    assert!(black == 0 && white(&rgba) > 300, "{black} black texels, {} of lines", white(&rgba));

    let (code, out, _) = run(&folder, &["--out", "b.png", "--size", "161x91", "--no-outline", "--no-blur"])?;
    assert!(code == Some(0) && !out.contains("steps:"), "{out}");
    let (_, plain) = read_rgba8(&folder.join("b.png"))?;
    assert!(white(&plain) < 100, "only the emitter is white: {}", white(&plain));
    assert_eq!(fs::read_dir(&folder)?.count(), 2, "no temporary file is left");
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
        let (code, out, error) = run(&folder, args)?;
        assert_eq!((code, out.as_str()), (Some(2), ""), "{args:?}: {error}");
        let lines: Vec<_> = error.lines().filter(|l| l.starts_with("error: ")).collect();
        assert!(lines.len() == 1 && lines[0].contains(named) && !error.contains("panicked"), "{args:?}: {error}");
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
    let (out, error) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    if error.contains("no adapter") || error.contains("no window can be opened") {
        return skip(name, error.trim());
    }
    assert!(status.success(), "{error}");
    assert!(out.contains("at 200x120") && out.contains("steps:"), "{out}");
    Ok(())
}

/// If both streams are full, the exit code reports it and nothing panics.
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
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && error.contains("\"vulcan\" names no graphics API"), "{error}");
}
