//! `cargo xtask prose`: the style check.

use super::Command;
use crate::options::Options;
use crate::prose::ratchet::{FILE, Limits, percent};
use crate::prose::{Flagged, check};
use crate::{Failure, workspace};
use std::fs;

/// The command.
pub const COMMAND: Command = Command {
    name: "prose",
    summary: "check the style of docs, comments and messages",
    details: "\
Reads documentation, comments, messages and Markdown files, and flags sentences
that a reader is likely to read twice. They have a clause as the subject, more
than 30 words, or words that only this project uses, or are fragments. Prints the share of
flagged sentences for each top-level folder, and the highest that
xtask/prose.ron allows. It is a heuristic, so each folder has a limit above 0.

  --list        print every flagged sentence with its file, line and reason
  --lower       lower the limits in xtask/prose.ron to the measured shares

Exit code 1 if a share exceeds its limit.
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    let root = workspace::root();
    let folders = check(&root).map_err(Failure::Failed)?;
    let path = root.join(FILE);
    let text = fs::read_to_string(&path).map_err(|error| Failure::Failed(format!("{FILE}: {error}")))?;
    let read = Limits::read(&text).map_err(Failure::Failed)?;
    let lowered = read.lowered(&folders);
    let limits = if options.has("--lower") { &lowered } else { &read };
    let mut exceeded = Vec::new();
    for (name, folder) in &folders {
        if options.has("--list") {
            for Flagged { place, reasons, sentence } in &folder.flagged {
                program::line(format_args!("{place}: {reasons}: {sentence}"));
            }
        }
        let (share, limit) = (folder.permille(), limits.of(name));
        let note = if share > limit {
            exceeded.push(name.as_str());
            "  EXCEEDED"
        } else if lowered.of(name) < limit {
            "  lower the limit"
        } else {
            ""
        };
        let (sentences, flagged) = (folder.sentences, folder.flagged.len());
        let (share, limit) = (percent(share), percent(limit));
        program::line(format_args!(
            "{name:<16} {sentences:>6} sentences, {flagged:>5} flagged, {share:>5} %, allowed {limit:>5} %{note}"
        ));
    }
    if options.has("--lower") {
        fs::write(&path, lowered.written()).map_err(|error| Failure::Failed(format!("{FILE}: {error}")))?;
    } else if lowered != read && exceeded.is_empty() {
        program::line(format_args!("`cargo xtask prose --lower` lowers the limits in {FILE}"));
    }
    if exceeded.is_empty() {
        return Ok(());
    }
    let folders = exceeded.join(", ");
    Err(Failure::Failed(format!(
        "{folders}: more flagged sentences than {FILE} allows; `cargo xtask prose --list` shows them"
    )))
}
