//! The commands, one per file.

mod bench;
mod bevy;
mod circles;
mod corpus;
mod demo;
mod frames;
mod gallery;
mod mutants;
mod package;
mod prose;
mod prove;
mod rooms;
mod test;

use crate::Failure;
use crate::options::Options;

/// One command of `cargo xtask`.
#[derive(Debug)]
pub struct Command {
    /// Name on the command line, after `cargo xtask`.
    pub name: &'static str,
    /// One-line summary for the list of commands.
    pub summary: &'static str,
    /// Full description for `cargo xtask NAME --help`.
    pub details: &'static str,
    /// Runs the command.
    pub run: fn(&Options) -> Result<(), Failure>,
}

/// Every command, in the order of the help text.
pub const ALL: &[Command] = &[
    demo::COMMAND,
    test::COMMAND,
    mutants::COMMAND,
    bench::COMMAND,
    prove::COMMAND,
    gallery::COMMAND,
    circles::COMMAND,
    prose::COMMAND,
    rooms::COMMAND,
    corpus::COMMAND,
    package::COMMAND,
    bevy::COMMAND,
];
