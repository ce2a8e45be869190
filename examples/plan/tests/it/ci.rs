//! Budgets, expected outputs, and the commands of the example workflow.

use crate::{run, scratch};
use std::path::{Path, PathBuf};
use std::process::Command;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../ci")
}

#[test]
fn the_commands_of_the_workflow_pass() {
    let workflow = std::fs::read_to_string(folder().join("workflow.yml")).expect("the workflow is there");
    let commands: Vec<_> = workflow.lines().filter_map(|line| line.split_once("run: plan ")).collect();
    assert_eq!(commands.len(), 4);
    let picture = scratch("workflow.svg").display().to_string();
    for (_, command) in commands {
        let words = command.split(' ').map(|word| if word == "plan.svg" { &*picture } else { word });
        let made = Command::new(env!("CARGO_BIN_EXE_plan")).args(words).current_dir(folder()).output();
        let made = made.expect("the program starts");
        assert!(made.status.success(), "{command}: {}", String::from_utf8_lossy(&made.stderr));
    }
}

#[test]
fn limits_and_expected_outputs_fail_with_reasons() {
    let file = |name: &str| folder().join(name).display().to_string();
    let (frame, golden) = (file("frame.ron"), scratch("frame.plan"));
    let (limits, golden) = (scratch("tight.budget").display().to_string(), golden.display().to_string());
    std::fs::write(&limits, "stores=1 # hdr should be inlined\nfull_screen_resolves=0\n").expect("written");
    let (code, text, error) = run(&[&frame, "--caps", "mali", "--assert", &limits, "--budget", "bytes=1MiB"]);
    assert!(code == Some(1) && text.starts_with("plan 2 for mali"), "{error}");
    let lines: Vec<_> = error.lines().collect();
    assert!(lines[0].starts_with("budget exceeded: bytes ") && lines[1].contains("`hdr`"), "{error}");
    let stores = lines.iter().position(|line| *line == "budget exceeded: stores 2, limit 1").expect("a heading");
    // The largest is first.
    assert!(lines[stores + 1].contains("store of `hdr`") && lines[stores + 1].contains("(16588800 B)"), "{error}");
    assert!(lines[stores + 2].contains("store of `screen`") && lines.len() == stores + 3, "{error}");

    // A written output is accepted; one of another device differs, and is shown.
    let written = Command::new(env!("CARGO_BIN_EXE_plan"))
        .args([&frame, "--caps", "mali", "--golden", &golden])
        .env("UPDATE_GOLDENS", "1")
        .output();
    assert!(written.is_ok_and(|output| output.status.success()));
    assert_eq!(run(&[&frame, "--caps", "mali", "--golden", &golden]), (Some(0), text, String::new()));
    let (code, _, error) = run(&[&frame, "--caps", "desktop", "--golden", &golden]);
    assert!(
        code == Some(1) && error.contains("\n-plan 2 for mali at") && error.contains("\n+plan 2 for desktop"),
        "{error}"
    );
    for (option, path) in [("--golden", "nowhere.plan"), ("--assert", "nowhere.budget")] {
        let (code, text, error) = run(&[&frame, option, path]);
        assert_eq!((code, text.as_str(), error.contains(path)), (Some(2), "", true), "{error}");
    }
    // A wrong file of limits is named.
    std::fs::write(&limits, "store=1").expect("written");
    let (code, _, error) = run(&[&frame, "--assert", &limits]);
    assert!(code == Some(2) && error.contains("tight.budget: unknown limit `store`"), "{error}");
}
