//! The frame within a budget: which choices it has, what their options were measured to take and to err by, and the set of
//! options that fits a time or an error.
//!
//! [`GROUPS`] are the choices, each with its options from the cheapest to the finest; the frame with the finest of each is the
//! *reference*. [`Measured`] says what each option takes and how far its picture is from the reference's.
//! [`Offers::within_ms`] and [`Offers::within_codes`] choose, [`settle()`] tries what was chosen and learns from how it
//! turned out, and [`FrameRate`] goes up and down between chosen sets while an application runs. Nothing here draws:
//! the caller does, and tells times and errors.

mod groups;
mod measured;
mod rate;
mod select;
mod settle;

pub use groups::{FrameOption, GROUPS, Group, reference};
pub use measured::{Choices, Measured, MeasuredError, MeasuredGroup, MeasuredOption, MeasuredPair};
pub use rate::FrameRate;
pub use select::{Chosen, Offer, Offers, Pair};
pub use settle::{Bound, Settled, Trial, settle};
