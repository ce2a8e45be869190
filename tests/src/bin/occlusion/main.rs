//! `occlusion`: error and cost of ambient occlusion on the default adapter.
//!
//! `cargo run --release -p tests --bin occlusion` prints the tables of `docs/design/occlusion.md`. Each time is the minimum of
//! several frames that only contain the structure's levels, ambient occlusion and its blur. Times are valid for this
//! device only.

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
