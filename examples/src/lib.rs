//! Command-line programs: render, plan and small teaching examples.
