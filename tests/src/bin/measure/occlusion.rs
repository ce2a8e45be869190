//! `measure occlusion`: error and cost of ambient occlusion on the default adapter.
//!
//! `cargo run --release -p tests --bin measure -- occlusion` prints the tables of `docs/design/occlusion.md`. Each time is the minimum of
//! several frames that only contain the structure's levels, ambient occlusion and its blur. Times are valid for this
//! device only.

mod tables;

use crate::{Outcome, adapter, no_words};

/// Prints the tables.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    let gpu = adapter()?;
    tables::open_ground(&gpu)?;
    tables::corner(&gpu)?;
    tables::taps(&gpu)?;
    tables::methods(&gpu)?;
    Ok(true)
}
