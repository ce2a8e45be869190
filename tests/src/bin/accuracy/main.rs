//! `accuracy`: measures the error and cost of each approximation of the frame on this adapter, and writes JSON,
//! Markdown and HTML.

mod args;
mod budget;

use args::{Args, Wanted};
use framegraph_passes::quality::preset;
use framegraph_wgpu::{AdapterRequest, Gpu};
use program::interrupt;
use program::outputs::Outputs;
use program::progress::Shown;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;
use tests::lab::budget::Bench;
use tests::lab::record::{Record, Rounds, SCHEMA, VERSION};
use tests::lab::run::measure;
use tests::lab::studio::Studio;
use tests::lab::technique::Outcome;
use tests::lab::{html, markdown, techniques};

/// Name of the measurement of options as parts of one frame, which runs after the techniques.
const BUDGET: &str = "budget";

fn main() -> ExitCode {
    let args = match Args::parse(std::env::args_os().skip(1)) {
        Ok(args) => args,
        Err(reason) => {
            program::error(format_args!("{reason}"));
            return program::exit(2);
        }
    };
    match run(&args) {
        Ok(()) => program::exit(0),
        Err(reason) => {
            program::error(format_args!("{reason}"));
            program::exit(interrupt::check().map_or_else(interrupt::Stopped::code, |()| 1))
        }
    }
}

fn run(args: &Args) -> Outcome<()> {
    let file = args.out.join("accuracy.json");
    match &args.wanted {
        Wanted::Help(text) => {
            program::print(text);
            Ok(())
        }
        Wanted::Measure => measured(args, &file),
        Wanted::Document => {
            program::print(markdown::document(&Record::read(&file)?));
            Ok(())
        }
        Wanted::Budget(bound) => budget::chosen(&Record::read(&file)?, *bound),
        Wanted::Errors => budget::renewed(&mut Record::read(&file)?, &file),
        Wanted::Verify(count) => budget::verified(&Record::read(&file)?, *count),
        Wanted::Presets(source) => {
            let chosen = preset::source(budget::measured(&Record::read(&file)?)?)?;
            Ok(Outputs::one(source, chosen.as_bytes())?)
        }
    }
}

/// Measures techniques that the record lacks, and writes the record after each.
fn measured(args: &Args, file: &Path) -> Outcome<()> {
    interrupt::watch();
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    let pictures = args.out.join("pictures");
    std::fs::create_dir_all(&pictures).map_err(|e| format!("{}: {e}", pictures.display()))?;
    let (size_px, rounds) = if args.quick { ([96, 64], Rounds::QUICK) } else { ([192, 128], Rounds::FULL) };
    let processors = std::thread::available_parallelism().map_or(1.0, |n| n.get() as f64);
    let fresh = Record {
        schema: SCHEMA.to_owned(),
        version: VERSION,
        adapter: gpu.describe(),
        size_px,
        load: [processors, load()],
        warm_up: rounds.warm_up,
        repeats: rounds.timed,
        scene: args.scene.map(str::to_owned),
        quick: args.quick,
        optimized: !cfg!(debug_assertions),
        techniques: Vec::new(),
        budget: None,
    };
    // An interrupted run of the same kind is resumed.
    let mut record = match Record::read(file) {
        Ok(found) if !args.again && found.is_of_the_kind_of(&fresh) => found,
        _ => fresh,
    };
    let studio = Studio::new(&gpu, size_px, rounds);
    let mut all = techniques::all(&gpu);
    for found in &mut record.techniques {
        if let Some(technique) = all.iter().find(|technique| technique.name == found.name) {
            technique.note_presets(found);
        }
    }
    if let Some(scene) = args.scene {
        all.iter_mut().for_each(|technique| technique.show(scene));
    }
    let known = |name: &str| name == BUDGET || all.iter().any(|t| t.name == name);
    if let Some(unknown) = args.techniques.iter().find(|name| !known(name)) {
        let names: Vec<_> = all.iter().map(|t| t.name.as_str()).chain([BUDGET]).collect();
        return Err(format!("--technique {unknown}: unknown technique; known are {}", names.join(", ")).into());
    }
    let wanted = |name: &str| args.techniques.is_empty() || args.techniques.iter().any(|own| own == name);
    let mut progress = Shown::default();
    let start = Instant::now();
    let left: Vec<_> = all
        .iter()
        .filter(|t| wanted(&t.name))
        .filter(|t| !args.techniques.is_empty() || !record.techniques.iter().any(|found| found.name == t.name))
        .collect();
    for (done, technique) in left.iter().enumerate() {
        let each = start.elapsed().as_secs_f64() / done.max(1) as f64;
        let rest = if done > 0 { format!(", {:.0} s left", each * (left.len() - done) as f64) } else { String::new() };
        progress.step("measuring", done, left.len(), &format!("{}{rest}", technique.name));
        let found = measure(&studio, technique, &pictures)?;
        record.techniques.retain(|old| old.name != technique.name);
        record.techniques.push(found);
        let place = |name: &str| all.iter().position(|t| t.name == name);
        record.techniques.sort_by_key(|t| place(&t.name));
        Outputs::one(file, record.json()?.as_bytes())?;
    }
    if (args.techniques.is_empty() && record.budget.is_none()) || args.techniques.iter().any(|own| own == BUDGET) {
        progress.step("measuring", left.len(), left.len() + 1, BUDGET);
        record.budget = Some(Bench::new(&studio).measured()?);
        Outputs::one(file, record.json()?.as_bytes())?;
    }
    progress.clear();
    Outputs::one(file, record.json()?.as_bytes())?;
    Outputs::one(&args.out.join("accuracy.md"), markdown::document(&record).as_bytes())?;
    Outputs::one(&args.out.join("accuracy.html"), html::page(&record, &pictures).as_bytes())?;
    program::line(format_args!("{} techniques in {}", record.techniques.len(), args.out.display()));
    Ok(())
}

/// Returns the load average over one minute; 0 if the system does not report it.
fn load() -> f64 {
    let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or(0.0)
}
