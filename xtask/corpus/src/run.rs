//! A run over all files, on all cores.

use crate::args::Args;
use crate::child::{self, Ended, Limits};
use crate::record::{Record, Report, Stamp, State, VERSION, With};
use crate::verdict::judge;
use crate::{files, sheet};
use program::interrupt::{self, Stopped};
use program::progress::Shown;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Result of [`run`].
#[derive(Debug)]
pub struct Outcome {
    /// Records of all finished files.
    pub report: Report,
    /// Number of files below the folder.
    pub total: usize,
    /// Number of files that this run rendered; the others were finished before.
    pub rendered: usize,
    /// The signal that stopped the run, if one did.
    pub stopped: Option<Stopped>,
    /// Files of results, in the order in which they were written; empty for a stopped run.
    pub written: Vec<PathBuf>,
}

/// Renders every file below the folder that is not finished yet, and writes the results.
///
/// # Errors
/// One line: a folder that cannot be read or written, or a `render` that cannot be started.
pub fn run(args: &Args) -> Result<Outcome, String> {
    let found = files::below(&args.folder)?;
    let with = With::of(args)?;
    let folder = |path: &Path| fs::create_dir_all(path).map_err(|error| format!("{}: {error}", path.display()));
    folder(&args.out)?;
    let state_file = args.out.join("corpus.state");
    let unwritable = |error: std::io::Error| format!("{}: {error}", state_file.display());
    let (mut state, kept) = State::open(&state_file, &with).map_err(unwritable)?;
    let kept: HashMap<String, Record> = kept.into_iter().map(|record| (record.file.clone(), record)).collect();

    let mut done = Vec::new();
    let mut left = Vec::new();
    for file in &found {
        let stamp = Stamp::of(&args.folder.join(file)).map_err(|error| format!("{}: {error}", file.display()))?;
        match kept.get(&name(file)).filter(|record| record.stamp == stamp) {
            Some(record) => done.push(record.clone()),
            None => left.push((file, stamp)),
        }
    }
    let finished = Mutex::new((done, Shown::default()));
    let next = AtomicUsize::new(0);
    let failure = Mutex::new(None);
    let state = Mutex::new(&mut state);
    let work = |worker: usize| -> Result<(), String> {
        let scratch = args.out.join(format!("work-{worker}"));
        folder(&scratch)?;
        while interrupt::check().is_ok() && locked(&failure).is_none() {
            let Some(&(file, stamp)) = left.get(next.fetch_add(1, Relaxed)) else { break };
            let Some(record) = one(args, file, stamp, &scratch)? else { break };
            locked(&state).line(&record).map_err(unwritable)?;
            let (done, shown) = &mut *locked(&finished);
            done.push(record);
            shown.step("rendering files", done.len(), found.len(), &name(file));
        }
        // Left behind only where the system refuses: a folder of scraps does no harm.
        let _ = fs::remove_dir_all(&scratch);
        Ok(())
    };
    std::thread::scope(|scope| {
        for worker in 0..args.jobs.min(left.len()) {
            let (work, failure) = (&work, &failure);
            scope.spawn(move || {
                if let Err(error) = work(worker) {
                    locked(failure).get_or_insert(error);
                }
            });
        }
    });
    if let Some(error) = locked(&failure).take() {
        return Err(error);
    }
    let (mut files, mut shown) = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    shown.clear();
    let rendered = files.len() - (found.len() - left.len());
    files.sort_by(|a, b| a.file.cmp(&b.file));
    let report = Report { version: VERSION, with, files };
    let stopped = interrupt::check().err();
    let written = if stopped.is_some() { Vec::new() } else { write(args, &report)? };
    Ok(Outcome { report, total: found.len(), rendered, stopped, written })
}

/// Renders one file. Returns none if the run is asked to stop.
fn one(args: &Args, file: &Path, stamp: Stamp, scratch: &Path) -> Result<Option<Record>, String> {
    let (made, hdr) = (scratch.join("picture.png"), scratch.join("hdr.png"));
    let _ = fs::remove_file(&made);
    let [width, height] = args.size_px;
    let mut command = Command::new(&args.render);
    // Mesa's device selection layer complains about a missing session on standard error.
    command.env("NODEVICE_SELECT", "1").arg(args.folder.join(file));
    command.args(["--size", &format!("{width}x{height}"), "--frames", "1"]);
    command.args(["--memory", &(args.memory_bytes / 2).to_string()]);
    command.arg("--out").arg(&made).arg("--plan").arg(scratch.join("plan.txt"));
    command.args(["--inspect", "hdr", "--inspect-out"]).arg(&hdr).args(&args.further);
    let limits = Limits { time: args.limit, memory_bytes: args.memory_bytes };
    let ended = child::run(&mut command, limits, scratch);
    let ended: Ended = ended.map_err(|error| format!("{}: {error}", args.render.display()))?;
    let Some(judged) = judge(&ended, made.is_file()) else { return Ok(None) };
    let file = name(file);
    let picture = format!("pictures/{file}.png");
    let place = args.out.join(&picture);
    // The picture of an earlier run would pass for one of this run.
    let _ = fs::remove_file(&place);
    let is_made = made.is_file();
    if is_made {
        let parent = place.parent().unwrap_or(&args.out);
        let moved = fs::create_dir_all(parent).and_then(|()| fs::rename(&made, &place));
        moved.map_err(|error| format!("{}: {error}", place.display()))?;
    }
    let (seconds, peak_bytes) = (ended.took.as_secs_f64(), ended.peak_bytes);
    Ok(Some(Record {
        file,
        stamp,
        verdict: judged.verdict,
        message: judged.message,
        warnings: judged.warnings,
        seconds: (seconds * 1000.0).round() / 1000.0,
        peak_bytes,
        picture: is_made.then_some(picture),
    }))
}

/// Returns a path with `/`, whatever the system separates with.
fn name(file: &Path) -> String {
    let parts: Vec<_> = file.iter().map(|part| part.to_string_lossy()).collect();
    parts.join("/")
}

/// Writes the report as JSON, and the contact sheet.
fn write(args: &Args, report: &Report) -> Result<Vec<PathBuf>, String> {
    let json = args.out.join("corpus.json");
    let text = serde_json::to_string_pretty(report).map_err(|error| format!("{}: {error}", json.display()))?;
    fs::write(&json, text + "\n").map_err(|error| format!("{}: {error}", json.display()))?;
    let mut written = vec![json];
    written.extend(sheet::write(&args.out, report)?);
    Ok(written)
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
