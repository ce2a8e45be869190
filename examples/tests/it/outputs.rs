//! Output of `render`: closed or full standard output, pipes, input files as outputs, signals.
#![cfg(unix)]

use crate::support::{CORNERS, TRIANGLE, UP, entries, folder, refusal, triangle, undrawn};
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

/// glTF material with one texture.
const TEXTURED: &str = r#""materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
  "textures": [{"source": 0}], "images": [{"uri": "t.png", "name": "wood"}], "accessors""#;

/// Writes the triangle with a texture of 4×4 texels.
pub fn textured(folder: &Path) {
    let text = TRIANGLE.replace("\"accessors\"", TEXTURED).replace("\"NORMAL\": 1}", "\"NORMAL\": 1}, \"material\": 0");
    triangle(folder, &text, CORNERS, UP);
    let picture = image::RgbImage::from_pixel(4, 4, image::Rgb([200, 100, 50]));
    picture.save(folder.join("t.png")).expect("the folder can be written");
}

#[test]
fn a_closed_or_full_standard_output_costs_no_file() {
    let folder = folder("stdout");
    for (to, code, words) in [("/dev/full", 2, "error: standard output: "), ("closed", 0, "")] {
        let out = format!("{}.png", to.rsplit('/').next().unwrap_or(to));
        let mut command = undrawn(&folder, &["--frames", "1", "--timing", "--out", &out]);
        command.stderr(Stdio::piped()).stdout(match to {
            "closed" => Stdio::piped(),
            device => File::options().write(true).open(device).expect("Linux has it").into(),
        });
        let mut child = command.spawn().expect("the program starts");
        drop(child.stdout.take());
        let mut message = String::new();
        child.stderr.take().expect("it is piped").read_to_string(&mut message).expect("the words are UTF-8");
        assert_eq!(child.wait().expect("it ends").code(), Some(code), "{to}: {message}");
        assert!(!message.contains("panicked") && message.contains(words), "{to}: {message}");
        assert_eq!(message.contains("error"), !words.is_empty(), "{to}: {message}");
        assert!(folder.join(&out).is_file(), "{to}");
    }
    // Both streams are full, so the failure cannot be reported.
    let full = || File::options().write(true).open("/dev/full").expect("Linux has it");
    let status = undrawn(&folder, &["--help"]).stdout(full()).stderr(full()).status();
    assert_eq!(status.expect("the program starts").code(), Some(2));
}

#[test]
fn words_make_way_for_a_file_on_standard_output() {
    let folder = folder("diverted");
    for out in ["/dev/stdout", "link.png"] {
        if out == "link.png" {
            symlink("/dev/stdout", folder.join(out)).expect("the folder is ours");
        }
        let output = undrawn(&folder, &["--frames", "1", "--out", out]).output().expect("the program starts");
        assert!(output.status.success());
        let picture = image::load_from_memory(&output.stdout).expect("a picture and nothing else");
        assert_eq!((picture.width(), picture.height()), (16, 8));
        assert!(String::from_utf8_lossy(&output.stderr).contains("adapter: "));
    }
    assert_eq!(entries(&folder).len(), 1, "no plan is written beside a pipe");
    let output = undrawn(&folder, &["--frames", "1", "--out", "a.png", "--plan", "/dev/stdout"]).output();
    let output = output.expect("the program starts");
    assert!(output.stdout.starts_with(b"plan 2 for "), "{}", String::from_utf8_lossy(&output.stdout));
    assert_eq!(entries(&folder).len(), 2);
}

#[test]
fn nothing_that_the_scene_was_read_from_is_written_over() {
    let folder = folder("over_scene");
    textured(&folder);
    symlink("t.png", folder.join("link.png")).expect("the folder is ours");
    for (args, named) in [
        (["--out", "t.png"], "t.png: it is an input"),
        (["--out", "link.png"], "link.png: it is an input"),
        (["--plan", "t.bin"], "t.bin: it is an input"),
        (["--trace", "/dev/null/t.json"], "/dev/null/t.json: cannot be written"),
    ] {
        let line = refusal(&folder, undrawn(&folder, &["t.gltf"]).args(args));
        assert!(line.contains(named), "{args:?}: {line}");
    }
}

#[test]
fn a_failed_output_leaves_no_other_one() {
    let folder = folder("together");
    let line =
        refusal(&folder, &mut undrawn(&folder, &["--frames", "1", "--out", "a.png", "--linear-out", "/dev/full"]));
    assert!(line.contains("/dev/full: cannot be written"), "{line}");
}

#[test]
fn long_names_have_neighbours() {
    let folder = folder("long");
    let name = format!("{}.png", "n".repeat(251));
    assert!(undrawn(&folder, &["--frames", "1", "--out", &name]).output().is_ok_and(|output| output.status.success()));
    assert_eq!(entries(&folder).len(), 3);
}

#[test]
fn every_frame_is_in_the_trace() {
    let folder = folder("trace");
    let status = undrawn(&folder, &["--frames", "1100", "--trace", "t.json"]).stdout(Stdio::null()).status();
    assert!(status.is_ok_and(|status| status.success()));
    let trace = fs::read_to_string(folder.join("t.json")).expect("it was written");
    let last = 1100 + 4 - 1;
    for frame in [0, last / 2, last] {
        assert!(trace.contains(&format!("\"frame {frame}\"")), "frame {frame} is missing");
    }
}

#[test]
fn a_signal_stops_the_run_and_leaves_nothing() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let folder = folder(&format!("signal_{signal}"));
        let mut command = undrawn(&folder, &["--frames", "10000", "--inspect", "hdr"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
        let mut first = String::new();
        BufReader::new(child.stdout.as_mut().expect("it is piped")).read_line(&mut first).expect("a line of words");
        assert!(first.starts_with("adapter: "), "{first}");
        assert!(!entries(&folder).is_empty(), "the parts are there");
        let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
        assert!(sent.is_ok_and(|status| status.success()));
        let output = child.wait_with_output().expect("it ends");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(message.contains("error: stopped by signal"), "{message}");
        assert_eq!(entries(&folder), [] as [std::path::PathBuf; 0]);
    }
}
