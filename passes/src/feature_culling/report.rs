//! Facts as text and as JSON. `docs/design/feature-culling.md` documents the fields.

use super::decided::Facts;
use super::fact::{Decision, Fact, Proof};
use super::savings::{Cost, Saved};
use std::fmt::Write as _;

/// The version of the JSON form; it counts up when a field changes its meaning or goes.
pub const FACTS_VERSION: u32 = 1;

impl Facts {
    /// A line for each row, what is dropped first: effect, class, reason, what it saves where that is known.
    #[must_use]
    pub fn text(&self, saved: &[Saved]) -> String {
        let mut out = String::new();
        let of = |decision| self.rows.iter().filter(move |row: &&Fact| row.decision == decision);
        for row in of(Decision::Dropped).chain(of(Decision::Kept)) {
            let Fact { effect, decision, proof, reason } = row;
            let saved = saved.iter().find(|saved| saved.effect == *effect).map_or(String::new(), |s| {
                let passes = i64::from(s.with.passes) - i64::from(s.without.passes);
                let moved = mebibytes(s.with.moved_bytes, s.without.moved_bytes);
                format!("; saves {passes} passes, {moved} moved")
            });
            _ = writeln!(out, "{} {} [{proof}]: {reason}{saved}", decision.word(), effect.name());
        }
        for (proof, reason) in &self.always {
            _ = writeln!(out, "left out [{proof}]: {reason}");
        }
        out
    }

    /// One object: `schema`, `version`, `facts` with a row each, and `always`; ends in a line feed.
    #[must_use]
    pub fn json(&self, saved: &[Saved]) -> String {
        let mut out =
            format!("{{\n  \"schema\": \"framegraph-facts\",\n  \"version\": {FACTS_VERSION},\n  \"facts\": [");
        for (index, row) in self.rows.iter().enumerate() {
            let found = saved.iter().find(|saved| saved.effect == row.effect);
            let cost = |cost: Option<&Cost>| cost.map_or_else(|| "null".to_owned(), cost_json);
            _ = write!(
                out,
                "{}\n    {{\"effect\": {}, \"decision\": {}, {}, \"reason\": {}, \"with\": {}, \"without\": {}, \"ms\": {}}}",
                if index == 0 { "" } else { "," },
                quoted(row.effect.name()),
                quoted(row.decision.word()),
                proof_json(row.proof),
                quoted(&row.reason),
                cost(found.map(|s| &s.with)),
                cost(found.map(|s| &s.without)),
                found.and_then(|s| s.ms).map_or_else(|| "null".into(), |[a, b]| format!("[{a:.4}, {b:.4}]")),
            );
        }
        out += "\n  ],\n  \"always\": [";
        for (index, (proof, reason)) in self.always.iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            _ = write!(out, "{comma}\n    {{{}, \"reason\": {}}}", proof_json(*proof), quoted(reason));
        }
        out + "\n  ]\n}\n"
    }
}

fn mebibytes(with: u64, without: u64) -> String {
    let less = with as f64 - without as f64;
    format!("{:.2} MiB", less / f64::from(1 << 20))
}

fn proof_json(proof: Proof) -> String {
    format!("\"class\": {}, \"bound\": {}", quoted(proof.class()), quoted(&proof.bound()))
}

fn cost_json(cost: &Cost) -> String {
    let Cost { passes, loads, stores, moved_bytes, memory_bytes } = cost;
    format!(
        "{{\"passes\": {passes}, \"loads\": {loads}, \"stores\": {stores}, \"moved_bytes\": {moved_bytes}, \
         \"memory_bytes\": {memory_bytes}}}"
    )
}

/// A JSON string.
fn quoted(text: &str) -> String {
    let mut out = String::from('"');
    for letter in text.chars() {
        match letter {
            '"' | '\\' => out.extend(['\\', letter]),
            control if control < ' ' => _ = write!(out, "\\u{:04x}", u32::from(control)),
            other => out.push(other),
        }
    }
    out + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_escaped() {
        assert_eq!(quoted("a \"b\" \\ c\n°"), "\"a \\\"b\\\" \\\\ c\\u000a°\"");
    }
}
