//! `occlusion`: what ambient occlusion costs in accuracy and time, on the adapter that there is.
//!
//! `cargo run --release -p tests --bin occlusion` prints the tables of `docs/occlusion.md`. Times are the least of several
//! frames with nothing in them but the structure's levels, ambient occlusion and its blur; they say what this device takes,
//! and nothing of another.

mod tables;

use framegraph_wgpu::{AdapterRequest, Gpu};
use std::error::Error;
use std::process::ExitCode;

fn main() -> ExitCode {
    program::ended("occlusion", run())
}

fn run() -> Result<(), Box<dyn Error>> {
    program::no_arguments()?;
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    program::line(format_args!("adapter: {}", gpu.describe()));
    tables::open_ground(&gpu)?;
    tables::corner(&gpu)?;
    tables::taps(&gpu)?;
    tables::methods(&gpu)
}
