//! Memory use of a run is independent of its number of frames.
//!
//! Drivers may recompile shaders for new values of uniforms that bound loops. Mesa 22.3's software driver does so in every
//! frame for loops that end at a uniform. It also recompiles for integers and flags after the first field of a uniform
//! block, and keeps every variant: frames of 32×32 pixels then grew by several MiB each. Loop bounds are therefore
//! `override` constants, and shading parameters never come first.

use crate::support::{CORNERS, TRIANGLE, UP, command, folder, refusal, triangle, undrawn};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Returns the peak memory of a process that draws some frames.
fn peak_of_frames_kib(folder: &Path, frames: &str, options: &str) -> Option<u64> {
    let mut run = command(folder);
    run.args(["columns", "--size", "32x32", "--frames", frames]).args(options.split(' '));
    peak_kib(run, options)
}

/// Returns the peak memory of a process in KiB while it runs; `None` if the system does not report it.
fn peak_kib(mut run: Command, options: &str) -> Option<u64> {
    let mut run = run.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts");
    let status = format!("/proc/{}/status", run.id());
    let mut peak = None;
    loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        peak = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).or(peak);
        if let Some(code) = run.try_wait().expect("it can be waited for") {
            assert!(code.success(), "{options}: {code}");
            return peak;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Limit of 12 MiB for 25 additional frames: recompiling a shader per frame took at least 20 MiB.
#[test]
fn memory_does_not_grow_with_frames() {
    let folder = folder("memory");
    let message = command(&folder).args(["--size", "16x8"]).output().expect("the program starts");
    if String::from_utf8_lossy(&message.stderr).contains("no adapter") {
        return test_report::skip("memory_does_not_grow_with_frames", "no adapter");
    }
    // Effects with images and shaders of their own, all at once.
    let options = "--preset ultra --shadows evsm --shadow map-size=256,blur=9,contact=on --fog on --bloom on:flare=on \
                   --dof on:focus=3,resolution=full --taa on";
    let [few, many] = ["8", "33"].map(|frames| peak_of_frames_kib(&folder, frames, options));
    let (Some(few), Some(many)) = (few, many) else {
        return test_report::skip("memory_does_not_grow_with_frames", "this system does not say what a process holds");
    };
    assert!(many < few + (12 << 10), "{few} KiB after 8 frames, {many} KiB after 33");
}

/// A picture used 16 times is decoded once, within the memory budget: 16 MiB of texels, and 48 MiB for mip levels and
/// upload. One copy per use would take 256 MiB.
#[test]
fn one_picture_takes_its_budget_however_often_it_is_used() {
    const BUDGET_MIB: u64 = 80;
    let folder = folder("uses");
    let list = |entry: &dyn Fn(usize) -> String| (0..16).map(entry).collect::<Vec<_>>().join(", ");
    let textured = format!(
        r#""materials": [{}], "textures": [{}], "images": [{}], "accessors""#,
        list(&|i| format!(r#"{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": {i}}}}}}}"#)),
        list(&|i| format!(r#"{{"source": {i}}}"#)),
        list(&|_| r#"{"uri": "large.png"}"#.to_owned()),
    );
    let part = r#"{"attributes": {"POSITION": 0, "NORMAL": 1}"#;
    let parts = list(&|i| format!(r#"{part}, "material": {i}}}"#));
    let text = TRIANGLE.replace("\"accessors\"", &textured).replace(&format!("{part}}}"), &parts);
    let picture = image::GrayImage::from_pixel(2048, 2048, image::Luma([90]));
    picture.save(folder.join("large.png")).expect("the folder can be written");
    let peak = |text: &str, options: &[&str]| {
        triangle(&folder, text, CORNERS, UP);
        let mut run = undrawn(&folder, &["t.gltf", "--frames", "1", "--memory", &format!("{BUDGET_MIB}MiB")]);
        run.args(options);
        peak_kib(run, "t.gltf")
    };
    let plain = peak(TRIANGLE, &[]);
    for (text, options) in [(text.as_str(), &[][..]), (TRIANGLE, &["--dirt", "large.png", "--bloom", "on"])] {
        let (Some(plain), Some(many)) = (plain, peak(text, options)) else {
            let test = "one_picture_takes_its_budget_however_often_it_is_used";
            return test_report::skip(test, "this system does not say what a process holds");
        };
        assert!(many < plain + (BUDGET_MIB << 10), "{options:?}: {many} KiB, without the picture {plain} KiB");
        assert!(many > plain + (8 << 10), "the picture is not in it: {many} KiB, without {plain} KiB");
    }
    // A picture that exceeds the budget is rejected.
    for (text, options) in
        [(text.as_str(), &["t.gltf"][..]), (TRIANGLE, &["t.gltf", "--dirt", "large.png", "--bloom", "on"])]
    {
        triangle(&folder, text, CORNERS, UP);
        let line = refusal(&folder, undrawn(&folder, options).args(["--memory", "20MiB"]));
        assert!(line.contains("large.png") && line.contains("2048×2048") && line.contains("--memory"), "{line}");
    }
}
