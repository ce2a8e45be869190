//! `taa`: error and ghosting of temporal anti-aliasing on the default adapter.
//!
//! `cargo run --release -p tests --bin taa` prints the table of `docs/design/taa.md`.

use framegraph_wgpu::{AdapterRequest, Gpu};
use std::error::Error;
use std::process::ExitCode;
use tests::measure::temporal::table;

fn main() -> ExitCode {
    program::ended("taa", run())
}

fn run() -> Result<(), Box<dyn Error>> {
    program::no_arguments()?;
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    program::line(format_args!("adapter: {}\n", gpu.describe()));
    table(&gpu)?.iter().for_each(program::line);
    Ok(())
}
