//! `measure taa`: error and ghosting of temporal anti-aliasing on the default adapter.
//!
//! `cargo run --release -p tests --bin measure -- taa` prints the table of `docs/design/taa.md`.

use crate::{Outcome, adapter, no_words};
use tests::measure::temporal::table;

/// Prints the table.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    table(&adapter()?)?.iter().for_each(program::line);
    Ok(true)
}
