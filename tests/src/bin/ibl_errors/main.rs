//! `ibl_errors`: error and cost of image-based lighting on the default adapter.
//!
//! `cargo run --release -p tests --bin ibl_errors [-- SECTION…]` prints measured values next to the design's values.
//! Sections are `mirrors`, `harmonics`, `specular`, `dfg`, `furnace`, `frame`, `load`. Each section has a negative
//! control, an error made on purpose that its comparison must detect. The exit code is 1 if it does not.

mod sections;

use framegraph_wgpu::{AdapterRequest, Gpu};
use std::process::ExitCode;

fn main() -> ExitCode {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    if let Some(unknown) = asked.iter().find(|a| !sections::ALL.iter().any(|(name, _)| name == a)) {
        let known: Vec<&str> = sections::ALL.iter().map(|(name, _)| *name).collect();
        program::note(format_args!("ibl_errors: no section is named {unknown:?}; there are {}", known.join(", ")));
        return program::exit(1);
    }
    let gpu = match Gpu::open(&AdapterRequest::from_env()) {
        Ok(gpu) => gpu,
        Err(error) => {
            program::note(format_args!("ibl_errors: {error}"));
            return program::exit(1);
        }
    };
    program::line(format_args!("adapter: {}", gpu.describe()));
    let mut controls = true;
    for (name, section) in sections::ALL.iter().filter(|(name, _)| asked.is_empty() || asked.iter().any(|a| a == name))
    {
        match section(&gpu) {
            Ok(noticed) => {
                program::line(format_args!("control of {name}: {}", if noticed { "noticed" } else { "NOT NOTICED" }));
                controls &= noticed;
            }
            Err(error) => {
                program::note(format_args!("ibl_errors: {name}: {error}"));
                controls = false;
            }
        }
    }
    program::exit(u8::from(!controls))
}
