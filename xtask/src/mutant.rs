//! Faults planted in sources one at a time, to see whether a test falls.
//!
//! [`plant`] finds the places, [`room`] says which files and which tests, [`run`] tries one after the other, [`explained`]
//! holds the faults that no test can see, and [`document`] prints what came of it.

pub mod document;
pub mod explained;
pub mod plant;
pub mod room;
pub mod run;
