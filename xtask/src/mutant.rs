//! Faults planted in sources one at a time, to see whether a test falls.
//!
//! [`plant`] finds the places, [`room`] says which files and which tests, [`judge`] asks
//! the tests, [`run`] tries one after the other on threads that [`workers`] starts, [`kept`] keeps
//! what came of it, [`explained`] holds the faults that no test can see, and [`document`] prints all that.

pub mod document;
pub mod explained;
pub mod judge;
pub mod kept;
pub mod plant;
pub mod room;
pub mod run;
pub mod workers;
