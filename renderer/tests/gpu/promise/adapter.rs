//! The differential test on the real adapter, in child processes.

use super::case::{SIDE, small, target};
use super::generate::{BUDGET_BYTES, cases};
use super::{Bench, Outcome, Tally};
use crate::bench::{TestResult, on_adapter};
use framegraph::{ClearValue, Format, Intent, Options, Plan, Scratch, compile};
use framegraph_wgpu::{AdapterRequest, Executor, Frame, Gpu, mock};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;

/// Environment variable with the first case of a child and the distance to the next.
const SHARE: &str = "PROMISE_CASES";

/// Longest time that one case may take.
const PATIENCE: Duration = Duration::from_secs(30);

/// Prefix of the lines that a child prints for each case.
const MARK: &str = "CASE";

/// Runs the cases of a child process; does nothing in a normal run.
#[test]
fn child() -> TestResult {
    let Ok(share) = std::env::var(SHARE) else { return Ok(()) };
    let (first, step) = share.split_once('/').ok_or("no step")?;
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    let all = cases(&gpu.caps(), BUDGET_BYTES);
    let mut bench = Bench::new(&gpu, gpu.caps());
    for (at, case) in all.iter().enumerate().skip(first.parse()?).step_by(step.parse()?) {
        println!("{MARK} {at} begins");
        let (outcome, why) = bench.outcome(case);
        println!("{MARK} {at} {outcome:?} {}", why.replace('\n', " "));
    }
    println!("{MARK} done");
    Ok(())
}

/// Kills a child that is dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts a child at a case, and returns its lines.
fn start(first: usize, step: usize) -> Result<(Running, mpsc::Receiver<String>), Box<dyn std::error::Error>> {
    let mut child = Command::new(std::env::current_exe()?)
        .args(["--exact", "promise::adapter::child", "--nocapture"])
        .env(SHARE, format!("{first}/{step}"))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let lines = BufReader::new(child.stdout.take().ok_or("no output")?).lines();
    let (send, receive) = mpsc::channel();
    std::thread::spawn(move || {
        for line in lines.map_while(Result::ok).filter(|line| line.starts_with(MARK)) {
            if send.send(line).is_err() {
                break;
            }
        }
    });
    Ok((Running(child), receive))
}

#[test]
fn plans_for_the_adapter_are_executed() -> TestResult {
    on_adapter("plans_for_the_adapter_are_executed", |gpu| {
        let all = cases(&gpu.caps(), BUDGET_BYTES);
        // A prime, so that every kind of access, shape and sample count is met.
        let step = if test_report::is_all() { 1 } else { 17 };
        let (mut tally, mut next, mut lost) = (Tally::default(), 0, Vec::new());
        'children: while next < all.len() {
            let (child, lines) = start(next, step)?;
            let mut current = next;
            loop {
                let Ok(line) = lines.recv_timeout(PATIENCE) else {
                    lost.push(format!("{}: {}", all[current].kind, all[current].name));
                    next = current + step;
                    drop(child);
                    continue 'children;
                };
                let mut words = line.splitn(4, ' ').skip(1);
                let (at, what) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
                if at == "done" {
                    break 'children;
                }
                current = at.parse()?;
                let outcome = match what {
                    "Executed" => Outcome::Executed,
                    "Refused" => Outcome::Refused,
                    "Invalid" => Outcome::Invalid,
                    "Broken" => Outcome::Broken,
                    "Strict" => Outcome::Strict,
                    _ => continue,
                };
                tally.add(&all[current], outcome, words.next().unwrap_or_default());
            }
        }
        tally.finish(&gpu.describe());
        assert!(lost.is_empty(), "the driver hangs or crashes in {lost:?}");
        Ok(())
    })
}

/// A pass with as many sampled textures as WebGPU allows, or a few more. Mesa unrolls loops of a single iteration; with
/// a loop over levels and layers for each texture, its compiler took minutes for 16 textures.
#[test]
fn mock_recorders_sample_many_textures() -> TestResult {
    on_adapter("mock_recorders_sample_many_textures", |gpu| {
        let count = gpu.caps().max_sampled_textures.min(20);
        let mut frame = Frame::<()>::new();
        let graph = frame.graph_mut();
        let textures: Vec<_> = (0..count).map(|n| graph.texture(&format!("t{n}"), small(Format::Rgba8Unorm))).collect();
        let mut drawn = Vec::new();
        for texture in textures {
            drawn.push(graph.add_fn("draw", |pass| pass.color(texture, Intent::Clear(ClearValue::BLACK)))?);
        }
        graph.add_fn("look", |pass| {
            pass.side_effect();
            drawn.iter().try_for_each(|texture| pass.sampled(*texture).map(drop))?;
            target(pass)
        })?;
        mock::add_recorders(&mut frame);
        let (mut plan, options) = (Plan::new(), Options::for_frame(SIDE, SIDE));
        compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        Executor::new(gpu).execute(&plan, &frame, &(), &mock::imports(gpu, &plan)?.bound)?;
        gpu.wait()?;
        Ok(())
    })
}
