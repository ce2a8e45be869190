//! Runs over small folders with a fake `render`, whose scenes say how it ends.
#![cfg(unix)]

use corpus::args::Args;
use corpus::record::{Report, VERSION};
use corpus::verdict::Verdict;
use corpus::{Outcome, run, sheet, table};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A folder that is removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, scenes: &[(&str, &str)]) -> Self {
        let folder = Self(std::env::temp_dir().join(format!("corpus-{name}-{}", std::process::id())));
        for (file, text) in scenes {
            let file = folder.0.join("in").join(file);
            fs::create_dir_all(file.parent().expect("a parent")).expect("a folder");
            fs::write(&file, text).expect("a scene");
            write_picture(&file.with_file_name("picture"));
        }
        folder
    }

    fn args(&self) -> Args {
        Args {
            folder: self.0.join("in"),
            out: self.0.join("out"),
            jobs: 2,
            limit: Duration::from_secs(20),
            memory_bytes: 1 << 30,
            size_px: [16, 16],
            render: Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fake_render.sh"),
            further: Vec::new(),
        }
    }

    /// Returns the number of times the fake was started for a scene.
    fn starts(&self, scene: &str) -> usize {
        let count = fs::read_to_string(self.0.join("in").join(format!("{scene}.count")));
        count.map_or(0, |text| text.lines().count())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // The system clears its folder where this fails.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A PNG of one red pixel, RGBA of eight bits, as `render` writes.
fn write_picture(file: &Path) {
    let mut encoder = png::Encoder::new(fs::File::create(file).expect("a file"), 1, 1);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[255, 0, 0, 255]).expect("a pixel");
}

fn verdicts(outcome: &Outcome) -> Vec<(&str, Verdict, &str)> {
    outcome.report.files.iter().map(|r| (r.file.as_str(), r.verdict, r.message.as_str())).collect()
}

#[test]
fn each_end_has_its_verdict() {
    let folder = Folder::new(
        "verdicts",
        &[
            ("a/good.gltf", "good"),
            ("a/warned.GLB", "warned"),
            ("absent.glb", "absent"),
            ("crash.glb", "crash"),
            ("device.glb", "device"),
            ("nan.glb", "nan"),
            ("panic.glb", "panic"),
            ("refuse.glb", "refuse"),
            ("silent.glb", "silent"),
            ("text.txt", "good"),
            ("unseen.glb", "unseen"),
        ],
    );
    let outcome = run(&folder.args()).expect("a run");
    let found = verdicts(&outcome);
    let expected = [
        ("a/good.gltf", Verdict::Ok, ""),
        ("a/warned.GLB", Verdict::Ok, ""),
        ("absent.glb", Verdict::Failed, "no picture was written"),
        ("crash.glb", Verdict::Crashed, "signal: 11"),
        ("device.glb", Verdict::Failed, "the device is lost"),
        ("nan.glb", Verdict::NonFinite, "3 texels are not finite"),
        ("panic.glb", Verdict::Crashed, "exit status: 101; thread main panicked at src/a.rs:1:2: index out of bounds"),
        ("refuse.glb", Verdict::Refused, "a.gltf: JSON: it is cut off"),
        ("silent.glb", Verdict::Crashed, "exit status: 2"),
        ("unseen.glb", Verdict::Failed, "the radiance was not inspected"),
    ];
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        assert!(found.2.starts_with(expected.2), "{found:?}");
    }
    assert_eq!(outcome.report.files[1].warnings, ["a.gltf: lines are not drawn"]);
    assert!(outcome.report.has_faults());

    let text = table::markdown(&outcome.report);
    assert!(text.contains("| 10 | 2 | 1 | 1 | 3 | 3 | 0 | 0 | 1 |\n"), "{text}");
    assert!(
        text.contains("| refused | refuse.glb | a.gltf: JSON: it is cut off |\n") && !text.contains("good"),
        "{text}"
    );

    let json = fs::read_to_string(folder.0.join("out/corpus.json")).expect("a report");
    let read: Report = serde_json::from_str(&json).expect("JSON");
    assert_eq!((read.version, &read), (VERSION, &outcome.report));
    assert!(folder.0.join("out/sheet-1.png").is_file());
    let picture = sheet::decode(&folder.0.join("out/pictures/a/good.gltf.png")).expect("the picture is kept");
    assert_eq!(picture.rgb8, [255, 0, 0]);
}

#[test]
fn limits_of_time_and_memory_end_a_process() {
    let folder = Folder::new("limits", &[("hang.glb", "hang"), ("good.glb", "good")]);
    let start = Instant::now();
    let outcome = run(&Args { limit: Duration::from_secs(1), ..folder.args() }).expect("a run");
    assert_eq!(verdicts(&outcome)[1], ("hang.glb", Verdict::Hung, "stopped after 1 s"));
    assert_eq!(outcome.report.files[0].verdict, Verdict::Ok);
    assert!(start.elapsed() < Duration::from_secs(30), "the fake would sleep for a minute");
    if cfg!(target_os = "linux") {
        let folder = Folder::new("memory", &[("eat.glb", "eat")]);
        let outcome = run(&Args { memory_bytes: 64 << 20, ..folder.args() }).expect("a run");
        let record = &outcome.report.files[0];
        assert_eq!(record.verdict, Verdict::Memory, "{}", record.message);
        assert!(record.peak_bytes > 64 << 20, "{}", record.peak_bytes);
    }
}

#[test]
fn finished_files_are_rendered_again_only_when_something_changed() {
    let folder = Folder::new("resumes", &[("good.glb", "good"), ("refuse.glb", "refuse")]);
    let first = run(&folder.args()).expect("a run");
    let again = run(&folder.args()).expect("a second run");
    assert_eq!((first.rendered, again.rendered), (2, 0));
    assert_eq!(again.report, first.report);
    assert_eq!((folder.starts("good.glb"), folder.starts("refuse.glb")), (1, 1));

    // A record that was being written when the run ended is cut off; its file is rendered again.
    let state = folder.0.join("out/corpus.state");
    let text = fs::read_to_string(&state).expect("a state");
    fs::write(&state, &text[..text.len() - 10]).expect("a cut state");
    assert_eq!(run(&folder.args()).expect("a third run").rendered, 1);

    fs::write(folder.0.join("in/refuse.glb"), "good, for now").expect("a changed scene");
    let changed = run(&folder.args()).expect("a fourth run");
    assert_eq!((changed.rendered, changed.report.count(Verdict::Ok)), (1, 2));

    let other = Args { further: vec!["--msaa".to_owned(), "1".to_owned()], ..folder.args() };
    assert_eq!(run(&other).expect("a run with other options").rendered, 2);
}

#[test]
fn a_missing_folder_or_program_is_named() {
    let folder = Folder::new("missing", &[("good.glb", "good")]);
    let none = Args { folder: folder.0.join("none"), ..folder.args() };
    assert!(run(&none).is_err_and(|error| error.contains("none")));
    let none = Args { render: "no/such/render".into(), ..folder.args() };
    assert!(run(&none).is_err_and(|error| error.contains("no/such/render")));
}

#[test]
fn an_interrupted_run_resumes() {
    let folder = Folder::new("interrupt", &[("a.glb", "good"), ("b.glb", "hang")]);
    let args = folder.args();
    let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_corpus"));
    program.arg(&args.folder).arg("--out").arg(&args.out).arg("--render").arg(&args.render);
    program.args(["--jobs", "1", "--seconds", "20", "--memory", "1GiB", "--size", "16x16"]);
    let child =
        program.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped()).spawn().expect("it starts");
    let start = Instant::now();
    while folder.starts("b.glb") == 0 {
        assert!(start.elapsed() < Duration::from_secs(20), "the second file was not begun");
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()));
    let output = child.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.contains("error: stopped with 1 of 2 files done"), "{said}");
    assert!(!args.out.join("corpus.json").exists(), "an interrupted run has no report");

    fs::write(args.folder.join("b.glb"), "good").expect("a changed scene");
    let outcome = run(&args).expect("the rest");
    assert_eq!((outcome.rendered, outcome.total, folder.starts("a.glb")), (1, 2, 1));
}
