//! `measure`: prints the tables of measured values in `docs/`, one subcommand for each.
//!
//! Exit codes: 0 success, 1 a check or its negative control failed, 2 wrong arguments or an error.

mod bounds;
mod controller;
mod facts;
mod grading;
mod hard_cases;
mod ibl_errors;
mod lights;
mod memory;
mod occlusion;
mod prediction;
mod reflections;
mod shading_errors;
mod soak;
mod taa;
mod temporal;

use framegraph_wgpu::{AdapterRequest, Gpu};
use std::error::Error;
use std::process::ExitCode;

/// `false` if a check of the measured values failed.
type Outcome = Result<bool, Box<dyn Error>>;

/// A subcommand: its name, a summary, and its function of the remaining arguments.
type Subcommand = (&'static str, &'static str, fn(&[&str]) -> Outcome);

const SUBCOMMANDS: [Subcommand; 15] = [
    ("bounds", "adversarial search for scenes that break a proved bound of an option", bounds::run),
    ("controller", "traces of the frame-time controller, simulated and on the default adapter", controller::run),
    ("facts", "effects that feature culling drops from six scenes under four presets, and the time saved", facts::run),
    ("grading", "error of color grading tables against the exact functions", grading::run),
    (
        "hard-cases",
        "tests of hard inputs, and the test case that needs each guard of the shader library",
        hard_cases::run,
    ),
    ("ibl-errors", "error and cost of image-based lighting on the default adapter", ibl_errors::run),
    ("lights", "cost of many lights with froxels and with a loop over all lights, on the default adapter", lights::run),
    ("memory", "bytes that the device allocates for the standard frame under each aliasing mode", memory::run),
    ("occlusion", "error and cost of ambient occlusion on the default adapter", occlusion::run),
    ("prediction", "times and errors of options, predicted on scenes that were not measured", prediction::run),
    ("reflections", "accuracy of screen-space reflections on the default adapter", reflections::run),
    ("shading-errors", "error of half floats in the shading library on the default adapter", shading_errors::run),
    ("soak", "long-running test of the standard frame with changing window size, effects and scene", soak::run),
    ("taa", "error and ghosting of temporal anti-aliasing on the default adapter", taa::run),
    ("temporal", "flicker, ghosting and popping of options while the camera moves", temporal::run),
];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = args.iter().map(String::as_str).collect();
    match run(&words) {
        Ok(true) => program::exit(0),
        Ok(false) => program::exit(1),
        Err(error) => {
            program::error(format_args!("measure: {error}"));
            program::exit(2)
        }
    }
}

fn run(words: &[&str]) -> Outcome {
    let Some((&name, rest)) = words.split_first().filter(|(name, _)| **name != "--help") else {
        program::line("Prints tables of measured values.\n\nusage: measure SUBCOMMAND [arguments]\n");
        SUBCOMMANDS.iter().for_each(|(name, summary, _)| program::line(format_args!("  {name:<15} {summary}")));
        return Ok(!words.is_empty());
    };
    let Some((.., run)) = SUBCOMMANDS.iter().find(|(known, ..)| *known == name) else {
        return Err(format!(
            "{name} is not a subcommand; use one of {}",
            SUBCOMMANDS.map(|(name, ..)| name).join(", ")
        )
        .into());
    };
    run(rest).map_err(|error| format!("{name}: {error}").into())
}

/// Opens the default adapter and prints its name.
fn adapter() -> Result<Gpu, Box<dyn Error>> {
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    program::line(format_args!("Adapter: {}\n", gpu.describe()));
    Ok(gpu)
}

/// Fails if a subcommand without arguments has some.
fn no_words(words: &[&str]) -> Result<(), String> {
    if words.is_empty() { Ok(()) } else { Err(format!("{}: this subcommand has no arguments", words.join(" "))) }
}
