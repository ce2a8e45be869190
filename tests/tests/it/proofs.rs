//! `docs/measurements/proofs.md` matches the output of the `prove` program, for the parts that are quick and machine-independent.

use std::process::{Command, Output};

const DOCUMENT: &str = include_str!("../../../docs/measurements/proofs.md");

fn prove(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_prove")).args(args).output().expect("the program starts")
}

/// Returns the first of `lines` that the document lacks after the position of the previous one.
fn missing<'a>(lines: &[&'a str]) -> Option<&'a str> {
    let mut rest = DOCUMENT.lines();
    lines.iter().find(|line| !rest.by_ref().any(|other| other == **line)).copied()
}

#[test]
fn the_document_is_what_the_program_prints() {
    let output = prove(&["--quick"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    let text = String::from_utf8(output.stdout).expect("the document is UTF-8");
    let lines: Vec<_> = text.lines().filter(|line| !line.is_empty()).collect();
    let rows = lines.iter().filter(|line| line.starts_with("| ")).count();
    assert!(rows > 36, "{text}");
    let renew = "renew docs/measurements/proofs.md: cargo xtask prove --dsa tests/offset_assignment --out docs/measurements/proofs.md";
    assert_eq!(missing(&lines), None, "{renew}");
    // Negative control: a number changed by one in any row is detected.
    for (at, line) in lines.iter().enumerate().filter(|(_, line)| line.starts_with("| ") && !line.contains("---")) {
        let digit = line.rfind(|c: char| c.is_ascii_digit());
        let Some(digit) = digit else { continue };
        let other = if &line[digit..=digit] == "9" { "8" } else { "9" };
        let changed = format!("{}{other}{}", &line[..digit], &line[digit + 1..]);
        let mut others = lines.clone();
        others[at] = &changed;
        assert_eq!(missing(&others), Some(changed.as_str()));
    }
}

#[test]
fn the_document_holds_the_long_runs_and_nothing_in_it_fails() {
    for long in
        ["Memory of 1000 random graphs", "160 resources", "Published instances", "100000 random graphs", "2000 plans"]
    {
        let heads = DOCUMENT.lines().filter(|line| line.starts_with("## ") && line.contains(long));
        assert_eq!(heads.count(), 1, "{long}");
    }
    assert!(!DOCUMENT.contains(" | no |") && !DOCUMENT.contains("Skipped"), "something is not proved");
    assert_eq!(DOCUMENT.matches("; 0 survive without a proof").count(), 2);
}

#[test]
fn bad_input_is_named_and_nothing_is_written() {
    for (args, named) in [
        (&["--fast"][..], "--fast"),
        (&["--quick", "--dsa", "x"], "--quick"),
        (&["--quick", "--out", "nowhere/proofs.md"], "nowhere"),
    ] {
        let output = prove(args);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{told}");
        assert!(told.contains(named) && told.lines().count() == 1, "{told}");
    }
}
