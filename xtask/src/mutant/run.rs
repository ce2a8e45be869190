//! Faults tried one after the other. WGSL is replaced when tests start, so that nothing is built anew; Rust is built in a copy of
//! the workspace, which the sources of this one never leave.

use crate::mutant::judge::{self, Replaced, Says, Test};
use crate::mutant::kept::Kept;
use crate::mutant::plant::{Language, Mutant};
use crate::mutant::room::{self, Judge, Room};
use crate::mutant::workers;
use crate::{Failure, workspace};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

/// What became of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// The compiler refuses it; it does not count.
    Refused,
    /// A test falls.
    Noticed,
    /// All quick tests pass, and no others were asked.
    Left,
    /// All tests pass, or those that there was time to ask.
    Survived,
}

/// Where faults are tried.
pub struct Bench<'a> {
    room: &'a Room,
    /// The workspace that is built: this one, or its copy.
    tree: PathBuf,
    build: PathBuf,
    /// The tests' programs where no fault has them built anew, in the order of the room's judges.
    built: Vec<PathBuf>,
    tests: Vec<Test>,
    kept: Kept,
    /// The room's files as they were at first: the workspace may go on meanwhile.
    sources: BTreeMap<String, String>,
}

impl<'a> Bench<'a> {
    /// A bench for the faults of a room.
    ///
    /// # Errors
    /// When the copy of the workspace cannot be made, or the tests do not compile or fail without any fault: then every fault
    /// would count as noticed.
    pub fn new(room: &'a Room) -> Result<Self, Failure> {
        let root = workspace::root();
        if room.language == Language::Wgsl {
            return Self::checked(room, root.join("target"), root);
        }
        let tree = root.join("target/mutants/tree");
        let listed = Command::new("git").current_dir(&root).args(["ls-files", "-z"]).output();
        let listed = listed.map_err(|error| Failure::Failed(format!("`git ls-files`: {error}")))?;
        for file in String::from_utf8_lossy(&listed.stdout).split('\0').filter(|file| !file.is_empty()) {
            let (from, to) = (root.join(file), tree.join(file));
            // A file that is as it was keeps its time, and is not built anew.
            let same = fs::read(&from).ok().is_some_and(|bytes| fs::read(&to).is_ok_and(|other| other == bytes));
            if !same && from.exists() {
                write(&to, &fs::read(&from).map_err(|error| told(&from, &error))?)?;
            }
        }
        // A folder of its own: cargo names what it builds by paths within a workspace, so the copy's would take the place of ours.
        Self::checked(room, root.join("target/mutants/build"), tree)
    }

    fn checked(room: &'a Room, build: PathBuf, tree: PathBuf) -> Result<Self, Failure> {
        let folder = workspace::root().join("target/mutants");
        fs::create_dir_all(&folder).map_err(|error| told(&folder, &error))?;
        let kept_in = folder.join(format!("{}.fates", room.name));
        let (kept, sources) = (Kept::default(), room.sources()?);
        let mut bench = Self { room, tree, build, built: Vec::new(), tests: Vec::new(), kept, sources };
        let built = bench.programs()?.ok_or_else(|| Failure::Failed("the tests do not compile".into()))?;
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

    /// What lines are known by: the texts that they are of.
    fn lines_of(&self) -> u64 {
        let shaders = workspace::root().join("shaders/wgsl");
        let texts = room::files(&[shaders], Language::Wgsl).unwrap_or_default().into_iter().map(fs::read);
        texts.flatten().fold(0, |known, text| hash(known, &text))
    }

    /// Every test with what it takes and compiles: as `file` has it, which all rooms share, or else as a run without a fault
    /// tells.
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

    /// The folder that a judge runs in: that of its package.
    fn folder(&self, judge: usize) -> PathBuf {
        self.tree.join(self.room.judges[judge].binary[1].trim_start_matches("framegraph-"))
    }

    /// Plants faults one by one and runs the tests: the quick ones, and the others only once those are `done`. Tells what
    /// became of each, by its index. Texts that are replaced are tried on as many threads as there are processors.
    ///
    /// # Errors
    /// When a file cannot be written, a program cannot be started, or a test falls without a fault.
    pub fn fates(
        &self,
        mutants: &[Mutant],
        done: bool,
        told: impl Fn(usize, Fate) + Sync,
    ) -> Result<Vec<Fate>, Failure> {
        let workers = if self.room.language == Language::Wgsl { workers::processors() } else { 1 };
        workers::share(workers, mutants.len(), |worker, index| {
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

    /// What became of a fault, and the test that noticed it.
    fn tried(&self, mutant: &Mutant, done: bool, worker: usize) -> Result<(Fate, &str), Failure> {
        let source = self.sources.get(&mutant.file).map_or("", String::as_str);
        let planted = mutant.planted(source);
        if self.room.language == Language::Wgsl {
            let folder = workspace::root().join(format!("target/mutants/{}{worker}", self.room.name));
            // What an earlier fault has left.
            let _ = fs::remove_dir_all(&folder);
            let path = mutant.file.trim_start_matches("shaders/wgsl/");
            write(&folder.join(path), planted.as_bytes())?;
            return self.judged(&self.built, (mutant, done), Some((&folder, path)));
        }
        let file = self.tree.join(&mutant.file);
        let sound = fs::read(&file).map_err(|error| told(&file, &error))?;
        write(&file, planted.as_bytes())?;
        let fate = self.programs().and_then(|built| match built {
            None => Ok((Fate::Refused, "")),
            Some(programs) => self.judged(&programs, (mutant, done), None),
        });
        write(&file, &sound)?;
        fate
    }

    /// The programs of the judges in their order; none if the sources do not compile.
    fn programs(&self) -> Result<Option<Vec<PathBuf>>, Failure> {
        let mut programs = Vec::new();
        for Judge { binary, .. } in self.room.judges {
            let mut cargo = workspace::cargo(&["test", "--quiet", "--no-run", "--message-format=json"]);
            // What is built once may take longer to build: the tests then take half of the time.
            if self.room.language == Language::Wgsl {
                cargo.arg("--release");
            }
            cargo.current_dir(&self.tree).args(*binary).env("CARGO_TARGET_DIR", &self.build);
            let output = cargo.output().map_err(|error| Failure::Failed(format!("cargo: {error}")))?;
            if !output.status.success() {
                return Ok(None);
            }
            let messages = String::from_utf8_lossy(&output.stdout);
            // The program that is built as a test, as cargo's JSON names it; others are what the test runs.
            let is_test = |line: &&str| {
                let profile = line.split_once("\"profile\":{").and_then(|(_, rest)| rest.split_once('}'));
                profile.is_some_and(|(profile, _)| profile.contains("\"test\":true"))
            };
            let tests = messages.lines().filter(is_test);
            let mut named = tests.filter_map(|line| line.split_once("\"executable\":\"")?.1.split('"').next());
            let program = named.next_back().ok_or_else(|| Failure::Failed("cargo names no program of tests".into()))?;
            programs.push(PathBuf::from(program.replace("\\\\", "\\")));
        }
        Ok(Some(programs))
    }

    /// A copy of a program of tests without a fault: whoever builds in this workspace meanwhile, or a fault that is built where
    /// it was, does not change the judge.
    fn copied(&self, judge: usize, program: &Path) -> Result<PathBuf, Failure> {
        let folder = self.build.join("mutants/judges");
        let copy = folder.join(format!("{}{judge}", self.room.name));
        // One that an interrupted run has left running cannot be written over.
        let _ = fs::remove_file(&copy);
        let made = fs::create_dir_all(&folder).and_then(|()| fs::copy(program, &copy));
        made.map_err(|error| told(&copy, &error))?;
        Ok(copy)
    }

    /// Runs test after test until one falls: the quick tests, or when they are `done` the others, as long as
    /// [`judge::ASKED`] says.
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

/// FNV-1a of 64 bits, going on from `hash`.
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
