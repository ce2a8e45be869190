//! Bad input: one line that names what is wrong, exit code 2, no panic, nothing half-written.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Light made by one run is found by the next; none is taken from the user's folder.
const LIGHT: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/light");

/// A folder of its own for each test, empty at first.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

fn render<S: AsRef<OsStr>>(folder: &Path, args: &[S]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_render"));
    // Mesa's device selection layer complains about a missing session on standard error; that is not the program's word.
    command
        .env("NODEVICE_SELECT", "1")
        .env("FRAMEGRAPH_LIGHT_CACHE", LIGHT)
        .current_dir(folder)
        .args(args)
        .output()
        .expect("the program starts")
}

/// Runs it in `folder` and checks the manners of a refusal; returns the line.
fn refused<S: AsRef<OsStr>>(folder: &Path, args: &[S]) -> String {
    let before = entries(folder);
    let Output { status, stderr, .. } = render(folder, args);
    let told = String::from_utf8_lossy(&stderr).into_owned();
    assert_eq!(status.code(), Some(2), "{told}");
    assert!(!told.contains("panicked"), "{told}");
    let errors: Vec<_> = told.lines().filter(|l| l.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{told}");
    assert_eq!(entries(folder), before, "something was written");
    errors[0].to_owned()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut names: Vec<_> = fs::read_dir(folder).expect("the folder is there").flatten().map(|e| e.path()).collect();
    names.sort();
    names
}

#[test]
fn words_that_mean_nothing_are_named() {
    let folder = folder("words");
    let cases: [(&[&str], &str); 12] = [
        (&["--environment", "uniform:1,2"], "--environment uniform 1,2"),
        (&["--sun", "0,0,0:1"], "--sun 0,0,0:1"),
        (&["--background", "blue"], "--background blue"),
        (&["--exposure", "4,1/0,100"], "--exposure 4,1/0,100"),
        (&["--size", "0x0"], "--size 0x0"),
        (&["--colour", "red"], "--colour"),
        (&["spherez"], "spherez"),
        (&["missing.glb"], "missing.glb"),
        (&["--environment", "missing.hdr"], "missing.hdr"),
        (&["--camera", "nobody"], "nobody"),
        (&["--msaa", "16"], "--msaa 16"),
        (&["--size", "999999x4"], "--size 999999x4"),
    ];
    for (args, named) in cases {
        let line = refused(&folder, args);
        assert!(line.contains(named), "{args:?}: {line}");
    }
}

#[test]
fn nothing_is_written_over_what_is_read_or_written() {
    let folder = folder("over");
    triangle(&folder, TRIANGLE, CORNERS, UP);
    fs::write(folder.join("map.exr"), "a map").expect("the folder can be written");
    let cases: [(&[&str], &str); 4] = [
        (&["t.gltf", "--plan", "t.gltf"], "t.gltf: it is read"),
        (&["t.gltf", "--plan", "./t.gltf"], "t.gltf: it is read"),
        (&["t.gltf", "--environment", "map.exr", "--linear-out", "map.exr"], "map.exr: it is read"),
        (&["t.gltf", "--out", "a.png", "--plan", "a.png"], "a.png: two files"),
    ];
    for (args, named) in cases {
        let line = refused(&folder, args);
        assert!(line.contains(named), "{args:?}: {line}");
    }
    assert_eq!(fs::read_to_string(folder.join("t.gltf")).ok().as_deref(), Some(TRIANGLE));
}

/// A triangle as glTF text, with some parts to be replaced by what is wrong.
const TRIANGLE: &str = r#"{
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

fn triangle(folder: &Path, text: &str, positions: [f32; 9], normals: [f32; 9]) {
    let bytes: Vec<u8> = positions.iter().chain(&normals).flat_map(|v| v.to_le_bytes()).collect();
    fs::write(folder.join("t.bin"), bytes).expect("the folder can be written");
    fs::write(folder.join("t.gltf"), text).expect("the folder can be written");
}

const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const UP: [f32; 9] = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];

#[test]
fn broken_models_are_refused() {
    let folder = folder("models");
    let mut nan = CORNERS;
    nan[4] = f32::NAN;
    let cases = [
        (
            "accessor out of range",
            TRIANGLE.replace("\"count\": 3, \"type\": \"VEC3\"}", "\"count\": 300, \"type\": \"VEC3\"}"),
            CORNERS,
            UP,
        ),
        ("no such accessor", TRIANGLE.replace("\"NORMAL\": 1", "\"NORMAL\": 9"), CORNERS, UP),
        ("truncated text", TRIANGLE[..200].to_owned(), CORNERS, UP),
        ("NaN position", TRIANGLE.to_owned(), nan, UP),
        ("zero normals", TRIANGLE.to_owned(), CORNERS, [0.0; 9]),
        ("missing buffer", TRIANGLE.replace("t.bin", "gone.bin"), CORNERS, UP),
    ];
    for (name, text, positions, normals) in cases {
        triangle(&folder, &text, positions, normals);
        let line = refused(&folder, &["t.gltf"]);
        assert!(line.contains("t.gltf") || line.contains("gone.bin"), "{name}: {line}");
    }
}

#[test]
fn broken_pictures_are_refused() {
    let folder = folder("pictures");
    fs::write(folder.join("e.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\nshort").expect("writable");
    fs::write(folder.join("e.exr"), [0x76, 0x2f, 0x31, 0x01, 2, 0]).expect("writable");
    fs::write(folder.join("t.png"), "no picture").expect("writable");
    for name in ["e.hdr", "e.exr"] {
        assert!(refused(&folder, &["--environment", name]).contains(name));
    }
    let material = r#""materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
  "textures": [{"source": 0}], "images": [{"uri": "t.png"}], "accessors""#;
    let text = TRIANGLE.replace("\"accessors\"", material).replace("\"NORMAL\": 1}", "\"NORMAL\": 1}, \"material\": 0");
    triangle(&folder, &text, CORNERS, UP);
    assert!(refused(&folder, &["t.gltf"]).contains("t.png"));
}

#[test]
fn a_target_that_cannot_be_written_is_named() {
    let folder = folder("targets");
    let line = refused(&folder, &["--size", "8x8", "--frames", "1", "--out", "nowhere/picture.png"]);
    assert!(line.contains("nowhere"), "{line}");
}

#[test]
fn help_is_no_error() {
    let output = render(&folder("help"), &["--help"]);
    assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("--environment"));
}
