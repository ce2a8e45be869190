//! `cargo xtask corpus` with the real `render` on wgpu's noop backend.

use crate::support::{CORNERS, TRIANGLE, UP, folder, triangle};
use corpus::args::Args;
use corpus::run;
use corpus::verdict::Verdict;
use std::fs;
use std::process::Command;
use std::time::Duration;

#[test]
fn a_folder_of_good_and_bad_files_has_its_verdicts() {
    let folder = folder("corpus_run");
    let scenes = folder.join("scenes");
    fs::create_dir_all(&scenes).expect("a folder");
    triangle(&scenes, TRIANGLE, CORNERS, UP);
    fs::write(scenes.join("old.gltf"), TRIANGLE.replace("\"2.0\"", "\"3.0\"")).expect("a scene");
    fs::write(scenes.join("garbage.glb"), [7; 100]).expect("a scene");
    // Another process writes the script, because a script that this process has open cannot be executed.
    let script = "printf '%s\\n' '#!/bin/sh' \"WGPU_BACKEND=noop FRAMEGRAPH_LIGHT_CACHE='$2' exec '$1' \\\"\\$@\\\"\" > \"$3\"; chmod +x \"$3\"";
    let render = folder.join("render.sh");
    let light = concat!(env!("CARGO_TARGET_TMPDIR"), "/light");
    let written =
        Command::new("sh").args(["-c", script, "sh", env!("CARGO_BIN_EXE_render"), light]).arg(&render).status();
    assert!(written.is_ok_and(|status| status.success()));
    let outcome = run(&Args {
        folder: scenes,
        out: folder.join("out"),
        jobs: 2,
        limit: Duration::from_secs(300),
        memory_bytes: 4 << 30,
        size_px: [16, 16],
        render,
        further: vec!["--no-shadows".to_owned()],
    });
    let report = outcome.expect("a run").report;
    let found: Vec<_> = report.files.iter().map(|r| (r.file.as_str(), r.verdict, r.message.as_str())).collect();
    let verdicts: Vec<_> = found.iter().map(|(file, verdict, _)| (*file, *verdict)).collect();
    let expected = [("garbage.glb", Verdict::Refused), ("old.gltf", Verdict::Refused), ("t.gltf", Verdict::Ok)];
    assert_eq!(verdicts, expected, "{found:?}");
    assert!(found[1].2.contains("3.0"), "{found:?}");
    assert!(folder.join("out/pictures/t.gltf.png").is_file());
}
