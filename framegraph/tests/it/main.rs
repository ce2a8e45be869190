//! Integration tests of the compiler with small graphs. Comments derive the plans by hand.

mod barriers;
mod brute_force;
mod buffers;
mod check;
mod counts;
mod culling;
mod decisions;
mod declaring;
mod device;
mod diff;
mod dump;
mod errors;
mod features;
mod filament_ideas;
mod file;
mod inlining;
mod merging;
mod ops;
mod ordering;
mod padding;
mod properties;
mod sharing;
mod support;
mod totals;
mod viewed;
