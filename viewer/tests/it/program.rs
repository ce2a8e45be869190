//! The program without a window.

use crate::{case, folder};
use std::path::Path;
use std::process::Command;

fn run(args: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_viewer")).args(args).output().expect("the program starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("a name")
}

#[test]
fn views_are_written_as_svg() {
    let folder = folder("svg");
    let (frame, other) = (case("filament"), case("forward"));
    for view in ["graph", "timeline", "memory", "bandwidth", "inspector", "diff"] {
        let out = folder.join(format!("{view}.svg"));
        let args = [
            "--headless",
            "--view",
            view,
            "--caps",
            "wgpu-native",
            "--plan",
            shown(&frame),
            "--against",
            shown(&other),
            "--out",
            shown(&out),
        ];
        let (code, _, message) = run(&args);
        assert_eq!(code, Some(0), "{message}");
        let text = std::fs::read_to_string(&out).expect("the file is there");
        assert!(text.contains("Filament") && text.ends_with("</svg>\n"), "{view}");
    }
}

#[test]
fn every_mistake_is_one_line_and_leaves_no_file() {
    let folder = folder("mistakes");
    let bad = folder.join("bad.json");
    std::fs::write(&bad, "{\"schema\": \"framegraph-plan\", \"version\": 9}").expect("a file");
    let out = folder.join("out.svg");
    let frame = case("diamond");
    let cases: [(&[&str], &str); 5] = [
        (&["--headless", "--plan", shown(&bad), "--out", shown(&out)], "version 9"),
        (&["--headless", "--plan", "none.json", "--out", shown(&out)], "none.json"),
        (&["--headless", "--plan", shown(&frame), "--out", "out.jpg"], "out.jpg"),
        (&["--headless", "--plan", shown(&frame), "--select", "nobody", "--out", shown(&out)], "`nobody`"),
        (&["--headless", "--plan", shown(&frame), "--caps", "toaster", "--out", shown(&out)], "`toaster`"),
    ];
    for (args, named) in cases {
        let (code, out, message) = run(args);
        assert_eq!((code, out.as_str()), (Some(2), ""), "{args:?}: {message}");
        assert!(
            message.lines().count() == 1 && message.starts_with("error: ") && message.contains(named),
            "{args:?}: {message}"
        );
    }
    assert!(!out.exists());
    let (code, help, _) = run(&["--help"]);
    assert!(code == Some(0) && help.contains("--headless") && help.lines().all(|line| line.len() <= 120), "{help}");
}

/// Writes a graph file with 20,000 passes in a row, which takes longer to plan than a signal takes to arrive.
fn long_chain(path: &Path) {
    let (mut resources, mut passes) = (String::new(), String::new());
    for i in 0..20_000 {
        resources += &format!("Texture(name: \"t{i}\", format: Rgba8Unorm), ");
        let read = if i > 0 { format!("Sampled(of: \"t{0}@p{0}\"), ", i - 1) } else { String::new() };
        passes += &format!("Raster(name: \"p{i}\", accesses: [{read}Color(to: \"t{i}\", intent: Overwrite)]),\n");
    }
    std::fs::write(path, format!("(version: 1, resources: [{resources}], passes: [{passes}])")).expect("a file");
}

#[cfg(unix)]
#[test]
fn a_signal_leaves_no_file_behind() {
    let (folder, input) = (folder("signal"), folder("signal_input").join("long.ron"));
    long_chain(&input);
    let mut command = Command::new(env!("CARGO_BIN_EXE_viewer"));
    command.arg("--headless").arg("--plan").arg(&input).arg("--out").arg(folder.join("out.svg"));
    let mut child = command.stderr(std::process::Stdio::piped()).spawn().expect("the program starts");
    let parts = || std::fs::read_dir(&folder).expect("it is there").count();
    while parts() == 0 {
        assert!(matches!(child.try_wait(), Ok(None)), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()));
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert_eq!(parts(), 0);
}
