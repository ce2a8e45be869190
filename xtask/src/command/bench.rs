//! `cargo xtask bench`: measures compilation, beside a peer, and the CPU time of execution.

use super::{Command, frames};
use crate::options::Options;
use crate::{Failure, stage, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "bench",
    summary: "measure the compiler, also beside a peer of the registry, and the back end",
    details: "\
Stages:
  compile  time per declared pass on the graphs that peers were measured on, and
           instructions if valgrind is installed; heap aliasing; memory
  peers    the same chain compiled by framegraph and by zenfg 0.2, in one process
  execute  CPU time of a frame on wgpu's noop device, which validates but does
           not draw, so that no driver is measured
  overhead cost of executing a plan, compared to the same wgpu calls by hand, in
           time, and in instructions if valgrind is installed
  scenes   frames of 10,000 to 1,000,000 nodes on the noop device; culling

Each stage prints a section of docs/measurements/performance.md. The peer needs a newer
compiler than the workspace and is built with --ignore-rust-version. The command
checks no limits, since times depend on the machine and its load.

With --frames, measures whole frames instead: each preset over six built-in
scenes at 1280x720 and 1920x1080, with default options, with a depth prepass, and
without culling, merging, inlining and aliasing. This takes hours on a software
driver. Options select a part:
  --scene NAME      one scene: a built-in one, or a file
  --preset NAME     one preset
  --size WxH        one size
  --rounds N        alternating runs per variant (3)
  --with ARGS       additional arguments for `render`, separated by spaces; the
                    default is `--frames 6`, whose median counts
  --beside COMMAND  also run a command of another renderer; its time is the last
                    number before `ms` in its output. {scene}, {size} and {preset}
                    are replaced. The last column is our time divided by its time
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    if options.has("--frames") {
        return frames::run(options);
    }
    let own = ["--scene", "--preset", "--size", "--beside", "--with", "--rounds"];
    if let Some(name) = own.into_iter().find(|name| options.has(name)) {
        return Err(Failure::Usage(format!("`{name}` needs `--frames`")));
    }
    let compile = stage::run("compile", &mut workspace::cargo(&["bench", "--quiet", "--package", "framegraph"]));
    let peers = ["run", "--quiet", "--profile", "bench", "--ignore-rust-version", "-p", "peers", "-F", "peer"];
    let peers = stage::run("peers", &mut workspace::cargo(&peers));
    let frames = ["--size", "1280x720", "--frames", "250", "--timing", "--out", "target/bench.png"];
    let mut render =
        workspace::cargo(&["run", "--quiet", "--release", "--package", "examples", "--bin", "render", "--"]);
    let execute = stage::run("execute", render.args(frames).env("WGPU_BACKEND", "noop"));
    // Builds optimized, as a shipped program, but without link-time optimization, which would take minutes.
    let of = |package: &str, bench: &'static str| {
        let arguments = ["bench", "--quiet", "--profile", "release", "--package", package, "--bench", bench];
        stage::run(bench, &mut workspace::cargo(&arguments))
    };
    let overhead = of("framegraph-wgpu", "overhead");
    let scenes = of("framegraph-passes", "scenes");
    for outcome in [compile, peers, execute, overhead, scenes] {
        outcome.result.map_err(|reason| Failure::Failed(format!("{}: {reason}", outcome.name)))?;
    }
    Ok(())
}
