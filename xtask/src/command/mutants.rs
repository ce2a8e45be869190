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
    if options.has("--list") {
        for room in rooms {
            let mutants = room.mutants()?;
            let count = count(room, options, mutants.len())?;
            mutants.iter().take(count).for_each(|mutant| program::line(format_args!("{}", shown(mutant))));
        }
        return Ok(());
    }
    let mut tried = Vec::new();
    for room in rooms {
        tried.push(try_room(room, options)?);
    }
    let text = document(&tried);
    match options.value("--out") {
        Some(file) => {
            let told = |error| Failure::Failed(format!("{}: {error}", file.to_string_lossy()));
            fs::write(crate::workspace::root().join(file), text).map_err(told)?;
        }
        None => program::print(text),
    }
    let left: usize =
        tried.iter().map(|t| t.fates.iter().filter(|(m, f)| *f == Fate::Survived && why(m).is_none()).count()).sum();
    if left == 0 { Ok(()) } else { Err(Failure::Failed(format!("{left} faults are neither noticed nor explained"))) }
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
