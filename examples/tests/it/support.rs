//! Running `render` in a test folder, and a small scene.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Shared cache folder of image-based light, apart from the user's cache.
pub const LIGHT: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/light");

/// Creates an empty folder for a test.
pub fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

pub fn render<S: AsRef<OsStr>>(folder: &Path, args: &[S]) -> Output {
    command(folder).args(args).output().expect("the program starts")
}

/// Returns the program in `folder`, without arguments.
pub fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_render"));
    // Mesa's device selection layer complains about a missing session on standard error.
    command.env("NODEVICE_SELECT", "1").env("FRAMEGRAPH_LIGHT_CACHE", LIGHT).current_dir(folder);
    command
}

/// Returns the program on wgpu's noop backend with a small frame, for tests that need no picture.
pub fn undrawn(folder: &Path, args: &[&str]) -> Command {
    let mut command = command(folder);
    command.env("WGPU_BACKEND", "noop").args(["--size", "16x8"]).args(args);
    command
}

/// Runs the program in `folder`, checks the form of its error, and returns the error line.
pub fn refused<S: AsRef<OsStr>>(folder: &Path, args: &[S]) -> String {
    let mut command = command(folder);
    command.args(args);
    refusal(folder, &mut command)
}

/// Runs a command, checks the form of its error, and returns the error line.
pub fn refusal(folder: &Path, command: &mut Command) -> String {
    let before = entries(folder);
    let Output { status, stderr, .. } = command.output().expect("the program starts");
    let message = String::from_utf8_lossy(&stderr).into_owned();
    assert_eq!(status.code(), Some(2), "{message}");
    assert!(!message.contains("panicked"), "{message}");
    let errors: Vec<_> = message.lines().filter(|l| l.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{message}");
    assert_eq!(entries(folder), before, "something was written");
    errors[0].to_owned()
}

pub fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut names: Vec<_> = fs::read_dir(folder).expect("the folder is there").flatten().map(|e| e.path()).collect();
    names.sort();
    names
}

/// Triangle as glTF text, with parts that tests replace by invalid ones.
pub const TRIANGLE: &str = r#"{
  "asset": {"version": "2.0"},
  "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}
  ],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 36}],
  "buffers": [{"uri": "t.bin", "byteLength": 72}]
}"#;

pub fn triangle(folder: &Path, text: &str, positions: [f32; 9], normals: [f32; 9]) {
    let bytes: Vec<u8> = positions.iter().chain(&normals).flat_map(|v| v.to_le_bytes()).collect();
    fs::write(folder.join("t.bin"), bytes).expect("the folder can be written");
    fs::write(folder.join("t.gltf"), text).expect("the folder can be written");
}

pub const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
pub const UP: [f32; 9] = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
