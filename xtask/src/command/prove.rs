//! `cargo xtask prove`: what the compiler claims, with the figures that prove it.

use super::Command;
use crate::options::Options;
use crate::{Failure, stage, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "prove",
    summary: "print the proofs that docs/proofs.md holds",
    details: "\
Prints the document: memory beside its lower bound and beside brute force, the
oracle on random graphs, mutants of good plans. It takes a few minutes, tells
how far it is, and can be interrupted. Paths are from the workspace's root.

  --quick       only what takes seconds; a test compares it with the document
  --dsa DIR     with offset-assignment instances NAME.CAPACITY.csv; without,
                their table says that it was skipped
  --out FILE    write there instead of printing: docs/proofs.md
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    let mut command = workspace::cargo(&["run", "--quiet", "--release", "--package", "tests", "--bin", "prove", "--"]);
    command.args(options.words());
    let outcome = stage::run("prove", &mut command);
    outcome.result.map_err(|reason| Failure::Failed(format!("{}: {reason}", outcome.name)))
}
