//! `reference`: renders the scenes described in a folder, and compares them with reference pictures.
//!
//! `cargo run --release -p tests --bin reference -- [DIR [ID…]]`; `--help` lists options and exit codes.

mod args;

use args::{Args, Command};
use framegraph_wgpu::{AdapterRequest, Gpu};
use program::interrupt;
use program::outputs::{Outputs, check_folder};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use tests::reference::examine::{How, Outcome, Verdict, between_qualities, examine};
use tests::reference::report;

fn main() -> ExitCode {
    let args = match args::parse(std::env::args_os().skip(1)) {
        Ok(Command::Run(args)) => args,
        Ok(Command::Help(text)) => {
            program::print(text);
            return program::exit(0);
        }
        Err(told) => return refuse(&told),
    };
    interrupt::watch();
    match run(&args) {
        Ok(code) => program::exit(code),
        Err(told) => refuse(&told),
    }
}

fn refuse(told: &str) -> ExitCode {
    program::error(told);
    program::exit(interrupt::check().map_or_else(interrupt::Stopped::code, |()| 2))
}

/// Returns the statements of a folder, sorted by name; `ids` selects some of them.
fn statements(folder: &Path, ids: &[String]) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let is_json = |path: &PathBuf| path.extension().is_some_and(|e| e == "json");
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(is_json).collect();
    files.sort();
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if let Some(unknown) = ids.iter().find(|id| !files.iter().any(|file| stem(file) == **id)) {
        let known: Vec<String> = files.iter().map(|file| stem(file)).collect();
        return Err(format!("{unknown}: not a statement in {}; known are {}", folder.display(), known.join(", ")));
    }
    files.retain(|file| ids.is_empty() || ids.contains(&stem(file)));
    if files.is_empty() { Err(format!("{}: no statement (.json) found", folder.display())) } else { Ok(files) }
}

fn run(args: &Args) -> Result<u8, String> {
    let files = statements(&args.folder, &args.ids)?;
    if let Some(out) = &args.out {
        std::fs::create_dir_all(out).map_err(|error| format!("--out {}: {error}", out.display()))?;
        let same =
            |folder: &Path| folder.canonicalize().is_ok_and(|folder| out.canonicalize().is_ok_and(|out| out == folder));
        if same(&args.folder) || args.assets.as_deref().is_some_and(same) {
            return Err(format!("--out {}: the folder contains the references; choose another", out.display()));
        }
        check_folder(out).map_err(|error| format!("--out {error}"))?;
    }
    let mut outputs = Outputs::default();
    // Pictures and charts of the statements are protected from being overwritten too.
    for entry in std::fs::read_dir(&args.folder).into_iter().flatten().flatten() {
        outputs.reads(&entry.path()).map_err(|error| error.to_string())?;
    }
    if let Some(path) = &args.json {
        outputs.add(path).map_err(|error| format!("--json: {error}"))?;
    }
    let gpu = Gpu::open(&AdapterRequest::from_env()).map_err(|error| error.to_string())?;
    program::line(format_args!("adapter: {}", gpu.describe()));
    let how = How { shade: args.shade, assets: args.assets.as_deref(), out: args.out.as_deref() };
    if args.compare_quality {
        return compare(&gpu, &files, how);
    }
    let (mut outcomes, mut errors) = (Vec::new(), Vec::new());
    for (index, file) in files.iter().enumerate() {
        interrupt::check().map_err(|stopped| stopped.to_string())?;
        program::note(format_args!("{} of {}: {}", index + 1, files.len(), file.display()));
        match examine(&gpu, file, how) {
            Ok(outcome) => outcomes.push(outcome),
            Err(error) => errors.push(error.to_string()),
        }
    }
    program::print(report::table(&outcomes));
    if let Some(path) = &args.json {
        let json = report::json(&outcomes, &errors);
        outputs.write(path, |file| file.write_all(json.as_bytes())).map_err(|error| error.to_string())?;
        outputs.commit().map_err(|error| error.to_string())?;
        program::line(format_args!("wrote {}", path.display()));
    }
    errors.iter().for_each(program::error);
    Ok(summary(&outcomes, errors.len()))
}

/// Prints the difference of each scene between the two qualities.
fn compare(gpu: &Gpu, files: &[PathBuf], how: How<'_>) -> Result<u8, String> {
    let mut rows = Vec::new();
    for (index, file) in files.iter().enumerate() {
        interrupt::check().map_err(|stopped| stopped.to_string())?;
        program::note(format_args!("{} of {}: {}", index + 1, files.len(), file.display()));
        match between_qualities(gpu, file, how).map_err(|error| error.to_string())? {
            Some(row) => rows.push(row),
            None => program::line(format_args!("{}: asks for what is not built", file.display())),
        }
    }
    program::print(report::distances(&rows, "high to low"));
    Ok(0)
}

/// Prints the last line, and returns the exit code.
fn summary(outcomes: &[Outcome], errors: usize) -> u8 {
    let names = |wanted: fn(&Outcome) -> bool| -> Vec<&str> {
        outcomes.iter().filter(|outcome| wanted(outcome)).map(|outcome| outcome.id.as_str()).collect()
    };
    let passed = names(|o| o.verdict == Verdict::Passed);
    let failed = names(|o| matches!(o.verdict, Verdict::Failed(_)) || o.control == Some(false));
    let skipped = names(|o| matches!(o.verdict, Verdict::Skipped(_)));
    let missed = names(|o| matches!(o.verdict, Verdict::Missed(_)));
    let unjudged = names(|o| matches!(o.verdict, Verdict::Unjudged(_))).len();
    let list = |names: &[&str]| if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
    program::line(format_args!(
        "{} passed, {} failed{}, {}{} skipped{}, {unjudged} without a rule, {errors} errors",
        passed.len(),
        failed.len(),
        list(&failed),
        if missed.is_empty() { String::new() } else { format!("{} missed softly{}, ", missed.len(), list(&missed)) },
        skipped.len(),
        list(&skipped)
    ));
    match (errors, failed.len()) {
        (0, 0) => 0,
        (0, _) => 1,
        _ => 2,
    }
}
