//! `measure ibl-errors`: error and cost of image-based lighting on the default adapter.
//!
//! `cargo run --release -p tests --bin measure -- ibl-errors [SECTION…]` prints measured values next to the design's values.
//! Sections are `mirrors`, `harmonics`, `specular`, `dfg`, `furnace`, `frame`, `load`. Each section has a negative
//! control, an error made on purpose that its comparison must detect. The exit code is 1 if it does not.

mod sections;

use crate::{Outcome, adapter};

/// Prints the named sections, or all.
pub fn run(words: &[&str]) -> Outcome {
    if let Some(unknown) = words.iter().find(|a| !sections::ALL.iter().any(|(name, _)| name == *a)) {
        let known: Vec<&str> = sections::ALL.iter().map(|(name, _)| *name).collect();
        return Err(format!("no section is named {unknown}; use one of {}", known.join(", ")).into());
    }
    let gpu = adapter()?;
    let mut controls = true;
    for (name, section) in sections::ALL.iter().filter(|(name, _)| words.is_empty() || words.contains(name)) {
        let noticed = section(&gpu).map_err(|error| format!("{name}: {error}"))?;
        program::line(format_args!("control of {name}: {}", if noticed { "noticed" } else { "NOT NOTICED" }));
        controls &= noticed;
    }
    Ok(controls)
}
