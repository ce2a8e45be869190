//! `cargo xtask bench`: what compiling costs, beside a peer, and what executing costs the CPU.

use super::{Command, frames};
use crate::options::Options;
use crate::{Failure, stage, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "bench",
    summary: "measure the compiler, also beside a peer of the registry, and the back end",
    details: "\
Stages:
  compile  nanoseconds and, where valgrind is installed, instructions a declared
           pass on the graphs that peers were measured on; heap aliasing; memory
  peers    the same chain compiled by framegraph and by zenfg 0.2, in one process
  execute  the CPU's part of a frame, on wgpu's device that validates and draws
           nothing, so that no driver is measured
  overhead what executing adds to the same calls of wgpu made by hand, in time and,
           where valgrind is installed, in instructions
  scenes   frames of 10,000 to 1,000,000 nodes on the same device; culling

All print sections in Markdown, of which docs/performance.md is made. The peer
asks for a newer compiler than the workspace and is built with
--ignore-rust-version. Nothing is asserted: times depend on the machine and on
what else it does.

With --frames instead, whole frames: each preset over six built-in scenes at
1280x720 and 1920x1080, as it is, with a depth prepass, and without dropping,
merging, inlining and aliasing. Hours on a software driver; less of it by
  --scene NAME      one scene: a built-in one, or a file
  --preset NAME     one preset
  --size WxH        one size
  --rounds N        runs of each, in turns (3)
  --with ARGS       more arguments for `render`, with spaces between; of six
                    frames each the median, unless `--frames N` is among them
  --beside COMMAND  in turns with a command of another renderer, of whose output
                    the last number before `ms` is its time; in it {scene}, {size}
                    and {preset} are those of the row. The last column is what our
                    frame takes of that
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    if options.has("--frames") {
        return frames::run(options);
    }
    let own = ["--scene", "--preset", "--size", "--beside", "--with", "--rounds"];
    if let Some(name) = own.into_iter().find(|name| options.has(name)) {
        return Err(Failure::Usage(format!("`{name}` goes together with `--frames` only")));
    }
    let compile = stage::run("compile", &mut workspace::cargo(&["bench", "--quiet", "--package", "framegraph"]));
    let peers = ["run", "--quiet", "--profile", "bench", "--ignore-rust-version", "-p", "peers", "-F", "peer"];
    let peers = stage::run("peers", &mut workspace::cargo(&peers));
    let frames = ["--size", "1280x720", "--frames", "250", "--timing", "--out", "target/bench.png"];
    let mut render =
        workspace::cargo(&["run", "--quiet", "--release", "--package", "examples", "--bin", "render", "--"]);
    let execute = stage::run("execute", render.args(frames).env("WGPU_BACKEND", "noop"));
    // As a program that ships them: optimized, and not linked as a whole, which would take minutes.
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
