//! Runs the program `plan` and checks its output, files and exit codes.

mod characters;
mod ci;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn case(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases").join(name);
    path.display().to_string()
}

fn plan(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_plan"))
        .args(args)
        .env_remove("UPDATE_GOLDENS")
        .output()
        .expect("the program starts")
}

/// Returns exit code, standard output and standard error.
fn run(args: &[&str]) -> (Option<i32>, String, String) {
    let output = plan(args);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the output is UTF-8");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// Returns the path of a scratch file of this test binary.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("plan");
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    folder.join(name)
}

#[test]
fn options_select_device_size_and_features() {
    let frame = case("filament.ron");
    let (code, text, error) = run(&[&frame]);
    assert_eq!((code, error.as_str()), (Some(0), ""));
    assert!(text.starts_with("plan 2 for wgpu at 1920x1080\ncounts: 0 loads, 2 stores,"), "{text}");
    let (_, text, _) =
        run(&[&frame, "--caps", "desktop", "--size", "640x360", "--set", "fxaa=off", "--set", "msaa=on"]);
    assert!(text.starts_with("plan 2 for desktop at 640x360\ncounts: 0 loads, 2 stores,"), "{text}");
    let (_, declared, _) = run(&[&frame, "--order", "declared", "--format", "json"]);
    let (_, optimized, _) = run(&[&frame, "--order", "optimized", "--format", "json"]);
    assert!(declared.contains("\"order\": \"declared\"") && optimized.contains("\"order\": \"optimized\""));
}

#[test]
fn every_format_is_written() {
    let frame = case("two_views.ron");
    for (format, start) in [
        ("text", "plan 2 for"),
        ("json", "{\n  \"schema\": \"framegraph-plan\""),
        ("dot", "digraph plan {"),
        ("mermaid", "flowchart LR"),
        ("svg", "<svg xmlns=\"http://www.w3.org/2000/svg\""),
    ] {
        let (code, text, _) = run(&[&frame, "--format", format]);
        assert!(code == Some(0) && text.starts_with(start), "{format}: {text}");
        let out = scratch(&format!("two_views.{format}"));
        let (code, printed, _) = run(&[&frame, "--format", format, "--out", &out.display().to_string()]);
        assert_eq!((code, printed.as_str()), (Some(0), ""));
        assert_eq!(std::fs::read_to_string(&out).expect("the file is there"), text);
    }
}

#[test]
fn an_exceeded_budget_lists_the_decisions_that_caused_it() {
    let frame = case("filament.ron");
    let with = |budget| run(&[&frame, "--set", "sao=on", "--caps", "desktop", "--budget", budget]);
    // Three loads of tested depth and eleven stores; see the case file.
    let (code, text, error) = with("loads=3,stores=11");
    assert_eq!((code, error.as_str()), (Some(0), ""));
    assert!(text.starts_with("plan 2"));
    let (code, text, error) = with("loads=2,stores=11");
    assert_eq!(code, Some(1));
    assert!(text.starts_with("plan 2"), "the plan is printed all the same");
    let lines: Vec<_> = error.lines().collect();
    assert_eq!(lines[0], "budget exceeded: loads 3, limit 2");
    assert_eq!(lines.len(), 4, "{error}");
    for line in &lines[1..] {
        assert!(
            line.contains("load of `structure` in step")
                && line.contains("written by `structure`")
                && line.contains("; "),
            "{line}"
        );
    }
    let (code, _, error) = with("bytes=1MB,traffic=1MB,steps=1,culled=0");
    assert_eq!(code, Some(1));
    for line in ["budget exceeded: bytes ", "budget exceeded: traffic ", "budget exceeded: steps ", "not merged with"] {
        assert!(error.contains(line), "{error}\nlacks {line}");
    }
    assert!(!error.contains("culled"), "nothing is culled: {error}");
}

#[test]
fn two_frames_are_compared() {
    let (desktop, other) = (case("two_views.ron"), case("diamond.ron"));
    let (code, text, _) = run(&[&desktop, "--diff", &other]);
    assert_eq!(code, Some(0));
    assert!(text.starts_with("passes:\n  - a/scene\n"), "{text}");
    let (_, same, _) = run(&[&desktop, "--diff", &desktop]);
    assert_eq!(same, "no change\n");
    let (_, json, _) = run(&[&desktop, "--diff", &other, "--format", "json"]);
    assert!(json.contains("\"passes_removed\": [\n    \"a/scene\""), "{json}");
    // A feature known to only one of both files is switched there. A feature unknown to both is an error.
    let frame = case("filament.ron");
    for args in [[&frame, "--diff", &desktop], [&desktop, "--diff", &frame]] {
        let (code, off, error) = run(&[&args[..], &["--set", "fxaa=off"]].concat());
        assert_eq!((code, error.as_str()), (Some(0), ""));
        assert_ne!(off, run(&args).1, "the switch does nothing");
        let (code, _, error) = run(&[&args[..], &["--set", "fxa=off"]].concat());
        assert!(code == Some(2) && error.contains("unknown feature `fxa`"), "{error}");
    }
}

#[test]
fn devices_come_from_files_too() {
    let device = scratch("device.ron");
    std::fs::write(&device, "(version: 1, like: \"tiler\", name: \"tiny\", tile_bytes_per_pixel: 16)")
        .expect("written");
    let (code, text, error) = run(&[&case("granite_on_tile.ron"), "--caps", &device.display().to_string()]);
    assert_eq!((code, error.as_str()), (Some(0), ""));
    assert!(text.starts_with("plan 2 for tiny") && text.contains("together they exceed the tile memory"), "{text}");
}

#[test]
fn invalid_input_is_one_line_per_error_and_exit_code_2() {
    let bad = scratch("bad.ron");
    std::fs::write(&bad, "(version: 1, resources: [\n  Texture(name: \"a\", format: R8Unrm),\n])").expect("written");
    let latin = scratch("latin.ron");
    std::fs::write(&latin, b"(version: 1,\n  name: \"\xe9\")").expect("written");
    let frame = case("filament.ron");
    let shown = bad.display().to_string();
    let cases: [(&[&str], String); 9] = [
        (&[], "FRAME.ron: missing argument; see --help".into()),
        (&[&frame, "--frobnicate"], "--frobnicate: unknown option; did you mean".into()),
        (&[&frame, "--size", "big"], "--size big: expected WxH".into()),
        (&[&frame, "--set", "fxa=off"], "unknown feature `fxa`; did you mean `fxaa`?".into()),
        (
            &[&frame, "--caps", "toaster"],
            "--caps: invalid value `toaster`; expected desktop, tiler, mali, adreno, apple, wgpu, wgpu-native or a FILE.ron".into(),
        ),
        (&[&frame, "--size", "20000x20000"], "the device allows".into()),
        (&["nowhere.ron"], "nowhere.ron: cannot be read: ".into()),
        (&[&shown], format!("{shown}:2:30: `R8Unrm` is not a variant of Format; did you mean `R8Unorm`?")),
        (&[latin.to_str().expect("the path is UTF-8")], ":2:1: the line is not UTF-8".into()),
    ];
    for (args, expected) in cases {
        let (code, text, error) = run(args);
        assert_eq!((code, text.as_str()), (Some(2), ""), "{args:?}");
        assert!(error.contains(&expected), "{args:?}: {error}");
    }
}

#[test]
fn intervals_are_packed_and_mistakes_are_reported() {
    let csv = scratch("intervals.csv");
    std::fs::write(&csv, "id,lower,upper,size\na,0,3,4\nb,3,9,4\nc,0,9,4\n").expect("written");
    let path = csv.display().to_string();
    let (code, text, error) = run(&["--offsets", &path]);
    assert_eq!((code, error.as_str()), (Some(0), "top 8, lower bound 8, optimal\n"));
    let offsets: Vec<u64> = text.lines().skip(1).filter_map(|l| l.rsplit(',').next()?.parse().ok()).collect();
    assert!(text.starts_with("id,lower,upper,size,offset\na,0,3,4,") && offsets.len() == 3, "{text}");
    assert!(offsets[0] == offsets[1] && offsets[0] != offsets[2] && offsets.iter().all(|o| [0, 4].contains(o)));
    std::fs::write(&csv, "id,lower,upper,size\na,0,3,x\n").expect("written");
    let (code, text, error) = run(&["--offsets", &path, "--budget-steps", "5"]);
    assert_eq!((code, text.as_str()), (Some(2), ""));
    assert!(error.contains("line 2") && error.contains("size"), "{error}");
}

/// A search that would take hours reports its progress. It ends at the time limit or at a signal, and prints its best
/// result.
#[cfg(unix)]
#[test]
fn offsets_are_printed_when_time_is_up() {
    use framegraph_check::planted::{Cuts, Planted};
    use std::process::Stdio;
    let csv = scratch("planted.csv");
    let items = Planted { items: 3000, ..Planted::square(Cuts::Even) }.items(1);
    let row = |item: &framegraph::pack::Interval| format!("x,{},{},{}\n", item.lower, item.upper, item.size);
    let rows: String = items.iter().map(row).collect();
    std::fs::write(&csv, format!("id,lower,upper,size\n{rows}")).expect("written");
    let path = csv.display().to_string();
    let steps = u64::MAX.to_string();
    let (code, text, error) = run(&["--offsets", &path, "--budget-steps", &steps, "--seconds", "2"]);
    assert_eq!((code, text.lines().count()), (Some(0), items.len() + 1), "{error}");
    assert!(error.contains(" s, ") && error.contains("not proved optimal in "), "{error}");
    let mut child = Command::new(env!("CARGO_BIN_EXE_plan"));
    child.args(["--offsets", &path, "--budget-steps", &steps]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = child.spawn().expect("the program starts");
    let mut reported = String::new();
    let mut lines = std::io::BufReader::new(child.stderr.take().expect("it is piped"));
    std::io::BufRead::read_line(&mut lines, &mut reported).expect("the words are UTF-8");
    let sent = Command::new("kill").args(["-s", "TERM", &child.id().to_string()]).status();
    assert!(reported.contains("lower bound 1024") && sent.expect("kill is there").success(), "{reported}");
    let output = child.wait_with_output().expect("it ends");
    let lines = output.stdout.iter().filter(|byte| **byte == b'\n').count();
    assert_eq!((output.status.code(), lines), (Some(0), items.len() + 1));
}

#[test]
fn help_names_every_option() {
    let (code, text, _) = run(&["--help"]);
    assert_eq!(code, Some(0));
    for option in [
        "--caps",
        "--size",
        "--set",
        "--order",
        "--format",
        "--diff",
        "--budget",
        "--assert",
        "--golden",
        "--out",
        "--offsets",
        "--budget-steps",
        "--seconds",
        "--help",
    ] {
        assert!(text.contains(option), "{option}");
    }
}

/// `docs/plan.svg` equals the output of the command in the README.
#[test]
fn the_picture_in_the_readme_is_what_its_command_writes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let readme = std::fs::read_to_string(root.join("README.md")).expect("the README is there");
    let command = readme.lines().find_map(|line| line.strip_prefix("cargo run --release --bin plan -- "));
    let out = scratch("readme.svg");
    let words: Vec<String> = command
        .expect("the README has the command")
        .split(' ')
        .map(|word| if word == "docs/plan.svg" { out.display().to_string() } else { word.to_owned() })
        .collect();
    let made = Command::new(env!("CARGO_BIN_EXE_plan")).args(words).current_dir(&root).status();
    assert!(made.expect("the program starts").success());
    let read = |path: &Path| std::fs::read_to_string(path).expect("a picture");
    assert!(read(&out) == read(&root.join("docs/plan.svg")), "docs/plan.svg is old: run the README's command again");
}

/// A full or closed standard output is reported, and input files are never overwritten.
#[cfg(unix)]
#[test]
fn outputs_lose_nothing() {
    use std::fs::File;
    use std::io::Read;
    use std::process::Stdio;
    let input = scratch("own.ron");
    std::fs::copy(case("two_views.ron"), &input).expect("the folder is ours");
    let (own, link) = (input.display().to_string(), scratch("own_link.ron"));
    let _ = std::fs::remove_file(&link);
    std::os::unix::fs::symlink("own.ron", &link).expect("the folder is ours");
    let (other, link) = (case("diamond.ron"), link.display().to_string());
    for args in [[&own, "--out", &own], [&own, "--out", &link], [&link, "--out", &own]] {
        let (code, _, error) = run(&args);
        assert!(code == Some(2) && error.contains("it is an input of this run"), "{args:?}: {error}");
    }
    let (code, _, error) = run(&[&other, "--diff", &own, "--out", &own]);
    assert!(code == Some(2) && error.contains("it is an input"), "{error}");
    assert_eq!(std::fs::read(&input).ok(), std::fs::read(case("two_views.ron")).ok());
    // A full device is an error. A closed pipe is not, because its reader needs no more.
    let full = File::options().write(true).open("/dev/full").expect("Linux has it");
    let output = Command::new(env!("CARGO_BIN_EXE_plan")).arg(&own).stdout(full).output().expect("the program starts");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!((output.status.code(), reported.lines().count()), (Some(2), 1), "{reported}");
    assert!(reported.starts_with("error: standard output: "), "{reported}");
    let mut child = Command::new(env!("CARGO_BIN_EXE_plan"));
    child.args([&own, "--budget", "steps=0"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = child.spawn().expect("the program starts");
    drop(child.stdout.take());
    let mut reported = String::new();
    child.stderr.take().expect("it is piped").read_to_string(&mut reported).expect("the words are UTF-8");
    assert_eq!(child.wait().expect("it ends").code(), Some(1), "{reported}");
    assert!(reported.starts_with("budget exceeded: steps") && !reported.contains("standard output"), "{reported}");
    // The output is equal through a device, and with the longest possible file name.
    let (_, printed, _) = run(&[&own]);
    let (code, through, _) = run(&[&own, "--out", "/dev/stdout"]);
    assert_eq!((code, &through), (Some(0), &printed));
    let long = scratch(&"n".repeat(255));
    let (code, _, error) = run(&[&own, "--out", &long.display().to_string()]);
    assert_eq!((code, error.as_str()), (Some(0), ""));
    assert_eq!(std::fs::read_to_string(&long).ok(), Some(printed));
}

#[test]
fn a_frame_of_standard_passes_is_planned_and_their_kinds_are_listed() {
    let (code, kinds, _) = run(&["--plugins"]);
    assert_eq!(code, Some(0));
    for line in [
        "fxaa  input: texture to read, output: texture to write",
        "color  depth: texture to read, shadow: texture to read (optional)",
    ] {
        assert!(kinds.contains(line), "{kinds}");
    }
    let file = scratch("standard.ron");
    let text = r#"(version: 1,
        resources: [Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep))],
        passes: [
            Plugin(kind: "prepass", name: "prepass", slots: {"output": "depth"}, params: 4),
            Plugin(kind: "color", name: "color", slots: {"depth": "depth", "output": "hdr"}, params: 4),
            Plugin(kind: "post", name: "post", slots: {"input": "hdr", "output": "screen"}),
        ])"#;
    std::fs::write(&file, text).expect("the file can be written");
    let path = file.display().to_string();
    let (code, plan, error) = run(&[&path]);
    assert!(
        code == Some(0) && plan.contains("pass post (inlined)") && plan.contains("pass color (merged: attachments)"),
        "{plan}{error}"
    );
    std::fs::write(&file, text.replace("\"fxaa\"", "\"x\"").replace("\"post\", name", "\"pots\", name"))
        .expect("again");
    let (code, _, error) = run(&[&path]);
    assert_eq!(code, Some(2));
    assert!(error.contains("unknown plugin `pots`; did you mean `post`?") && error.lines().count() == 1, "{error}");
}

#[test]
fn a_missing_export_is_a_warning() {
    let file = scratch("idle.ron");
    let text = r#"(version: 1, resources: [Texture(name: "a", format: R8Unorm)],
        passes: [Raster(name: "p", accesses: [Color(to: "a", intent: Overwrite)])])"#;
    std::fs::write(&file, text).expect("the file can be written");
    let (code, plan, error) = run(&[&file.display().to_string()]);
    assert_eq!(code, Some(0));
    assert!(
        plan.contains("warning: no pass runs") && error.contains("idle.ron: warning: no pass runs"),
        "{plan}{error}"
    );
}

#[test]
fn the_column_end_is_inclusive() {
    let file = scratch("ends.csv");
    std::fs::write(&file, "buffer,start,end,size\na,0,2,4\nb,3,8,4\n").expect("the file can be written");
    let (code, table, error) = run(&["--offsets", &file.display().to_string()]);
    assert_eq!((code, table.as_str()), (Some(0), "id,lower,upper,size,offset\na,0,3,4,0\nb,3,9,4,0\n"), "{error}");
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

/// Opening a pipe without a writer would block forever, so only regular files are opened.
#[cfg(unix)]
#[test]
fn nothing_but_regular_files_is_opened() {
    let pipe = scratch("pipe.ron");
    let _ = std::fs::remove_file(&pipe);
    assert!(Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()));
    let including = scratch("including.ron");
    std::fs::write(&including, "(version: 1, include: [\"pipe.ron\"])").expect("written");
    let (pipe, frame) = (pipe.display().to_string(), case("diamond.ron"));
    let (including, costs) = (including.display().to_string(), ["--queues", "one", "--costs", &pipe]);
    for args in [
        &[&*pipe][..],
        &[&including],
        &[&frame, "--diff", &pipe],
        &[&frame, "--caps", &pipe],
        &[&frame, costs[0], costs[1], costs[2], costs[3]],
        &["--offsets", &pipe],
        &["/dev/zero"],
    ] {
        let (code, text, error) = run(args);
        assert_eq!((code, text.as_str()), (Some(2), ""), "{args:?}");
        assert!(error.contains("cannot be read: it is not a regular file"), "{args:?}: {error}");
    }
}

#[cfg(unix)]
#[test]
fn a_signal_ends_planning() {
    let folder = scratch("signal");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("the folder is ours");
    let input = scratch("signal.ron");
    long_chain(&input);
    let mut command = Command::new(env!("CARGO_BIN_EXE_plan"));
    command.arg(&input).arg("--out").arg(folder.join("out.txt"));
    let mut child = command.stderr(std::process::Stdio::piped()).spawn().expect("the program starts");
    let parts = || std::fs::read_dir(&folder).expect("it is there").count();
    while parts() == 0 {
        assert!(matches!(child.try_wait(), Ok(None)), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()));
    assert_eq!(child.wait().expect("it ends").code(), Some(143));
    assert_eq!(parts(), 0);
}
