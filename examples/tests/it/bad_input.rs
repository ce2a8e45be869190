//! Invalid input: one line that names the mistake, exit code 2, no panic, no partial file.

use crate::support::{CORNERS, TRIANGLE, UP, folder, refused, render, triangle};
use std::fs;

#[test]
fn invalid_values_are_reported() {
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
fn no_input_or_output_is_overwritten() {
    let folder = folder("over");
    triangle(&folder, TRIANGLE, CORNERS, UP);
    fs::write(folder.join("map.exr"), "a map").expect("the folder can be written");
    let cases: [(&[&str], &str); 4] = [
        (&["t.gltf", "--plan", "t.gltf"], "t.gltf: it is an input"),
        (&["t.gltf", "--plan", "./t.gltf"], "t.gltf: it is an input"),
        (&["t.gltf", "--environment", "map.exr", "--linear-out", "map.exr"], "map.exr: it is an input"),
        (&["t.gltf", "--out", "a.png", "--plan", "a.png"], "a.png: two outputs"),
    ];
    for (args, named) in cases {
        let line = refused(&folder, args);
        assert!(line.contains(named), "{args:?}: {line}");
    }
    assert_eq!(fs::read_to_string(folder.join("t.gltf")).ok().as_deref(), Some(TRIANGLE));
}

#[test]
fn invalid_models_are_rejected() {
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
        ("missing buffer", TRIANGLE.replace("t.bin", "gone.bin"), CORNERS, UP),
    ];
    for (name, text, positions, normals) in cases {
        triangle(&folder, &text, positions, normals);
        let line = refused(&folder, &["t.gltf"]);
        assert!(line.contains("t.gltf") || line.contains("gone.bin"), "{name}: {line}");
    }
}

#[test]
fn invalid_pictures_are_rejected() {
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
fn an_unwritable_output_is_reported() {
    let folder = folder("targets");
    let line = refused(&folder, &["--size", "8x8", "--frames", "1", "--out", "nowhere/picture.png"]);
    assert!(line.contains("nowhere"), "{line}");
}

#[test]
fn help_is_no_error() {
    let output = render(&folder("help"), &["--help"]);
    assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("--environment"));
}
