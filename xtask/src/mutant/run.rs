//! Runs the mutants. WGSL is replaced when a test starts, so nothing is rebuilt. Rust is built in a copy of the
//! workspace; this workspace is never changed.

use crate::mutant::judge::{self, Replaced, Says, Test};
use crate::mutant::kept::Kept;
use crate::mutant::plant::Mutant;
use crate::mutant::room::{self, Judge, Room};
use crate::mutant::workers;
use crate::{Failure, workspace};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Result of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// It does not compile and is not counted.
    Refused,
    /// A test failed.
    Noticed,
    /// All quick tests passed; slow tests have not run.
    Left,
    /// All tests passed, or as many as the time limit allowed.
    Survived,
}

/// Environment in which mutants run.
pub struct Bench<'a> {
    room: &'a Room,
    /// Test programs that no mutant rebuilds, in the order of the room's judges.
    built: Vec<PathBuf>,
    tests: Vec<Test>,
    kept: Kept,
    /// Original texts of the room's files; the workspace may change during the run.
    sources: BTreeMap<String, String>,
}

impl<'a> Bench<'a> {
    /// Creates a bench for the mutants of a room.
    ///
    /// # Errors
    /// A file cannot be written, or the tests fail or do not compile without a mutant.
    pub fn new(room: &'a Room) -> Result<Self, Failure> {
        let root = workspace::root();
        let folder = root.join("target/mutants");
        fs::create_dir_all(&folder).map_err(|error| told(&folder, &error))?;
        let kept_in = folder.join(format!("{}.fates", room.name));
        let (kept, sources) = (Kept::default(), room.sources()?);
        let mut bench = Self { room, built: Vec::new(), tests: Vec::new(), kept, sources };
        let built =
            bench.programs()?.ok_or_else(|| Failure::Failed("the tests do not compile without a mutant".into()))?;
        let copies = built.iter().enumerate().map(|(judge, program)| bench.copied(judge, program));
        bench.built = copies.collect::<Result<_, _>>()?;
        let mut judges = 0;
        for program in &bench.built {
            let bytes = fs::read(program).map_err(|error| told(program, &error))?;
            judges = hash(judges, &bytes);
        }
        bench.kept = Kept::read(&kept_in, judges);
        bench.tests = bench.learned(&folder.join("tests"))?;
        for test in &bench.tests {
            bench.kept.noticed_by(&test.name).for_each(|file| test.count(file, true));
        }
        Ok(bench)
    }

    /// Returns the hash of the texts that line numbers refer to.
    fn lines_of(&self) -> u64 {
        let shaders = workspace::root().join("shaders/wgsl");
        let texts = room::files(&[shaders]).unwrap_or_default().into_iter().map(fs::read);
        texts.flatten().fold(0, |known, text| hash(known, &text))
    }

    /// Returns every test with its time and compiled lines, from `file`, which all rooms share, or from a run without a
    /// mutant.
    fn learned(&self, file: &Path) -> Result<Vec<Test>, Failure> {
        let texts = self.lines_of();
        let known = Mutex::new(judge::read(texts, &fs::read_to_string(file).unwrap_or_default()));
        let mut names = Vec::new();
        for (index, (judge, program)) in self.room.judges.iter().zip(&self.built).enumerate() {
            names.extend(judge::names(program, judge.filters, judge.without)?.into_iter().map(|name| (index, name)));
        }
        let learned = workers::share(workers::processors(), names.len(), |worker, at| {
            let (index, name) = &names[at];
            let package = self.room.judges[*index].binary[1];
            let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
            let mut test = match known.iter().position(|test| test.package == package && test.name == *name) {
                Some(at) => known.swap_remove(at),
                None => {
                    drop(known);
                    let lines = file.with_extension(format!("lines{worker}"));
                    judge::learn(&self.built[*index], &self.folder(*index), name.clone(), &lines)?
                }
            };
            (test.program, test.package) = (*index, package.to_owned());
            Ok(test)
        })?;
        let others = known.into_inner().unwrap_or_else(PoisonError::into_inner);
        let written = judge::written(texts, others.iter().chain(&learned));
        fs::write(file, written).map_err(|error| told(file, &error))?;
        Ok(learned)
    }

    /// Returns the working folder of a judge: the folder of its package.
    fn folder(&self, judge: usize) -> PathBuf {
        workspace::root().join(self.room.judges[judge].binary[1].trim_start_matches("framegraph-"))
    }

    /// Runs the quick tests for each mutant, and the slow ones if the quick tests are `done`. Reports each result by
    /// index. WGSL mutants run on one thread per processor.
    ///
    /// # Errors
    /// A file cannot be written, a program cannot be started, or a test fails without a mutant.
    pub fn fates(
        &self,
        mutants: &[Mutant],
        done: bool,
        told: impl Fn(usize, Fate) + Sync,
    ) -> Result<Vec<Fate>, Failure> {
        workers::share(workers::processors(), mutants.len(), |worker, index| {
            let fate = self.fate(&mutants[index], done, worker)?;
            told(index, fate);
            Ok(fate)
        })
    }

    fn fate(&self, mutant: &Mutant, done: bool, worker: usize) -> Result<Fate, Failure> {
        match self.kept.of(mutant) {
            Some(Fate::Left) if done => {}
            Some(fate) => return Ok(fate),
            None => {}
        }
        let (fate, test) = self.tried(mutant, done, worker)?;
        self.kept.keep(mutant, fate, test);
        Ok(fate)
    }

    /// Returns the result of a mutant, and the test that detected it.
    fn tried(&self, mutant: &Mutant, done: bool, worker: usize) -> Result<(Fate, &str), Failure> {
        let source = self.sources.get(&mutant.file).map_or("", String::as_str);
        let planted = mutant.planted(source);
        let folder = workspace::root().join(format!("target/mutants/{}{worker}", self.room.name));
        // Removes the replaced file of an earlier mutant.
        let _ = fs::remove_dir_all(&folder);
        let path = mutant.file.trim_start_matches("shaders/wgsl/");
        write(&folder.join(path), planted.as_bytes())?;
        self.judged(&self.built, (mutant, done), Some((&folder, path)))
    }

    /// Builds the test programs, in the order of the judges; `None` if the sources do not compile.
    fn programs(&self) -> Result<Option<Vec<PathBuf>>, Failure> {
        let mut programs = Vec::new();
        for Judge { binary, .. } in self.room.judges {
            // An optimized build halves the time of the tests.
            let mut cargo = workspace::cargo(&["test", "--release", "--quiet", "--no-run", "--message-format=json"]);
            cargo.current_dir(workspace::root()).args(*binary);
            let output = cargo.output().map_err(|error| Failure::Failed(format!("cargo: {error}")))?;
            if !output.status.success() {
                return Ok(None);
            }
            let messages = String::from_utf8_lossy(&output.stdout);
            // Cargo's JSON also lists programs that the test starts; the one built as a test is wanted.
            let is_test = |line: &&str| {
                let profile = line.split_once("\"profile\":{").and_then(|(_, rest)| rest.split_once('}'));
                profile.is_some_and(|(profile, _)| profile.contains("\"test\":true"))
            };
            let tests = messages.lines().filter(is_test);
            let mut named = tests.filter_map(|line| line.split_once("\"executable\":\"")?.1.split('"').next());
            let program = named.next_back().ok_or_else(|| Failure::Failed("cargo reported no test program".into()))?;
            programs.push(PathBuf::from(program.replace("\\\\", "\\")));
        }
        Ok(Some(programs))
    }

    /// Copies a test program without a mutant, so that later builds in this workspace do not replace it.
    fn copied(&self, judge: usize, program: &Path) -> Result<PathBuf, Failure> {
        let folder = workspace::root().join("target/mutants/judges");
        let copy = folder.join(format!("{}{judge}", self.room.name));
        // A running copy of an interrupted run cannot be overwritten.
        let _ = fs::remove_file(&copy);
        let made = fs::create_dir_all(&folder).and_then(|()| fs::copy(program, &copy));
        made.map_err(|error| told(&copy, &error))?;
        Ok(copy)
    }

    /// Runs tests until one fails: quick tests, or slow ones if the quick tests are `done`, within the time of
    /// [`judge::ASKED`].
    fn judged(
        &self,
        programs: &[PathBuf],
        (mutant, done): (&Mutant, bool),
        replaced: Replaced<'_>,
    ) -> Result<(Fate, &str), Failure> {
        let all = judge::asked(&self.tests, mutant, self.kept.likely(mutant));
        let mut asked = 0.0;
        for test in all.into_iter().filter(|test| (test.seconds > judge::QUICK) == done) {
            if asked + test.seconds > judge::ASKED && asked > 0.0 {
                break;
            }
            asked += test.seconds;
            let folder = self.folder(test.program);
            match test.run(&programs[test.program], &folder, &mutant.file, replaced)? {
                Says::Passed => {}
                Says::Fell if test.is_sound(&self.built[test.program], &folder)? => {
                    return Ok((Fate::Noticed, &test.name));
                }
                Says::Fell => return Err(judge::unsound(&test.name)),
                Says::Refused => return Ok((Fate::Refused, "")),
            }
        }
        Ok((if done { Fate::Survived } else { Fate::Left }, ""))
    }
}

/// Continues an FNV-1a hash of 64 bits.
fn hash(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).and_then(|()| fs::write(path, bytes)).map_err(|error| told(path, &error))
}

fn told(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: {error}", path.display()))
}
