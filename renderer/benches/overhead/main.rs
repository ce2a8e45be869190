//! Overhead of executing a plan compared to hand-written wgpu calls: time, and instruction counts.
//!
//! Runs on wgpu's noop device. With `--count WHO PASSES DRAWS FRAMES` it only runs frames, for a profiler that counts
//! instructions. The hand-written code and the executor take no time measurements; `timed` is an executor that measures
//! its steps.

mod by_hand;
mod executed;
mod shared;
mod threads;

use by_hand::ByHand;
use executed::Executed;
use framegraph_wgpu::Gpu;
use shared::Case;
use std::error::Error;
use std::process::{Command, ExitCode};
use std::time::Instant;

const CASES: [Case; 3] = [Case { passes: 5, draws: 1 }, Case { passes: 50, draws: 1 }, Case { passes: 50, draws: 100 }];
const WARM_UP: usize = 10;

fn main() -> ExitCode {
    program::ended("overhead", run())
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    if let [count, who, passes, draws, frames] = arguments.as_slice()
        && count == "--count"
    {
        let case = Case { passes: passes.parse()?, draws: draws.parse()? };
        return run_counted(who, case, frames.parse()?);
    }
    program::line("### Over wgpu\n");
    program::line(
        "| passes × draws | by hand, µs | executed, µs | ratio | by hand, instr. | executed, instr. | ratio | timed, instr. | ratio |",
    );
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for case in CASES {
        let (hand, own) = side_by_side(case)?;
        let counts = ["hand", "executor", "timed"].map(|who| instructions(who, case));
        let counted = match counts {
            [Ok(hand), Ok(own), Ok(timed)] => {
                format!("{hand:.0} | {own:.0} | {:.2} | {timed:.0} | {:.2}", own / hand, timed / hand)
            }
            [Err(why), ..] | [_, Err(why), _] | [.., Err(why)] => format!("{why} | | | |"),
        };
        let Case { passes, draws } = case;
        program::line(format_args!("| {passes} × {draws} | {hand:.1} | {own:.1} | {:.2} | {counted} |", own / hand));
    }
    program::line("");
    threads::print()
}

/// Returns the median times of alternating frames, in µs.
fn side_by_side(case: Case) -> Result<(f64, f64), Box<dyn Error>> {
    let gpu = Gpu::noop()?;
    let (mut hand, mut own) = (ByHand::new(&gpu, case), Executed::new(&gpu, case, false)?);
    let (mut of_hand, mut of_own) = (Vec::new(), Vec::new());
    for frame in 0..400 + WARM_UP {
        let start = Instant::now();
        hand.frame()?;
        let middle = Instant::now();
        own.frame()?;
        if frame >= WARM_UP {
            of_hand.push((middle - start).as_secs_f64());
            of_own.push(middle.elapsed().as_secs_f64());
        }
    }
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        1e6 * times[times.len() / 2]
    };
    Ok((median(&mut of_hand), median(&mut of_own)))
}

fn run_counted(who: &str, case: Case, frames: usize) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::noop()?;
    if who == "hand" {
        let mut hand = ByHand::new(&gpu, case);
        (0..WARM_UP).try_for_each(|_| hand.frame())?;
        (0..frames).try_for_each(|_| counted_hand(&mut hand))
    } else {
        let mut own = Executed::new(&gpu, case, who == "timed")?;
        (0..WARM_UP).try_for_each(|_| own.frame())?;
        (0..frames).try_for_each(|_| counted_executor(&mut own))
    }
}

// Callgrind counts the instructions inside of functions with these names.

#[inline(never)]
fn counted_hand(hand: &mut ByHand) -> Result<(), Box<dyn Error>> {
    hand.frame()
}

#[inline(never)]
fn counted_executor(own: &mut Executed) -> Result<(), Box<dyn Error>> {
    own.frame()
}

/// Returns the number of instructions of a warm frame.
fn instructions(who: &str, case: Case) -> Result<f64, String> {
    const FRAMES: usize = 20;
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg(format!("--toggle-collect=*counted_{}*", if who == "hand" { who } else { "executor" }))
        .arg(program)
        .args(["--count", who, &case.passes.to_string(), &case.draws.to_string(), &FRAMES.to_string()])
        .output()
        .map_err(|_| "valgrind cannot be started".to_owned())?;
    let text = String::from_utf8_lossy(&output.stderr);
    let counted = text.lines().find_map(|line| line.split("Collected :").nth(1)?.trim().parse::<f64>().ok());
    counted
        .filter(|count| *count > 0.0)
        .map(|count| count / FRAMES as f64)
        .ok_or_else(|| "nothing was counted".to_owned())
}
