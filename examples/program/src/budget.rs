//! Limits on the cost of a plan, and the decisions that exceed them.

use crate::bytes;
use framegraph::{Decision, Plan, Reason, Subject};

/// Kind of cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Number of attachment loads.
    Loads,
    /// Number of attachment stores.
    Stores,
    /// Number of steps.
    Steps,
    /// Number of culled passes.
    Culled,
    /// Memory of transient resources, in bytes.
    Bytes,
    /// Bytes loaded and stored.
    Traffic,
}

impl Cost {
    /// Option names of every kind of cost, with synonyms.
    const NAMES: [(&'static str, Self); 9] = [
        ("loads", Self::Loads),
        ("unresolves", Self::Loads),
        ("stores", Self::Stores),
        ("resolves", Self::Stores),
        ("steps", Self::Steps),
        ("culled", Self::Culled),
        ("bytes", Self::Bytes),
        ("memory", Self::Bytes),
        ("traffic", Self::Traffic),
    ];

    const fn is_bytes(self) -> bool {
        matches!(self, Self::Bytes | Self::Traffic)
    }

    /// Returns the cost of a plan.
    fn of(self, plan: &Plan) -> u64 {
        let counts = plan.counts();
        match self {
            Self::Loads => counts.unresolves.into(),
            Self::Stores => counts.resolves.into(),
            Self::Steps => counts.steps.into(),
            Self::Culled => counts.culled.into(),
            Self::Bytes => plan.memory().bytes,
            Self::Traffic => plan.traffic(plan.frame()).total_bytes(),
        }
    }

    /// Returns whether a decision adds to this cost.
    fn is_due_to(self, plan: &Plan, decision: &Decision) -> bool {
        let loads = matches!(decision.reason, Reason::LoadWritten(_) | Reason::LoadEntry);
        let stores = matches!(
            decision.reason,
            Reason::StoreReadBy(_) | Reason::StoreExport | Reason::StoreImport | Reason::StoreHistory
        );
        match self {
            Self::Loads => loads,
            Self::Stores => stores,
            Self::Traffic => loads || stores,
            Self::Steps => matches!(decision.reason, Reason::Split(..)),
            Self::Culled => matches!(
                decision.reason,
                Reason::CulledUnread(_)
                    | Reason::CulledReaderCulled(..)
                    | Reason::CulledOverwritten(..)
                    | Reason::CulledNoOutput
            ),
            Self::Bytes => match decision.subject {
                Subject::Resource(resource) => {
                    let row = &plan.resources()[resource.index()];
                    let peak = plan.memory().peak;
                    let live = !row.first.is_none() && row.first <= peak && peak <= row.last;
                    live && matches!(
                        decision.reason,
                        Reason::SlotFirst
                            | Reason::SlotAfter(_)
                            | Reason::Placed
                            | Reason::PlacedAfter(_)
                            | Reason::AliasingOff
                            | Reason::NeedsMemory(_)
                    )
                }
                _ => false,
            },
        }
    }
}

/// Limits, in the order of the command line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Budget {
    limits: Vec<(&'static str, Cost, u64)>,
}

impl Budget {
    /// Parses `NAME=MAX,...`.
    ///
    /// # Errors
    /// One line that names the limit and the expected value.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut limits: Vec<(&str, Cost, u64)> = Vec::new();
        for limit in text.split(',') {
            let limit = limit.trim();
            let (name, max) =
                limit.split_once('=').ok_or_else(|| format!("`{limit}`: missing `=`; expected NAME=MAX"))?;
            let Some(&(name, cost)) = Cost::NAMES.iter().find(|(n, _)| *n == name) else {
                let names: Vec<_> = Cost::NAMES.iter().map(|(n, _)| *n).collect();
                return Err(format!("unknown limit `{name}`; expected {}", names.join(", ")));
            };
            let value = if cost.is_bytes() { bytes(max) } else { max.parse().ok() };
            let expected = if cost.is_bytes() { "bytes, like 200MB or 1.5GiB" } else { "a whole number" };
            let value = value.ok_or_else(|| format!("{name}: invalid value `{max}`; expected {expected}"))?;
            if limits.iter().any(|(_, c, _)| *c == cost) {
                return Err(format!("{name}: specified twice; remove one"));
            }
            limits.push((name, cost, value));
        }
        Ok(Self { limits })
    }

    /// Returns the exceeded limits with the decisions that caused them, one line each; `None` if every limit is met.
    pub fn broken(&self, plan: &Plan) -> Option<String> {
        let mut lines = Vec::new();
        for &(name, cost, max) in &self.limits {
            let is = cost.of(plan);
            if is <= max {
                continue;
            }
            let unit = if cost.is_bytes() { " B" } else { "" };
            lines.push(format!("budget exceeded: {name} {is}{unit}, limit {max}{unit}"));
            let mut blamed = 0;
            for decision in plan.decisions().iter().filter(|d| cost.is_due_to(plan, d)) {
                blamed += 1;
                lines.push(format!("  {}", blame(plan, decision)));
            }
            if cost == Cost::Steps && blamed == 0 {
                lines.push("  every step holds one pass with no earlier pass to merge with".into());
            }
        }
        (!lines.is_empty()).then(|| lines.join("\n"))
    }
}

/// Returns the sentence of a decision, with its size in bytes where it costs memory, and the hint.
fn blame(plan: &Plan, decision: &Decision) -> String {
    let sentence = plan.explained(decision);
    let bytes = match decision.subject {
        Subject::Resource(resource) => format!(" ({} B)", plan.resources()[resource.index()].bytes),
        _ => String::new(),
    };
    let hint = plan.hint(decision);
    let hint = if hint.is_empty() || sentence.ends_with(hint) { String::new() } else { format!("; {hint}") };
    format!("{sentence}{bytes}{hint}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_and_mistakes_named() {
        let budget = Budget::parse("loads=0, stores=3,bytes=200MB").expect("the limits are sound");
        let flat: Vec<_> = budget.limits.iter().map(|(name, _, max)| (*name, *max)).collect();
        assert_eq!(flat, [("loads", 0), ("stores", 3), ("bytes", 200_000_000)]);
        for (text, named) in [
            ("", "``"),
            ("loads", "expected NAME=MAX"),
            ("load=0", "unknown limit `load`"),
            ("loads=1MB", "loads: invalid value `1MB`; expected a whole number"),
            ("bytes=x", "bytes: invalid value `x`; expected bytes"),
            ("loads=1,unresolves=2", "unresolves: specified twice"),
        ] {
            let error = Budget::parse(text).expect_err(text);
            assert!(error.contains(named), "{text}: {error}");
        }
    }
}
