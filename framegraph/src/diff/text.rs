//! Text form of a diff: one line per change, with `-` for the first and `+` for the second plan.

use super::{Change, Diff};
use crate::dump;
use crate::sanitize::escape_controls;
use std::fmt;

impl fmt::Display for Diff {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return writeln!(f, "no change");
        }
        let Self {
            passes_added,
            passes_removed,
            culls,
            merges,
            totals,
            resources_added,
            resources_removed,
            resources,
            reasons,
        } = self;
        one_sided(f, "passes", passes_removed, passes_added)?;
        section(f, "culling", culls, |f, c| {
            let now = if c.culled { "now culled" } else { "runs again" };
            writeln!(f, "  {}: {now}: {}", escape_controls(&c.pass), escape_controls(&c.reason))
        })?;
        section(f, "steps", merges, |f, Change { what, before, after }| {
            writeln!(
                f,
                "  {}: was {}, is {}",
                escape_controls(what),
                escape_controls(&mates(before)),
                escape_controls(&mates(after))
            )
        })?;
        section(f, "totals", totals, total)?;
        one_sided(f, "resources", resources_removed, resources_added)?;
        section(f, "placements", resources, |f, Change { what, before, after }| {
            writeln!(f, "  {}: {} -> {}", escape_controls(what), escape_controls(before), escape_controls(after))
        })?;
        section(f, "reasons", reasons, |f, Change { what, before, after }| {
            writeln!(f, "  {}", escape_controls(what))?;
            let mut gone = before.iter().filter(|s| !after.contains(s));
            gone.try_for_each(|s| writeln!(f, "    - {}", escape_controls(s)))?;
            let mut new = after.iter().filter(|s| !before.contains(s));
            new.try_for_each(|s| writeln!(f, "    + {}", escape_controls(s)))
        })
    }
}

fn section<T>(
    f: &mut fmt::Formatter<'_>,
    head: &str,
    rows: &[T],
    mut row: impl FnMut(&mut fmt::Formatter<'_>, &T) -> fmt::Result,
) -> fmt::Result {
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(f, "{head}:")?;
    rows.iter().try_for_each(|r| row(f, r))
}

fn one_sided(f: &mut fmt::Formatter<'_>, head: &str, gone: &[String], new: &[String]) -> fmt::Result {
    let rows: Vec<_> = gone.iter().map(|n| ('-', n)).chain(new.iter().map(|n| ('+', n))).collect();
    section(f, head, &rows, |f, (sign, name)| writeln!(f, "  {sign} {}", escape_controls(name)))
}

fn mates(names: &[String]) -> String {
    match names {
        [] => "alone".into(),
        names => format!("with {}", names.join(", ")),
    }
}

fn total(f: &mut fmt::Formatter<'_>, change: &Change<u64>) -> fmt::Result {
    let &Change { ref what, before, after } = change;
    let sign = if after >= before { '+' } else { '-' };
    let by = after.abs_diff(before);
    let name = total_name(what);
    if what.ends_with("_bytes") {
        let (before, after, by) = (dump::bytes(before), dump::bytes(after), dump::bytes(by));
        writeln!(f, "  {name}: {before} -> {after} ({sign}{by})")
    } else if what == "optimal" {
        writeln!(f, "  {name}: {} -> {}", before != 0, after != 0)
    } else {
        writeln!(f, "  {name}: {before} -> {after} ({sign}{by})")
    }
}

/// Returns the name of a total in text, where loads and stores have the names of their operations.
fn total_name(what: &str) -> &str {
    match what {
        "unresolves" => "loads",
        "resolves" => "stores",
        "unresolve_bytes" => "loaded_bytes",
        "resolve_bytes" => "stored_bytes",
        other => other,
    }
}
