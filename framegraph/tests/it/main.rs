//! The compiler seen from outside: small graphs whose plans are worked out by hand in the comments.

mod barriers;
mod brute_force;
mod buffers;
mod check;
mod counts;
mod culling;
mod decisions;
mod declaring;
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
