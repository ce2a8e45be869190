//! Debugging of passes and plans: modes that turn off optimizations, and poisoning of undefined contents.

mod modes;
pub(crate) mod poison;

pub use modes::{Mode, Modes, ModesError, Outcome, bisect};
