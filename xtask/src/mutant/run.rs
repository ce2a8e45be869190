//! Faults tried one after the other. WGSL is replaced when tests start, so that nothing is built anew; Rust is built in a copy of
//! the workspace, which the sources of this one never leave.

use crate::mutant::kept::Kept;
use crate::mutant::plant::{Language, Mutant};
use crate::mutant::room::{Group, Room};
use crate::{Failure, workspace};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What became of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// The compiler refuses it; it does not count.
    Refused,
    /// A test falls.
    Noticed,
    /// All tests pass.
    Survived,
}

/// Where faults are tried.
pub struct Bench<'a> {
    room: &'a Room,
    /// The workspace that is built: this one, or its copy.
    tree: PathBuf,
    build: PathBuf,
    /// The tests' programs where no fault has them built anew.
    built: Programs,
    kept: Kept,
    /// The room's files as they were at first: the workspace may go on meanwhile.
    sources: BTreeMap<String, String>,
}

/// Programs of tests by the options that choose them.
type Programs = BTreeMap<&'static [&'static str], PathBuf>;

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
        let kept_in = workspace::root().join("target/mutants").join(format!("{}.fates", room.name));
        let (kept, sources) = (Kept::read(&kept_in, 0), room.sources()?);
        let mut bench = Self { room, tree, build, built: Programs::new(), kept, sources };
        bench.built = bench.programs()?.ok_or_else(|| Failure::Failed("the tests do not compile".into()))?;
        let mut judge = 0;
        for program in bench.built.values() {
            let bytes = fs::read(program).map_err(|error| told(program, &error))?;
            judge =
                bytes.iter().fold(judge, |hash: u64, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3));
        }
        bench.kept = Kept::read(&kept_in, judge);
        if !bench.kept.sound {
            bench.judge(&bench.built, "", None)?;
            bench.kept.begin(judge);
        }
        Ok(bench)
    }

    /// Plants a fault, runs the tests, and takes it out again.
    ///
    /// # Errors
    /// When a file cannot be written, or a program cannot be started.
    pub fn fate(&self, mutant: &Mutant) -> Result<Fate, Failure> {
        if let Some(fate) = self.kept.of(mutant) {
            return Ok(fate);
        }
        let fate = self.tried(mutant)?;
        self.kept.keep(mutant, fate);
        Ok(fate)
    }

    fn tried(&self, mutant: &Mutant) -> Result<Fate, Failure> {
        let source = self.sources.get(&mutant.file).map_or("", String::as_str);
        let planted = mutant.planted(source);
        if self.room.language == Language::Wgsl {
            let folder = workspace::root().join("target/mutants/wgsl");
            // What an earlier fault has left.
            let _ = fs::remove_dir_all(&folder);
            let path = mutant.file.trim_start_matches("shaders/wgsl/");
            write(&folder.join(path), planted.as_bytes())?;
            return self.judge(&self.built, &mutant.file, Some((&folder, path)));
        }
        let file = self.tree.join(&mutant.file);
        let sound = fs::read(&file).map_err(|error| told(&file, &error))?;
        write(&file, planted.as_bytes())?;
        let fate = self.programs().and_then(|built| match built {
            None => Ok(Fate::Refused),
            Some(programs) => self.judge(&programs, &mutant.file, None),
        });
        write(&file, &sound)?;
        fate
    }

    /// The programs of the groups by their options; none if the sources do not compile.
    fn programs(&self) -> Result<Option<Programs>, Failure> {
        let mut programs = Programs::new();
        for Group { binary, .. } in self.room.groups {
            if programs.contains_key(binary) {
                continue;
            }
            let mut cargo = workspace::cargo(&["test", "--quiet", "--no-run", "--message-format=json"]);
            // Features as the tests across rooms have them.
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
            let program = PathBuf::from(program.replace("\\\\", "\\"));
            if self.room.language == Language::Rust {
                programs.insert(*binary, program);
                continue;
            }
            // A copy, so that whoever builds in this workspace meanwhile does not change the judge.
            let copy = self.build.join("mutants").join(format!("judge{}", programs.len()));
            let folder = fs::create_dir_all(self.build.join("mutants"));
            folder.and_then(|()| fs::copy(&program, &copy)).map_err(|error| told(&copy, &error))?;
            programs.insert(*binary, copy);
        }
        Ok(Some(programs))
    }

    /// Runs group after group until a test falls: those that can notice a fault of `file`, or all for no file.
    fn judge(&self, programs: &Programs, file: &str, replaced: Option<(&Path, &str)>) -> Result<Fate, Failure> {
        let noticing = |group: &&Group| file.is_empty() || group.of.iter().any(|start| file.starts_with(start));
        for Group { binary, filters, .. } in self.room.groups.iter().filter(noticing) {
            let mut command = Command::new(&programs[binary]);
            command.args(*filters).current_dir(self.tree.join(binary[1].trim_start_matches("framegraph-")));
            command.env("NODEVICE_SELECT", "1").env("RUST_BACKTRACE", "0");
            if let Some((folder, _)) = replaced {
                command.env("FRAMEGRAPH_WGSL", folder);
            }
            let output = command.output().map_err(|error| Failure::Failed(format!("the tests: {error}")))?;
            if output.status.success() {
                continue;
            }
            let text = String::from_utf8_lossy(&output.stdout);
            if file.is_empty() {
                let fallen = text.lines().filter(|line| line.ends_with("... FAILED")).collect::<Vec<_>>().join("; ");
                return Err(Failure::Failed(format!("without any fault: {fallen}")));
            }
            // A text that does not compile is refused with its place.
            let refused = replaced.is_some_and(|(_, path)| text.contains(&format!("{path}:")));
            return Ok(if refused { Fate::Refused } else { Fate::Noticed });
        }
        Ok(Fate::Survived)
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).and_then(|()| fs::write(path, bytes)).map_err(|error| told(path, &error))
}

fn told(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: {error}", path.display()))
}
