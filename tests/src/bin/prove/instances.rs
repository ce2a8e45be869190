//! Published instances of static memory planning, solved by exact search.

use crate::document::Document;
use crate::table::Table;
use framegraph::pack::{Effort, Options, Scratch, pack_watched};
use framegraph_check::csv;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Maximum number of search steps.
const BUDGET_STEPS: u64 = 100_000_000;

/// Solves every instance in the folder, sorted by name. Without a folder, notes that they were skipped.
///
/// # Errors
/// One line that names the file and the problem.
pub fn section(document: &mut Document, folder: Option<&Path>) -> Result<(), String> {
    let head = "Published instances, long run";
    let Some(folder) = folder else {
        document.section(head, "Skipped: no folder of instances was given (`--dsa DIR`).\n");
        return Ok(());
    };
    let unreadable = |path: &Path, error: std::io::Error| format!("{}: cannot be read: {error}", path.display());
    let entries = std::fs::read_dir(folder).map_err(|e| unreadable(folder, e))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "csv"));
    files.sort();
    if files.is_empty() {
        return Err(format!("{}: the folder has no instance NAME.CAPACITY.csv", folder.display()));
    }
    let columns =
        ["instance", "items", "peak", "top", "lower bound", "capacity in the name", "proved", "steps", "seconds"];
    let mut table = Table::new(&columns);
    for (index, path) in files.iter().enumerate() {
        let text = std::fs::read_to_string(path).map_err(|e| unreadable(path, e))?;
        let instance = csv::read(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let options = Options { effort: Effort::Exact, budget_steps: BUDGET_STEPS };
        let (mut offsets, start) = (Vec::new(), Instant::now());
        let packing = pack_watched(&instance.items, None, &options, &mut Scratch::default(), &mut offsets, &mut |_| {
            document.at("instances", index, files.len());
            ControlFlow::Continue(())
        });
        let seconds = start.elapsed().as_secs_f64();
        let packing = packing.map_err(|e| format!("{}: {e}", path.display()))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let (name, capacity) = name.split_once('.').unwrap_or((&name, "none"));
        let ends = instance.items.iter().zip(&offsets).map(|(item, offset)| offset + item.size);
        let top = ends.max().unwrap_or(0);
        let proved = packing.optimal && top == packing.top && !overlaps(&instance.items, &offsets);
        document.claim(proved, || format!("instance {name} is not solved in {BUDGET_STEPS} steps"));
        table.row(vec![
            name.to_owned(),
            instance.items.len().to_string(),
            packing.peak.to_string(),
            top.to_string(),
            packing.lower_bound.to_string(),
            capacity.to_owned(),
            if proved { "yes" } else { "no" }.into(),
            packing.steps.to_string(),
            format!("{seconds:.2}"),
        ]);
    }
    document.section(
        head,
        &format!(
            "The \"challenging\" instances of minimalloc (Apache-2.0) from `--dsa`, solved on one thread. The name contains \
             a\ncapacity that is known to be feasible. Offsets are checked pair by pair.\n\n{}",
            table.text()
        ),
    );
    Ok(())
}

/// Returns true if two items with overlapping lifetimes share a byte.
pub fn overlaps(items: &[framegraph::pack::Interval], offsets: &[u64]) -> bool {
    items.iter().zip(offsets).enumerate().any(|(index, (a, at))| {
        let others = items.iter().zip(offsets).skip(index + 1);
        others
            .into_iter()
            .any(|(b, bt)| a.lower < b.upper && b.lower < a.upper && *at < bt + b.size && *bt < at + a.size)
    })
}
