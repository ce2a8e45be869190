//! All cases of a covering array, each rendered by its own process.

use super::cover::cover;
use super::factors::{parts_and_options, space};
use super::scene;
use crate::child::{self, Limits};
use crate::verdict::{Judged, Verdict, judge};
use program::interrupt;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Size of the pictures.
const SIZE: &str = "64x48";
/// Option that some adapters cannot serve; a case that is refused for it runs without it.
const HALF_FLOATS: [&str; 2] = ["--precision", "f16"];

/// Options of a run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Factors of which every combination of levels is in a case: 2 or 3.
    pub strength: usize,
    /// The `render` program.
    pub render: PathBuf,
    /// Folder for scenes and pictures.
    pub folder: PathBuf,
    /// Folder that `render` keeps light in.
    pub light: PathBuf,
    /// Processes at a time.
    pub jobs: usize,
    /// Time limit of a case.
    pub limit: Duration,
    /// Limit on the resident memory of a process in bytes.
    pub memory_bytes: u64,
}

/// A case that was rendered.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Number of the case in the array.
    pub number: usize,
    /// Command line, without the program; its paths are relative to [`Options::folder`].
    pub line: String,
    /// Verdict with its reason.
    pub judged: Judged,
    /// Wall-clock time.
    pub took: Duration,
}

impl Rendered {
    /// Returns true for any verdict but ok. Refusals are findings too, since the array has no case that is to be refused.
    #[must_use]
    pub fn is_fault(&self) -> bool {
        self.judged.verdict != Verdict::Ok
    }
}

/// Result of a run.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Cases in the array.
    pub total: usize,
    /// Rendered cases, by number.
    pub cases: Vec<Rendered>,
}

impl Outcome {
    /// Number of cases with a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.cases.iter().filter(|case| case.judged.verdict == verdict).count()
    }

    /// Returns the counts of cases and verdicts in a line.
    #[must_use]
    pub fn counts(&self) -> String {
        let words = Verdict::ALL.iter().map(|verdict| format!("{} {}", self.count(*verdict), verdict.word()));
        let (done, counts) = (self.cases.len(), words.collect::<Vec<_>>().join(", "));
        format!("{done} of {} cases: {counts}", self.total)
    }

    /// Returns the cases that are findings.
    pub fn faults(&self) -> impl Iterator<Item = &Rendered> {
        self.cases.iter().filter(|case| case.is_fault())
    }
}

impl fmt::Display for Outcome {
    /// The counts in a line, then each case that is not ok with its command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.counts())?;
        for case in self.faults() {
            let (number, Judged { verdict, message, .. }) = (case.number, &case.judged);
            writeln!(f, "  case {number}, {}: {message}\n    render {}", verdict.word(), case.line)?;
        }
        Ok(())
    }
}

/// Renders all cases, and calls `finished` after each. A signal that asks to stop ends the run early.
///
/// # Errors
/// One line: a folder that cannot be written, or a `render` that cannot be started.
pub fn run(options: &Options, finished: &(impl Fn(&Rendered, usize) + Sync)) -> Result<Outcome, String> {
    let scenes = options.folder.join("scenes");
    let unwritable = |error: std::io::Error| format!("{}: {error}", scenes.display());
    fs::create_dir_all(&scenes).and_then(|()| scene::write_geometry(&scenes)).map_err(unwritable)?;
    let cases = cover(&space(), options.strength);
    for case in &cases {
        scene::write(&scenes, &parts_and_options(case).0).map_err(unwritable)?;
    }
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = |worker: usize| -> Result<(), String> {
        let scratch = options.folder.join(format!("work-{worker}"));
        fs::create_dir_all(&scratch).map_err(|error| format!("{}: {error}", scratch.display()))?;
        while interrupt::check().is_ok() {
            let number = next.fetch_add(1, Relaxed);
            let Some(case) = cases.get(number) else { break };
            let Some(rendered) = one(options, number, case, &scratch)? else { break };
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            finished(&rendered, cases.len());
            done.push(rendered);
        }
        // Left behind only where the system refuses: a folder of scraps does no harm.
        let _ = fs::remove_dir_all(&scratch);
        Ok(())
    };
    let ended: Result<Vec<()>, String> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..options.jobs.max(1)).map(|worker| scope.spawn(move || work(worker))).collect();
        let joined = workers.into_iter().map(|worker| worker.join().unwrap_or(Err("a worker panicked".to_owned())));
        joined.collect()
    });
    ended?;
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|case| case.number);
    Ok(Outcome { total: cases.len(), cases: done })
}

/// Renders one case. Returns none if the run is asked to stop.
fn one(options: &Options, number: usize, case: &[usize], scratch: &Path) -> Result<Option<Rendered>, String> {
    let (parts, mut words) = parts_and_options(case);
    let scenes = options.folder.join("scenes");
    let scene = scene::write(&scenes, &parts).map_err(|error| format!("{}: {error}", scenes.display()))?;
    loop {
        let mut line = vec![format!("scenes/{scene}")];
        line.extend(["--size", SIZE, "--frames", "1"].iter().chain(&words).map(|word| (*word).to_owned()));
        let picture = scratch.join("picture.png");
        let _ = fs::remove_file(&picture);
        let mut command = Command::new(&options.render);
        // Mesa's device selection layer complains about a missing session on standard error.
        command.env("NODEVICE_SELECT", "1").env("FRAMEGRAPH_LIGHT_CACHE", &options.light);
        command.current_dir(&options.folder).args(&line).arg("--out").arg(&picture);
        command.arg("--plan").arg(scratch.join("plan.txt"));
        command.args(["--inspect", "hdr", "--inspect-out"]).arg(scratch.join("hdr.png"));
        let limits = Limits { time: options.limit, memory_bytes: options.memory_bytes };
        let ended = child::run(&mut command, limits, scratch);
        let ended = ended.map_err(|error| format!("{}: {error}", options.render.display()))?;
        let Some(judged) = judge(&ended, picture.is_file()) else { return Ok(None) };
        let half = words.windows(2).position(|pair| pair == HALF_FLOATS);
        if let Some(at) = half.filter(|_| judged.verdict == Verdict::Refused && judged.message.contains("precision")) {
            words.drain(at..at + 2);
            continue;
        }
        return Ok(Some(Rendered { number, line: line.join(" "), judged, took: ended.took }));
    }
}
