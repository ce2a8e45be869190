//! `cargo xtask mutants`: which planted faults no test notices.

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
Rooms, all of them if none is named, each after the other if several are:
  wgsl       shaders/wgsl; texts are replaced when tests start, so that nothing
             is built anew
  occlusion  the passes of ambient occlusion; the same
  passes     upload, view, sun and drawing; built in a copy of the workspace
  layout     shaders/src/layout; the same

Each room has a sample of its faults tried, the same ones each time. It takes
up to an hour and tells how far it is; interrupted, it goes on where it was, as
long as the tests are the same. Exit code 1 if a fault is neither
noticed nor explained in xtask/src/mutant/explained.rs.

  --all         every fault instead of a sample: hours
  --count N     the first N of them instead
  --list        print the faults that would be tried, and try none
  --out FILE    write the document there instead of printing it:
                docs/mutants.md
",
    run,
};

fn run(options: &Options) -> Result<(), Failure> {
    let named: Vec<&Room> = options.rooms.iter().map(|name| Room::named(name)).collect::<Result<_, _>>()?;
    let rooms = if named.is_empty() { ROOMS.iter().collect() } else { named };
    let out = options.value("--out").map(|file| crate::workspace::root().join(file));
    if options.has("--list") {
        if out.is_some() {
            return Err(Failure::Usage("--out does not go together with --list: no document is made".to_owned()));
        }
        for room in rooms {
            let mutants = room.mutants()?;
            let count = count(room, options, mutants.len())?;
            mutants.iter().take(count).for_each(|mutant| program::line(format_args!("{}", shown(mutant))));
        }
        return Ok(());
    }
    // The work takes an hour: what cannot be written is better said before it.
    out.as_deref().map_or(Ok(()), writable)?;
    let mut tried = Vec::new();
    for room in rooms {
        tried.push(try_room(room, options)?);
    }
    let text = document(&tried);
    match out {
        Some(file) => {
            // Beside its place first: a full disk leaves the old document.
            let part = file.with_extension("part");
            let written = fs::write(&part, text).and_then(|()| fs::rename(&part, &file));
            written.map_err(|error| unwritable(&file, &error))?;
        }
        None => program::print(text),
    }
    let left: usize =
        tried.iter().map(|t| t.fates.iter().filter(|(m, f)| *f == Fate::Survived && why(m).is_none()).count()).sum();
    if left == 0 { Ok(()) } else { Err(Failure::Failed(format!("{left} faults are neither noticed nor explained"))) }
}

fn unwritable(file: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: cannot be written: {error}", file.display()))
}

/// Whether a file can be written; nothing is changed.
fn writable(file: &Path) -> Result<(), Failure> {
    let is_new = fs::symlink_metadata(file).is_err();
    let opened = fs::File::options().append(true).create(true).open(file);
    opened.map_err(|error| unwritable(file, &error))?;
    if is_new { fs::remove_file(file).map_err(|error| unwritable(file, &error)) } else { Ok(()) }
}

/// How many of the possible faults are tried.
fn count(room: &Room, options: &Options, possible: usize) -> Result<usize, Failure> {
    let asked = match options.value("--count") {
        Some(text) => {
            let wrong = || Failure::Usage(format!("`--count {}` is no number", text.to_string_lossy()));
            text.to_str().and_then(|text| text.parse().ok()).ok_or_else(wrong)?
        }
        None => room.sample,
    };
    Ok(if options.has("--all") { possible } else { asked.min(possible) })
}

/// Where a fault is planted, and what it is.
fn shown(mutant: &Mutant) -> String {
    let Mutant { file, line, before, after, .. } = mutant;
    format!("{file}:{line}: {before}  ->  {after}")
}

fn try_room(room: &'static Room, options: &Options) -> Result<Tried, Failure> {
    let mutants = room.mutants()?;
    let possible = mutants.len();
    let count = count(room, options, possible)?;
    program::note(format_args!("{}: the tests without a fault", room.name));
    let bench = Bench::new(room)?;
    let asked: Vec<Mutant> = mutants.into_iter().take(count).collect();
    let told = |index: usize, fate: Fate, mutant: &Mutant| {
        let word = match fate {
            Fate::Left | Fate::Survived if why(mutant).is_some() => "explained",
            Fate::Survived => "SURVIVED",
            Fate::Left => "passes quick tests",
            Fate::Refused => "refused",
            Fate::Noticed => "noticed",
        };
        program::note(format_args!("{} {}/{count}: {word}: {}", room.name, index + 1, shown(mutant)));
    };
    let quick = bench.fates(&asked, false, |index, fate| told(index, fate, &asked[index]))?;
    // Tests of seconds are not asked about what no test can see.
    let (mut fates, mut left) = (Vec::new(), Vec::new());
    for (mutant, fate) in asked.into_iter().zip(quick) {
        match fate {
            Fate::Left if why(&mutant).is_none() => left.push(mutant),
            Fate::Left => fates.push((mutant, Fate::Survived)),
            _ => fates.push((mutant, fate)),
        }
    }
    program::note(format_args!("{}: {} faults pass the quick tests", room.name, left.len()));
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
