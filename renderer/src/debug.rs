//! Finding faults of passes and plans: switches to bisect with, and loud contents where nothing was written.

mod modes;
pub(crate) mod poison;

pub use modes::{Mode, Modes, ModesError, Outcome, bisect};
