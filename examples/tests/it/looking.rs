//! Inspection with `render`: requested files exist, and picture and plan stay identical to the byte.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Shared cache folder of image-based light, apart from the user's cache.
const LIGHT: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/light");

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("all")).expect("the target folder can be written");
    folder
}

/// Renders a tiny picture with these options and returns standard output.
fn render(folder: &Path, args: &[&str]) -> Result<String, String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_render"));
    // Bisection measures no times and rejects a number of frames. Small shadow maps shorten the writing of pictures.
    let frames: &[&str] = if args.contains(&"--bisect") { &[] } else { &["--frames", "2"] };
    let map: &[&str] =
        if args.iter().any(|word| word.contains("-shadow")) { &[] } else { &["--shadow", "map-size=256"] };
    let done = command
        .env("NODEVICE_SELECT", "1")
        .env("FRAMEGRAPH_LIGHT_CACHE", LIGHT)
        .current_dir(folder)
        .args(["--size", "48x27"])
        .args([frames, map, args].concat())
        .output();
    let Output { status, stdout, stderr } = done.expect("the program starts");
    let (out, message) = (String::from_utf8_lossy(&stdout).into_owned(), String::from_utf8_lossy(&stderr).into_owned());
    if status.success() { Ok(out) } else { Err(format!("{status}: {message}")) }
}

/// Returns whether an adapter exists; reports a skip otherwise.
fn renders(test: &str, folder: &Path) -> bool {
    let message = render(folder, &["--out", "plain.png"]);
    let missing = message.as_ref().err().filter(|e| e.contains("no adapter"));
    if let Some(why) = missing {
        test_report::skip(test, why.trim());
        return false;
    }
    message.unwrap_or_else(|e| panic!("{e}"));
    true
}

/// Shading in half floats changes the picture, or fails with the name of an adapter without support.
#[test]
fn half_floats_are_an_option() {
    let folder = folder("half_floats");
    if !renders("half_floats_are_an_option", &folder) {
        return;
    }
    let read = |name: &str| fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    match render(&folder, &["--precision", "f16", "--out", "half.png"]) {
        Ok(_) => assert_ne!(read("half.png"), read("plain.png"), "roughness begins at 0.089"),
        Err(message) => assert!(message.contains("SHADER_F16") && !folder.join("half.png").exists(), "{message}"),
    }
}

#[test]
fn looking_changes_neither_the_picture_nor_its_plan() {
    let folder = folder("looking");
    if !renders("looking_changes_neither_the_picture_nor_its_plan", &folder) {
        return;
    }
    let read = |name: &str| fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    let looking =
        ["--out", "looked.png", "--inspect", "depth", "--inspect-mode", "depth", "--inspect-out", "depth.png"];
    let more = ["--inspect-all", "all", "--trace", "trace.json", "--timing"];
    let out = render(&folder, &[&looking[..], &more].concat()).unwrap_or_else(|e| panic!("{e}"));
    assert!(read("plain.png") == read("looked.png"), "another picture");
    assert_eq!(read("plain.plan.txt"), read("looked.plan.txt"));
    assert!(out.contains("depth@color, sample 0, 48x27 Depth32Float"), "{out}");
    assert!(out.contains("created in 2 frames: 0 textures, "), "{out}");
    let held = out.lines().find_map(|line| line.strip_prefix("held by pools: ")).expect("memory is reported");
    let mebibytes: Vec<_> = held.split(" MiB").filter_map(|text| text.rsplit([' ', '(']).next()).collect();
    // Held, used, peak and budget: a single plan was executed, so all held memory is used.
    assert!(mebibytes[0] == mebibytes[1] && mebibytes[0] == mebibytes[2] && mebibytes[0] != "0.00", "{held}");
    let budget = mebibytes[0].parse::<f64>().expect("a number") * 3.0;
    assert!((mebibytes[3].parse::<f64>().expect("a number") - budget).abs() < 0.03, "three plans: {held}");
    assert!(out.contains("| inside wgpu: "), "{out}");
    let trace = String::from_utf8(read("trace.json")).expect("JSON is text");
    assert!(trace.contains("\"name\":\"shadow\"") && trace.contains("\"traceEvents\""));
    assert!(read("depth.png").starts_with(b"\x89PNG"));
    let seen = fs::read_dir(folder.join("all")).expect("the folder is there").count();
    assert!(seen >= 5, "{seen} pictures");
    for name in ["shadow_map@shadow", "hdr_samples@color", "output@post"] {
        assert!(out.contains(&format!(".{name}.png")), "{name}: {out}");
    }

    let message = render(&folder, &["--out", "typo.png", "--inspect", "hbr"]).expect_err("there is no such texture");
    assert!(message.contains("there is no texture `hbr`; the frame has `output`, `shadow_map`"), "{message}");
    assert!(!folder.join("typo.png").exists(), "that is said before any work is done");
    let message = render(&folder, &["--inspect-all", "nowhere"]).expect_err("there is no such folder");
    assert!(message.contains("folder nowhere does not exist"), "{message}");
}

#[test]
fn the_bisection_names_every_mode() {
    let folder = folder("bisect");
    if !renders("the_bisection_names_every_mode", &folder) {
        return;
    }
    // With one sample and rounded radiance, no mode changes the picture.
    let out = render(&folder, &["--bisect", "--msaa", "1", "--round-hdr"]).unwrap_or_else(|e| panic!("{e}"));
    for mode in ["again", "no-cull", "no-merge", "no-inline", "no-alias", "immediate", "poison"] {
        let row = out.lines().find(|l| l.starts_with(&format!("| {mode} "))).unwrap_or_else(|| panic!("{mode}: {out}"));
        assert!(row.contains("| same "), "{row}");
    }
    assert!(out.ends_with("no mode changes the picture\n"), "{out}");
    // With several samples, inlined grading runs per sample and changes the picture.
    let out = render(&folder, &["--bisect", "--msaa", "4"]).unwrap_or_else(|e| panic!("{e}"));
    assert!(out.contains("no-inline is the first mode that changes the picture"), "{out}");
}

/// Later frames of a static scene draw no shadow map, report that, and show an equal picture.
#[test]
fn kept_shadow_maps_are_drawn_once() {
    let folder = folder("kept");
    if !renders("kept_shadow_maps_are_drawn_once", &folder) {
        return;
    }
    let read = |name: &str| fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    let cascades = |plan: &str| String::from_utf8_lossy(&read(plan)).matches("shadow/cascade").count();
    // A map created in the frame has the names of its passes as a prefix.
    let run = |name: &str, words: &str, map: &str| {
        let files = [format!("{name}.png"), format!("{name}.map.png")];
        let looking = ["--inspect", map, "--inspect-out", &files[1]];
        let args = [&["--cascades", "3", "--shadow", words, "--out", &files[0]], &looking[..]].concat();
        render(&folder, &args).unwrap_or_else(|e| panic!("{words}: {e}"))
    };
    let anew = run("anew", "map-size=256,fit=stable", "shadow/shadow_map:0:2");
    let message = run("kept", "texels=256,fit=stable,keep=on", "shadow_map:0:2");
    assert!(message.contains("the first frame draws 3 of 3 shadow maps: 3 never drawn before"), "{message}");
    assert!(message.contains("each later frame draws 0 of 3 shadow maps: all maps are kept"), "{message}");
    assert!(!anew.contains("shadow maps: "), "{anew}");
    assert!(read("kept.png") == read("anew.png") && read("kept.map.png") == read("anew.map.png"), "another picture");
    assert!(cascades("anew.plan.txt") >= 3 && cascades("kept.plan.txt") == 0);
    // Shadows are visible even in this small picture.
    render(&folder, &["--no-shadows", "--out", "none.png"]).unwrap_or_else(|e| panic!("{e}"));
    assert!(read("none.png") != read("kept.png"));
}
