//! Presets and budgets: groups of options with their measured time and error, and the sets that fit a time or an
//! error.
//!
//! [`GROUPS`] has the groups, each with its options from the cheapest to the finest. The frame with the finest option
//! of each group is the *reference*. [`Measured`] has the time of each option and the error of its picture against the
//! reference. [`Offers::within_ms`] and [`Offers::within_codes`] choose a set. [`settle()`] measures the choice and
//! corrects it. The caller draws, and reports times and errors. At run time, [`Controller`] chooses the level of each
//! frame from the times of earlier frames.
//!
//! This folder may use [`feature_culling`](crate::feature_culling), [`frame`](crate::frame) and every folder that
//! these use. No other folder uses it.

mod controller;
mod groups;
mod guaranteed;
mod measured;
pub mod preset;
mod select;
mod settle;

pub use controller::{Controller, percents};
pub use groups::{FrameOption, GROUPS, Group, reference};
pub use guaranteed::{Guaranteed, ROUNDING_STEPS, StepBound, bound, guaranteed, rounding_steps};
pub use measured::{Choices, Measured, MeasuredError, MeasuredGroup, MeasuredOption, MeasuredPair, MeasuredShare};
pub use select::{Chosen, Offer, Offers, Pair};
pub use settle::{Bound, Settled, Trial, settle};
