//! `reference`: renders the scenes that a folder states, and compares with the pictures beside them.
//!
//! `cargo run --release -p tests --bin reference -- [DIR [ID…]]`; `--help` has the options and exit codes.

mod args;

use args::{Args, Command};
use framegraph_scene::picture::write_text;
use framegraph_wgpu::{AdapterRequest, Gpu};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use tests::reference::examine::{How, Outcome, Verdict, between_qualities, examine};
use tests::reference::report;

fn main() -> ExitCode {
    let args = match args::parse(std::env::args_os().skip(1)) {
        Ok(Command::Run(args)) => args,
        Ok(Command::Help) => {
            println!("{}", args::HELP);
            return ExitCode::SUCCESS;
        }
        Err(told) => return refuse(&told),
    };
    match run(&args) {
        Ok(code) => code,
        Err(told) => refuse(&told),
    }
}

fn refuse(told: &str) -> ExitCode {
    eprintln!("error: {}", told.replace('\n', " "));
    ExitCode::from(2)
}

/// The statements of a folder, by name; `ids` selects.
fn statements(folder: &Path, ids: &[String]) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let is_json = |path: &PathBuf| path.extension().is_some_and(|e| e == "json");
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(is_json).collect();
    files.sort();
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if let Some(unknown) = ids.iter().find(|id| !files.iter().any(|file| stem(file) == **id)) {
        let known: Vec<String> = files.iter().map(|file| stem(file)).collect();
        return Err(format!("{unknown}: {} states no such scene; there are {}", folder.display(), known.join(", ")));
    }
    files.retain(|file| ids.is_empty() || ids.contains(&stem(file)));
    if files.is_empty() { Err(format!("{}: no .json states a scene", folder.display())) } else { Ok(files) }
}

fn run(args: &Args) -> Result<ExitCode, String> {
    let files = statements(&args.folder, &args.ids)?;
    if let Some(out) = &args.out {
        std::fs::create_dir_all(out).map_err(|error| format!("--out {}: {error}", out.display()))?;
    }
    let gpu = Gpu::open(&AdapterRequest::from_env()).map_err(|error| error.to_string())?;
    println!("adapter: {}", gpu.describe());
    let how = How { shade: args.shade, assets: args.assets.as_deref(), out: args.out.as_deref() };
    if args.compare_quality {
        return compare(&gpu, &files, how);
    }
    let (mut outcomes, mut errors) = (Vec::new(), Vec::new());
    for (index, file) in files.iter().enumerate() {
        eprintln!("{} of {}: {}", index + 1, files.len(), file.display());
        match examine(&gpu, file, how) {
            Ok(outcome) => outcomes.push(outcome),
            Err(error) => errors.push(error.to_string()),
        }
    }
    print!("{}", report::table(&outcomes));
    if let Some(path) = &args.json {
        write_text(path, &report::json(&outcomes, &errors)).map_err(|error| error.to_string())?;
        println!("wrote {}", path.display());
    }
    errors.iter().for_each(|error| eprintln!("error: {}", error.replace('\n', " ")));
    Ok(summary(&outcomes, errors.len()))
}

/// How far each scene moves between the qualities.
fn compare(gpu: &Gpu, files: &[PathBuf], how: How<'_>) -> Result<ExitCode, String> {
    let mut rows = Vec::new();
    for (index, file) in files.iter().enumerate() {
        eprintln!("{} of {}: {}", index + 1, files.len(), file.display());
        match between_qualities(gpu, file, how).map_err(|error| error.to_string())? {
            Some(row) => rows.push(row),
            None => println!("{}: asks for what is not built", file.display()),
        }
    }
    print!("{}", report::distances(&rows, "high to low"));
    Ok(ExitCode::SUCCESS)
}

/// The last line, and the exit code.
fn summary(outcomes: &[Outcome], errors: usize) -> ExitCode {
    let names = |wanted: fn(&Outcome) -> bool| -> Vec<&str> {
        outcomes.iter().filter(|outcome| wanted(outcome)).map(|outcome| outcome.id.as_str()).collect()
    };
    let passed = names(|o| o.verdict == Verdict::Passed);
    let failed = names(|o| matches!(o.verdict, Verdict::Failed(_)) || o.control == Some(false));
    let skipped = names(|o| matches!(o.verdict, Verdict::Skipped(_)));
    let unjudged =
        outcomes.len() - passed.len() - names(|o| matches!(o.verdict, Verdict::Failed(_))).len() - skipped.len();
    let list = |names: &[&str]| if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
    println!(
        "{} passed, {} failed{}, {} skipped{}, {unjudged} without a rule, {errors} errors",
        passed.len(),
        failed.len(),
        list(&failed),
        skipped.len(),
        list(&skipped)
    );
    match (errors, failed.len()) {
        (0, 0) => ExitCode::SUCCESS,
        (0, _) => ExitCode::from(1),
        _ => ExitCode::from(2),
    }
}
