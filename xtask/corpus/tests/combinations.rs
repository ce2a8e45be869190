//! Combinations with a fake `render`, whose options say how it ends.
#![cfg(unix)]

use corpus::combinations::{Options, run};
use corpus::verdict::Verdict;
use std::path::Path;
use std::time::Duration;

#[test]
fn crashes_errors_and_radiance_that_is_not_finite_are_findings_with_their_command_lines() {
    let folder = std::env::temp_dir().join(format!("combinations-{}", std::process::id()));
    let options = Options {
        strength: 2,
        render: Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fake_combinations.sh"),
        folder: folder.clone(),
        light: folder.join("light"),
        jobs: 3,
        limit: Duration::from_secs(60),
        memory_bytes: 1 << 30,
    };
    let outcome = run(&options, &|_, _| {}).expect("the cases run");
    // The system clears its folder where this fails.
    let _ = std::fs::remove_dir_all(&folder);
    assert_eq!(outcome.cases.len(), outcome.total);
    assert!(outcome.cases.iter().enumerate().all(|(at, case)| case.number == at));
    // A case that the adapter cannot serve runs without half floats.
    assert_eq!(outcome.count(Verdict::Refused), 0);
    assert!(outcome.cases.iter().all(|case| !case.line.contains("--precision")));
    for case in &outcome.cases {
        let has = |option: &str| format!("{} ", case.line).contains(&format!(" {option} "));
        let expected = match () {
            () if has("--fog on") => Verdict::Crashed,
            () if has("--dof on") => Verdict::NonFinite,
            () if has("--ssr on") => Verdict::Failed,
            () => Verdict::Ok,
        };
        assert_eq!(case.judged.verdict, expected, "{}", case.line);
        assert_eq!(case.is_fault(), expected != Verdict::Ok, "{}", case.line);
    }
    for verdict in [Verdict::Ok, Verdict::Crashed, Verdict::NonFinite, Verdict::Failed] {
        assert!(outcome.count(verdict) > 0, "{verdict:?}");
    }
    let text = outcome.to_string();
    assert!(outcome.faults().all(|case| text.contains(&format!("render {}\n", case.line))), "{text}");
}
