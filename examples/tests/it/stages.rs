//! Program `stages`: an inserted pass and a replaced stage.

use framegraph_scene::picture::read_rgba8;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output};

type TestResult = Result<(), Box<dyn std::error::Error>>;

/// Returns exit code, standard output and standard error.
fn run(folder: &Path, args: &[&str]) -> std::io::Result<(Option<i32>, String, String)> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stages"));
    let light = concat!(env!("CARGO_TARGET_TMPDIR"), "/light");
    command.env("NODEVICE_SELECT", "1").env("FRAMEGRAPH_LIGHT_CACHE", light).current_dir(folder).args(args);
    let Output { status, stdout, stderr } = command.output()?;
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Ok((status.code(), text(stdout), text(stderr)))
}

/// Mean of the color channels in a range of rows, 0…255.
fn mean(rgba: &[u8], width: usize, rows: std::ops::Range<usize>) -> f64 {
    let texels = rgba[4 * width * rows.start..4 * width * rows.end].chunks_exact(4);
    let (count, sum) =
        texels.fold((0, 0.0), |(n, sum), t| (n + 3, sum + t[..3].iter().map(|c| f64::from(*c)).sum::<f64>()));
    sum / f64::from(count)
}

#[test]
fn fog_is_inserted_and_the_edge_filter_replaced() -> TestResult {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("stages");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder)?;
    let (code, out, message) = run(&folder, &["foggy.png", "0.5"])?;
    if message.contains("no adapter") {
        test_report::skip("fog_is_inserted_and_the_edge_filter_replaced", message.trim());
        return Ok(());
    }
    assert_eq!(code, Some(0), "{message}");
    // The fog stage requests single-sampled depth. The replacement of `fxaa` writes the output.
    for line in ["pass depth_resolve", "pass fog", "pass sharpen", "color 0: output dont_care -> store"] {
        assert!(out.contains(line), "{line}: {out}");
    }
    assert!(!out.contains("pass fxaa"), "{out}");

    let ([width, height], foggy) = read_rgba8(&folder.join("foggy.png"))?;
    assert_eq!([width, height], [640, 360]);
    let (code, _, message) = run(&folder, &["clear.png", "0"])?;
    assert_eq!(code, Some(0), "{message}");
    let (_, clear) = read_rgba8(&folder.join("clear.png"))?;
    // Geometry below the sky fades toward the fog; the sky at the top is unchanged.
    let changed = |rows: std::ops::Range<usize>| {
        let (a, b) = (mean(&foggy, 640, rows.clone()), mean(&clear, 640, rows));
        (a - b).abs()
    };
    assert!(changed(0..4) < 0.1, "the sky differs by {} 8-bit steps", changed(0..4));
    assert!(changed(180..360) > 5.0, "the fog makes a difference of {} 8-bit steps", changed(180..360));
    Ok(())
}

#[test]
fn bad_input_is_one_line_and_exit_code_2() -> TestResult {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (args, named) in [
        (&[][..], "FILE.png: missing"),
        (&["a.jpg"], "a.jpg"),
        (&["a.png", "thick"], "DENSITY thick"),
        (&["a.png", "11"], "from 0 to 10"),
    ] {
        let (code, out, message) = run(folder, args)?;
        assert_eq!((code, out.as_str()), (Some(2), ""), "{args:?}: {message}");
        assert!(
            message.starts_with("error: ") && message.contains(named) && message.lines().count() == 1,
            "{args:?}: {message}"
        );
    }
    let (code, out, _) = run(folder, &["--help"])?;
    assert!(code == Some(0) && out.contains("DENSITY"), "{out}");
    Ok(())
}

/// If both streams are full, the exit code reports it and nothing panics.
#[cfg(unix)]
#[test]
fn a_full_standard_output_is_an_exit_code() {
    let full = || File::options().write(true).open("/dev/full").expect("Linux has it");
    let mut command = Command::new(env!("CARGO_BIN_EXE_stages"));
    let status = command.arg("--help").stdout(full()).stderr(full()).status();
    assert_eq!(status.expect("the program starts").code(), Some(2));
}
