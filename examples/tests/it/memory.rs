//! What a run holds does not grow with its frames.
//!
//! Drivers compile shaders anew for values of uniforms that bound loops. Mesa 22.3's software driver does so in every frame for
//! loops that a uniform ends, and for whole numbers and flags beside what lies first in a uniform block, and keeps each: with
//! such shaders a frame of 32×32 pixels took several MiB more than the one before. Bounds of loops are therefore `override`
//! constants, and what fragments are shaded with does not lie first.

use crate::support::{command, folder};
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

/// The most that the process held in memory, in KiB, as the system says it while it runs; none where it does not say.
fn peak_kib(folder: &Path, frames: &str, options: &str) -> Option<u64> {
    let mut run = command(folder);
    run.args(["columns", "--size", "32x32", "--frames", frames]).args(options.split(' '));
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

/// 25 frames more take no 12 MiB more: those that compiled a shader in each took 20 MiB at least.
#[test]
fn memory_does_not_grow_with_frames() {
    let folder = folder("memory");
    let told = command(&folder).args(["--size", "16x8"]).output().expect("the program starts");
    if String::from_utf8_lossy(&told.stderr).contains("no adapter") {
        return test_report::skip("memory_does_not_grow_with_frames", "no adapter");
    }
    for options in [
        "--preset medium --shadows evsm --shadow texels=256,blur=9 --dof on:focus=3,resolution=full",
        "--preset ultra --shadow texels=256,contact=on --fog on --bloom on:flare=on --dof on:focus=3 --taa on",
    ] {
        let [few, many] = ["8", "33"].map(|frames| peak_kib(&folder, frames, options));
        let (Some(few), Some(many)) = (few, many) else {
            return test_report::skip(
                "memory_does_not_grow_with_frames",
                "this system does not say what a process holds",
            );
        };
        assert!(many < few + (12 << 10), "{options}: {few} KiB after 8 frames, {many} KiB after 33");
    }
}
