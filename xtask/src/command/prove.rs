//! `cargo xtask prove`: prints docs/measurements/proofs.md, the evidence for what the compiler claims.

use super::Command;
use crate::options::Options;
use crate::{Failure, stage, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "prove",
    summary: "print docs/measurements/proofs.md",
    details: "\
Prints the document: memory compared to its lower bound and to brute force, an
independent checker on random graphs, and mutants of valid plans. Takes a few
minutes and prints its progress. Paths are relative to the workspace's root.

  --quick       only the parts that take seconds; a test compares them
  --dsa DIR     folder of offset-assignment instances NAME.CAPACITY.csv; without
                it, the document says that their table was skipped
  --out FILE    write the document to FILE instead of printing it, usually
                docs/measurements/proofs.md
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    let mut command = workspace::cargo(&["run", "--quiet", "--release", "--package", "tests", "--bin", "prove", "--"]);
    command.args(options.words());
    let outcome = stage::run("prove", &mut command);
    outcome.result.map_err(|reason| Failure::Failed(format!("{}: {reason}", outcome.name)))
}
