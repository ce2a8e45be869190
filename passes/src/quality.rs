//! The frame within a budget: which choices it has, what their options were measured to take and to err by, and the set of
//! options that fits a time or an error.
//!
//! [`GROUPS`] are the choices, each with its options from the cheapest to the finest; the frame with the finest of each is the
//! *reference*. [`Measured`] says what each option takes and how far its picture is from the reference's.
//! [`Offers::within_ms`] and [`Offers::within_codes`] choose, and [`settle()`] tries what was chosen and learns from how it
//! turned out. Nothing here draws: the caller does, and reports times and errors.

mod groups;
mod measured;
pub mod preset;
mod select;
mod settle;

pub use groups::{FrameOption, GROUPS, Group, reference};
pub use measured::{Choices, Measured, MeasuredError, MeasuredGroup, MeasuredOption, MeasuredPair};
pub use select::{Chosen, Offer, Offers, Pair};
pub use settle::{Bound, Settled, Trial, settle};
