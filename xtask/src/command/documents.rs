//! `cargo xtask documents`: compares the tables in docs/ with the output of the programs that print them.

use super::Command;
use crate::options::Options;
use crate::{Failure, stage, workspace};
use std::fs;

/// The command.
pub const COMMAND: Command = Command {
    name: "documents",
    summary: "print every table of docs/ again, long runs too, and compare",
    details: "\
Runs the programs that print the tables of docs/measurements/proofs.md, docs/measurements/image-light.md,
docs/measurements/half-floats.md, docs/measurements/hard-cases.md, docs/design/occlusion.md, docs/design/reflections.md,
docs/design/taa.md, docs/design/lights.md and docs/measurements/references.md, in release and with all cases.
Lists printed rows that the document lacks. Columns of times are ignored. Marked
tables of other documents are compared by tests. `cargo xtask bench` prints the
tables of docs/measurements/performance.md, and tests check that their figures are consistent.
The command takes about 15 minutes. Figures that depend on rounding are those of
Mesa's software driver. Exit code 1 if a row is missing or a program fails.
",
    run,
};

/// A program whose output is part of a document.
struct Printed {
    document: &'static str,
    /// Program of the package `tests`, then its arguments.
    program: &'static [&'static str],
    /// Mark in front of the table to compare; without one, all tables are compared.
    mark: Option<&'static str>,
    /// The program may fail: its rows then say what failed.
    may_fail: bool,
}

const FRAMES: &str = "tests/references/filament_frame";

const PRINTED: [Printed; 12] = [
    Printed {
        document: "docs/measurements/proofs.md",
        program: &["prove", "--dsa", "tests/offset_assignment"],
        mark: None,
        may_fail: false,
    },
    Printed { document: "docs/measurements/image-light.md", program: &["ibl_errors"], mark: None, may_fail: false },
    Printed { document: "docs/design/occlusion.md", program: &["occlusion"], mark: None, may_fail: false },
    Printed { document: "docs/design/reflections.md", program: &["reflections"], mark: None, may_fail: false },
    Printed { document: "docs/design/taa.md", program: &["taa"], mark: None, may_fail: false },
    Printed { document: "docs/design/lights.md", program: &["lights"], mark: None, may_fail: false },
    Printed { document: "docs/measurements/hard-cases.md", program: &["hard_cases"], mark: None, may_fail: false },
    Printed { document: "docs/measurements/half-floats.md", program: &["shading_errors"], mark: None, may_fail: false },
    Printed {
        document: "docs/measurements/references.md",
        program: &["reference"],
        mark: Some("reference"),
        may_fail: false,
    },
    Printed {
        document: "docs/measurements/references.md",
        program: &["reference", "--quality", "low"],
        mark: Some("reference --quality low"),
        may_fail: false,
    },
    Printed {
        document: "docs/measurements/references.md",
        program: &["reference", "--compare-quality"],
        mark: Some("reference --compare-quality"),
        may_fail: false,
    },
    Printed {
        document: "docs/measurements/references.md",
        program: &["reference", FRAMES],
        mark: Some("reference tests/references/filament_frame"),
        may_fail: true,
    },
];

fn run(_: &Options) -> Result<(), Failure> {
    let mut left = 0;
    for Printed { document, program, mark, may_fail } in PRINTED {
        let path = workspace::root().join(document);
        let text = fs::read_to_string(&path).map_err(|error| Failure::Failed(format!("{document}: {error}")))?;
        let part = part_of(&text, mark)
            .ok_or_else(|| Failure::Failed(format!("{document}: the table `{}` is missing", mark.unwrap_or("-"))))?;
        let mut command =
            workspace::cargo(&["run", "--quiet", "--release", "--package", "tests", "--bin", program[0], "--"]);
        let mut lines = Vec::new();
        let outcome = stage::run_reading("print", command.args(&program[1..]), |line| lines.push(line.to_owned()));
        if let Err(reason) = outcome.result
            && !may_fail
        {
            left += 1;
            program::line(format_args!("{} failed: {reason}", program.join(" ")));
        }
        for row in missing(part, &lines) {
            left += 1;
            program::line(format_args!("{document}: missing row: {row}"));
        }
    }
    if left == 0 {
        Ok(())
    } else {
        Err(Failure::Failed(format!("{left} rows missing from documents, or programs failed")))
    }
}

/// Returns the lines between a mark and the end of its table.
fn part_of<'a>(document: &'a str, mark: Option<&str>) -> Option<&'a str> {
    let Some(mark) = mark else { return Some(document) };
    let (_, after) = document.split_once(&format!("<!-- table: {mark} -->"))?;
    after.split_once("<!-- end -->").map(|(table, _)| table)
}

/// Returns the rows of tables, with columns of times removed.
fn rows<'a>(lines: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut times: Vec<bool> = Vec::new();
    let mut inside = false;
    let mut rows = Vec::new();
    for line in lines {
        if !line.starts_with('|') {
            inside = false;
            continue;
        }
        let cells: Vec<&str> = line.trim().trim_matches('|').split('|').map(str::trim).collect();
        if !inside {
            let is_time = |head: &&str| head.split(' ').any(|word| ["ms", "seconds"].contains(&word));
            times = cells.iter().map(is_time).collect();
            inside = true;
        }
        let kept = cells.iter().zip(times.iter().chain(std::iter::repeat(&false)));
        let kept: Vec<&str> = kept.map(|(cell, time)| if *time { "…" } else { cell }).collect();
        // The separator below the head varies with the width of the table.
        if !kept.iter().all(|cell| cell.chars().all(|c| c == '-' || c == '…')) {
            rows.push(kept.join(" | "));
        }
    }
    rows
}

/// Returns printed rows that the document lacks at or after the position of the previous row.
fn missing(document: &str, printed: &[String]) -> Vec<String> {
    let documented = rows(document.lines());
    let mut from = 0;
    let absent = |row: &String| match documented[from..].iter().position(|other| other == row) {
        Some(at) => {
            from += at + 1;
            false
        }
        None => true,
    };
    rows(printed.iter().map(String::as_str)).into_iter().filter(absent).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOCUMENT: &str = "text\n\n| a | b ms |\n| --- | --- |\n| one | 5 |\n| two | 6 |\n\n<!-- table: x y -->\n\
        | a    | n |\n| ---- | - |\n| one  | 3 |\n<!-- end -->\n";

    fn printed(text: &str) -> Vec<String> {
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn rows_are_compared_in_order_without_times_and_widths() {
        let same = printed("| a | b ms |\n| - | - |\n| one | 70 |\n| two | 8 |");
        assert!(missing(DOCUMENT, &same).is_empty());
        let other = printed("| a | b ms |\n| - | - |\n| two | 6 |\n| one | 5 |");
        assert_eq!(missing(DOCUMENT, &other), ["one | …"]);
    }

    #[test]
    fn a_table_behind_a_mark_is_compared_alone() {
        let part = part_of(DOCUMENT, Some("x y")).expect("it is there");
        assert!(missing(part, &printed("| a | n |\n| --- | --- |\n| one | 3 |")).is_empty());
        assert_eq!(missing(part, &printed("| a | n |\n| --- | --- |\n| one | 4 |")), ["one | 4"]);
        assert!(part_of(DOCUMENT, Some("z")).is_none());
    }

    /// Marked tables that tests compare, each with the file of its test.
    const TESTED: [(&str, &str); 13] = [
        ("extensions", "scene/src/import/extension.rs"),
        ("facts", "tests/tests/it/facts/table.rs"),
        ("features of the color pass", "shaders/tests/all/operations.rs"),
        ("grading", "tests/tests/it/grading.rs"),
        ("levels", "tests/tests/it/levels.rs"),
        ("loop counters", "shaders/tests/all/operations.rs"),
        ("loops", "tests/tests/it/loops.rs"),
        ("indices", "tests/tests/it/loops.rs"),
        ("order", "scene/src/import/tests/real_files.rs"),
        ("render --compare-post", "tests/tests/it/readme.rs"),
        ("render spheres", "tests/tests/it/readme.rs"),
        ("render spheres --force-effects", "tests/tests/it/readme.rs"),
        ("rooms", "xtask/src/command/rooms.rs"),
    ];

    #[test]
    fn every_marked_table_is_compared_by_somebody() {
        let root = workspace::root();
        let files =
            |folder| fs::read_dir(root.join(folder)).expect("the folder is there").flatten().map(|file| file.path());
        let documents =
            ["docs", "docs/design", "docs/guide", "docs/measurements", "docs/reference"].into_iter().flat_map(files);
        let mut marked = 0;
        for document in documents.chain([root.join("README.md")]) {
            let Ok(text) = fs::read_to_string(&document) else { continue };
            for mark in text.split("<!-- table: ").skip(1).filter_map(|rest| Some(rest.split_once(" -->")?.0)) {
                marked += 1;
                let printed = PRINTED.iter().any(|printed| printed.mark == Some(mark));
                let tested = TESTED.iter().any(|(tested, file)| *tested == mark && root.join(file).is_file());
                assert!(printed || tested, "{}: nothing compares the table `{mark}`", document.display());
            }
        }
        assert!(marked > 10, "{marked}");
    }

    #[test]
    fn every_document_has_the_tables_that_are_compared() {
        for Printed { document, mark, .. } in PRINTED {
            let text = fs::read_to_string(workspace::root().join(document)).expect("a document");
            let part = part_of(&text, mark).expect("the table");
            assert!(rows(part.lines()).len() > 5, "{document}");
        }
    }
}
