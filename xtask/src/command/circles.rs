//! `cargo xtask circles`: lists files that use each other.

use super::Command;
use crate::options::Options;
use crate::source::circles::circles;
use crate::source::module::Crate;
use crate::source::uses::{Uses, uses};
use crate::{Failure, workspace};
use std::path::{Path, PathBuf};

/// The command.
pub const COMMAND: Command = Command {
    name: "circles",
    summary: "list cycles of files that use each other",
    details: "\
Reads the product code of the viewer, egui, framegraph, framegraph/pack,
framegraph/queues, vulkan, shaders, scene, renderer and passes. Lists cycles of files that
use each other, directly or through others, with the names they use. Declaring a
module and re-exporting its items does not count as a use. Exit code 1 if there
is a cycle; a test of this program checks the same.
",
    run,
};

/// Packages whose files must not form cycles.
const ROOMS: [&str; 10] = [
    "viewer",
    "egui",
    "framegraph",
    "framegraph/pack",
    "framegraph/queues",
    "vulkan",
    "shaders",
    "scene",
    "renderer",
    "passes",
];

/// One cycle of files.
struct Circle {
    /// The files, from the workspace's root.
    files: Vec<PathBuf>,
    /// Uses that close the cycle: one line for each pair of files.
    lines: Vec<String>,
}

fn run(_: &Options) -> Result<(), Failure> {
    let found = found(&workspace::root()).map_err(Failure::Failed)?;
    for Circle { files, lines } in &found {
        program::line(format_args!("cycle of {} files:", files.len()));
        lines.iter().for_each(|line| program::line(format_args!("  {line}")));
    }
    if found.is_empty() {
        program::line(format_args!("no cycle of files in {}", ROOMS.join(", ")));
        return Ok(());
    }
    Err(Failure::Failed(format!("{} cycles of files", found.len())))
}

/// Returns the cycles of every package in [`ROOMS`] that exists.
fn found(root: &Path) -> Result<Vec<Circle>, String> {
    let mut all = Vec::new();
    for room in ROOMS.iter().filter(|room| root.join(room).is_dir()) {
        let read = Crate::read(root, &Path::new(room).join("src/lib.rs"))?;
        let uses = uses(&read);
        all.extend(circles(read.files.len(), &uses).into_iter().map(|files| told(&read, &uses, &files)));
    }
    Ok(all)
}

fn told(of: &Crate, uses: &Uses, files: &[usize]) -> Circle {
    let pairs = uses.iter().filter(|((from, to), _)| files.contains(from) && files.contains(to));
    let lines = pairs.map(|((from, to), names)| {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        format!("{} uses {}: {}", of.files[*from].display(), of.files[*to].display(), names.join(", "))
    });
    Circle { files: files.iter().map(|file| of.files[*file].clone()).collect(), lines: lines.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_files_form_a_cycle() {
        let found = found(&workspace::root()).expect("the rooms can be read");
        let told: Vec<String> = found.iter().map(|circle| circle.lines.join("\n")).collect();
        assert!(told.is_empty(), "files that use each other:\n\n{}", told.join("\n\n"));
    }

    /// Returns the uses of a folder of `passes` by one that stands before it in `order`.
    fn upward(order: &[&str]) -> Vec<String> {
        let read = Crate::read(&workspace::root(), Path::new("passes/src/lib.rs")).expect("the sources can be read");
        let place = |file: &Path| {
            let folder = file.strip_prefix("passes/src").ok()?.components().next()?.as_os_str().to_str()?;
            order.iter().position(|name| folder.trim_end_matches(".rs") == *name)
        };
        let uses = uses(&read);
        let files = uses.keys().map(|(from, to)| [&read.files[*from], &read.files[*to]]);
        let upward = files.filter(|files| matches!(files.map(|file| place(file)), [Some(from), Some(to)] if from < to));
        upward.map(|[from, to]| format!("{} uses {}", from.display(), to.display())).collect()
    }

    /// The table of ARCHITECTURE.md lists the folders of `passes` from the bottom up.
    #[test]
    fn folders_of_passes_use_only_those_above_their_row() {
        let map = include_str!("../../../ARCHITECTURE.md");
        let (_, after) = map.split_once("a folder uses only those above its row:").expect("the map has the table");
        let rows = after.lines().skip_while(|line| !line.starts_with("| `")).take_while(|line| line.starts_with("| `"));
        let mut order: Vec<&str> = rows.filter_map(|row| row.split('`').nth(1)).collect();
        assert!(order.len() >= 10, "{order:?}");
        assert_eq!(upward(&order), [""; 0], "the map and the uses disagree");
        order.reverse();
        assert!(upward(&order).len() > 50, "the wrong order is noticed");
    }

    #[test]
    fn a_cycle_is_reported_with_its_uses() {
        let tree = crate::tree::Tree::new(&[
            ("passes/src/lib.rs", "mod a; mod b; pub use a::A;"),
            ("passes/src/a.rs", "use super::b::B; pub struct A;"),
            ("passes/src/b.rs", "pub struct B; fn f(_: crate::A) {}"),
        ]);
        let found = found(tree.root()).expect("one room");
        let lines = ["passes/src/a.rs uses passes/src/b.rs: B", "passes/src/b.rs uses passes/src/a.rs: A"];
        assert_eq!(found.iter().map(|circle| &circle.lines[..]).collect::<Vec<_>>(), [lines]);
    }
}
