//! `cargo xtask bevy`: check the integration with Bevy, which is a workspace of its own.

use super::Command;
use crate::options::Options;
use crate::{Failure, adapter, stage, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "bevy",
    summary: "check framegraph-bevy in integrations/bevy; no part of `test`",
    details: "\
Checks the format of integrations/bevy, runs clippy on it, and runs its tests,
which render with Bevy without a window. Bevy's crates are downloaded and built
on the first run: about four minutes on two cores. The CI runs this command
every night.

Exit code 1 if a stage failed.
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    adapter::ready(options)?;
    let folder = workspace::root().join("integrations/bevy");
    // Bevy 0.20 declares Rust 1.97, and builds with 1.95.
    let stages: [(&str, &[&str]); 3] = [
        ("format", &["fmt", "--check"]),
        ("lints", &["clippy", "--ignore-rust-version", "--locked", "--all-targets", "--", "-D", "warnings"]),
        ("tests", &["test", "--ignore-rust-version", "--locked"]),
    ];
    for (name, arguments) in stages {
        let mut command = workspace::cargo(arguments);
        command.current_dir(&folder);
        stage::run(name, &mut command).result.map_err(|error| Failure::Failed(format!("{name}: {error}")))?;
    }
    Ok(())
}
