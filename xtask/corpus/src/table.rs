//! Results as Markdown.

use crate::record::Report;
use crate::verdict::Verdict;
use std::fmt::Write as _;

/// Returns the counts of verdicts, and a list of the files that are not ok with their messages.
#[must_use]
pub fn markdown(report: &Report) -> String {
    let mut text = counts(report);
    let others: Vec<_> = report.files.iter().filter(|record| record.verdict != Verdict::Ok).collect();
    if !others.is_empty() {
        text += "\n| verdict | file | message |\n| --- | --- | --- |\n";
    }
    for record in others {
        let message = record.message.replace('|', "\\|");
        let _ = writeln!(text, "| {} | {} | {message} |", record.verdict.word(), record.file);
    }
    text
}

/// Returns one row with the number of files under each verdict, and of the files that have warnings.
#[must_use]
pub fn counts(report: &Report) -> String {
    let words: Vec<_> = Verdict::ALL.iter().map(|verdict| verdict.word()).collect();
    let counts: Vec<_> = Verdict::ALL.iter().map(|verdict| report.count(*verdict).to_string()).collect();
    let warned = report.files.iter().filter(|record| !record.warnings.is_empty()).count();
    format!(
        "| files | {} | with warnings |\n|{}\n| {} | {} | {warned} |\n",
        words.join(" | "),
        " --- |".repeat(words.len() + 2),
        report.files.len(),
        counts.join(" | ")
    )
}
