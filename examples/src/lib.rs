//! Command-line programs: render, plan and small teaching examples.

#[path = "../custom_pass/mod.rs"]
pub mod custom_pass;
#[path = "../stages/mod.rs"]
pub mod stages;
