//! Mutation testing: plants one fault at a time, and checks that a test fails.
//!
//! [`plant`] finds places for faults. [`room`] lists files and their tests. [`judge`] runs the tests, and [`run`] tries
//! all mutants on the threads of [`workers`]. [`kept`] stores results, [`explained`] lists faults that no test can
//! detect, and [`document`] prints the report.

pub mod document;
pub mod explained;
pub mod judge;
pub mod kept;
pub mod plant;
pub mod room;
pub mod run;
pub mod workers;
