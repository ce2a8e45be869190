//! `cargo xtask mutants`: mutation testing of shaders.

use super::Command;
use crate::Failure;
use crate::mutant::document::{Tried, document};
use crate::mutant::explained::why;
use crate::mutant::plant::Mutant;
use crate::mutant::room::{ROOMS, Room};
use crate::mutant::run::{Bench, Fate};
use crate::options::Options;
use std::fs;
use std::path::Path;

/// The command.
pub const COMMAND: Command = Command {
    name: "mutants",
    summary: "plant faults one at a time, and list those that no test notices",
    details: "\
Sets of files, all of them by default:
  wgsl       shaders/wgsl; replaced when a test starts, without a rebuild
  occlusion  the shaders of ambient occlusion; replaced in the same way

For Rust, use cargo-mutants: CONTRIBUTING.md has its command.

Changes one line of the source at a time, and runs tests until one fails. Tries a
fixed sample of each set, which takes up to an hour, and prints its progress. An
interrupted run resumes if the tests are unchanged. Exit code 1 if a mutant is
neither detected nor explained in xtask/src/mutant/explained.rs.

  --all         try every mutant instead of a sample, which takes hours
  --count N     try the first N mutants instead of a sample
  --list        print the mutants without running tests
  --out FILE    write the document to FILE instead of printing it, usually
                docs/measurements/mutants.md
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    let named: Vec<&Room> = options.rooms.iter().map(|name| Room::named(name)).collect::<Result<_, _>>()?;
    let rooms = if named.is_empty() { ROOMS.iter().collect() } else { named };
    let out = options.value("--out").map(|file| crate::workspace::root().join(file));
    if options.has("--list") {
        if out.is_some() {
            return Err(Failure::Usage("`--out` cannot be combined with `--list`, which makes no document".to_owned()));
        }
        for room in rooms {
            let mutants = room.mutants()?;
            let count = count(room, options, mutants.len())?;
            mutants.iter().take(count).for_each(|mutant| program::line(format_args!("{}", shown(mutant))));
        }
        return Ok(());
    }
    // The run takes an hour, so an output file that cannot be written is reported first.
    out.as_deref().map_or(Ok(()), writable)?;
    let mut tried = Vec::new();
    for room in rooms {
        tried.push(try_room(room, options)?);
    }
    let text = document(&tried);
    match out {
        Some(file) => {
            // Writes a temporary file first, so that a full disk keeps the old document.
            let part = file.with_extension("part");
            let written = fs::write(&part, text).and_then(|()| fs::rename(&part, &file));
            written.map_err(|error| unwritable(&file, &error))?;
        }
        None => program::print(text),
    }
    let left: usize =
        tried.iter().map(|t| t.fates.iter().filter(|(m, f)| *f == Fate::Survived && why(m).is_none()).count()).sum();
    if left == 0 { Ok(()) } else { Err(Failure::Failed(format!("{left} mutants are neither detected nor explained"))) }
}

fn unwritable(file: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: cannot be written: {error}", file.display()))
}

/// Checks that a file can be written, without changing it.
fn writable(file: &Path) -> Result<(), Failure> {
    let is_new = fs::symlink_metadata(file).is_err();
    let opened = fs::File::options().append(true).create(true).open(file);
    opened.map_err(|error| unwritable(file, &error))?;
    if is_new { fs::remove_file(file).map_err(|error| unwritable(file, &error)) } else { Ok(()) }
}

/// Returns the number of mutants to try.
fn count(room: &Room, options: &Options, possible: usize) -> Result<usize, Failure> {
    let asked = match options.value("--count") {
        Some(text) => {
            let wrong = || Failure::Usage(format!("`--count {}` is not a number", text.to_string_lossy()));
            text.to_str().and_then(|text| text.parse().ok()).ok_or_else(wrong)?
        }
        None => room.sample,
    };
    Ok(if options.has("--all") { possible } else { asked.min(possible) })
}

/// Formats a mutant: file, line, and the code before and after.
fn shown(mutant: &Mutant) -> String {
    let Mutant { file, line, before, after, .. } = mutant;
    format!("{file}:{line}: {before}  ->  {after}")
}

fn try_room(room: &'static Room, options: &Options) -> Result<Tried, Failure> {
    let mutants = room.mutants()?;
    let possible = mutants.len();
    let count = count(room, options, possible)?;
    program::note(format_args!("{}: running the tests without a mutant", room.name));
    let bench = Bench::new(room)?;
    let asked: Vec<Mutant> = mutants.into_iter().take(count).collect();
    let told = |index: usize, fate: Fate, mutant: &Mutant| {
        let word = match fate {
            Fate::Left | Fate::Survived if why(mutant).is_some() => "explained",
            Fate::Survived => "SURVIVED",
            Fate::Left => "passes quick tests",
            Fate::Refused => "invalid",
            Fate::Noticed => "detected",
        };
        program::note(format_args!("{} {}/{count}: {word}: {}", room.name, index + 1, shown(mutant)));
    };
    let quick = bench.fates(&asked, false, |index, fate| told(index, fate, &asked[index]))?;
    // Slow tests are not run for mutants that are known to be undetectable.
    let (mut fates, mut left) = (Vec::new(), Vec::new());
    for (mutant, fate) in asked.into_iter().zip(quick) {
        match fate {
            Fate::Left if why(&mutant).is_none() => left.push(mutant),
            Fate::Left => fates.push((mutant, Fate::Survived)),
            _ => fates.push((mutant, fate)),
        }
    }
    program::note(format_args!("{}: {} mutants pass the quick tests", room.name, left.len()));
    let found = bench.fates(&left, true, |index, fate| told(index, fate, &left[index]))?;
    fates.extend(left.into_iter().zip(found));
    fates.sort_by(|(a, _), (b, _)| (&a.file, a.line, &a.after).cmp(&(&b.file, b.line, &b.after)));
    Ok(Tried { name: room.name, possible, fates })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_written_is_said_and_nothing_is_changed() {
        let folder = std::env::temp_dir().join(format!("xtask-writable-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder for temporary files");
        let [old, new] = ["old", "new"].map(|name| folder.join(name));
        fs::write(&old, "text").expect("the folder is ours");
        assert_eq!((writable(&old), writable(&new)), (Ok(()), Ok(())));
        assert_eq!((fs::read_to_string(&old).ok().as_deref(), new.exists()), (Some("text"), false));
        for refused in [&folder, &folder.join("gone/a.md")] {
            let told = writable(refused).map_err(|told| told.to_string());
            assert!(told.is_err_and(|told| told.contains("cannot be written")), "{}", refused.display());
        }
        fs::remove_dir_all(&folder).expect("the folder is ours");
    }
}
