//! Is the oracle awake? Good plans, broken in one place at a time: each mutant must be reported, as a violation or as
//! waste. What it may overlook is listed in [`excuse`], each with the proof that the field does not matter there.
//!
//! ```
//! use framegraph::testing::mutation::MutationReport;
//! use framegraph::testing::generate::{self, Entropy, Profile};
//! use framegraph::{Caps, Plan, Scratch, compile};
//!
//! let graph = generate::graph(&mut Entropy::seeded(7), &Profile { max_passes: 3, ..Profile::default() });
//! let mut plan = Plan::new();
//! compile(&graph, &Caps::tiler(), &generate::options_of(0), &mut Scratch::new(), &mut plan)?;
//! let mut report = MutationReport::default();
//! report.take(&plan);
//! assert!(report.mutants > 100 && report.alive.is_empty());
//! # Ok::<(), framegraph::CompileErrors>(())
//! ```

mod log;
mod mutator;
mod places;
mod steps;
#[cfg(test)]
mod tests;

pub use mutator::Mutant;

use crate::decision::Reason;
use crate::options::{Alias, Order};
use crate::plan::{LoadOp, Placement, Plan};
use crate::testing::check::{Rule, examine};
use mutator::Mutator;
use std::collections::BTreeMap;

/// What became of the mutants of good plans.
#[derive(Debug, Default)]
pub struct MutationReport {
    /// Plans that were mutated.
    pub plans: usize,
    /// Mutants of all of them.
    pub mutants: usize,
    /// How many were reported.
    pub caught: usize,
    /// Mutants, and how many of them were reported, by field.
    pub fields: BTreeMap<&'static str, (usize, usize)>,
    /// How many of a field were as good as the plan, by field and the proof of it.
    pub excused: BTreeMap<(&'static str, &'static str), usize>,
    /// The others, a line each: faults of the oracle.
    pub alive: Vec<String>,
}

impl MutationReport {
    /// Adds the mutants of a plan that the oracle has nothing against.
    pub fn take(&mut self, good: &Plan) {
        self.plans += 1;
        mutants(good, &mut |mutant| {
            let caught = is_caught(&mutant);
            self.mutants += 1;
            self.caught += usize::from(caught);
            let of_field = self.fields.entry(mutant.field).or_default();
            *of_field = (of_field.0 + 1, of_field.1 + usize::from(caught));
            if caught {
                return;
            }
            if let Some(proof) = excuse(good, &mutant) {
                *self.excused.entry((mutant.field, proof)).or_default() += 1;
            } else {
                let Mutant { field, row, .. } = mutant;
                self.alive.push(format!("{field} of row {row}: {}", difference(good, &mutant)));
            }
        });
    }
}

/// Visits every mutant of a plan.
pub fn mutants(plan: &Plan, visit: &mut dyn FnMut(Mutant)) {
    let mut mutator = Mutator { plan, visit };
    mutator.with("compilation", 0, |p| p.compilation = 0);
    steps::steps(&mut mutator);
    steps::attachments(&mut mutator);
    places::resources(&mut mutator);
    places::slots(&mut mutator);
    places::memory(&mut mutator);
    log::decisions(&mut mutator);
    log::barriers(&mut mutator);
}

/// Why a mutant that the oracle does not report is as good as the plan; none when it is not.
pub fn excuse(good: &Plan, mutant: &Mutant) -> Option<&'static str> {
    let Mutant { field, row, plan } = mutant;
    match *field {
        "attachment.clear" => {
            let a = plan.attachments[*row];
            if a.load != LoadOp::Clear && a.stencil_load != LoadOp::Clear {
                return Some("a clear value is read by clear ops only, and neither op clears");
            }
            let value = |p: &Plan| p.graph.clears.get(p.attachments[*row].clear as usize).copied();
            let same = value(good).is_some() && value(good) == value(plan);
            same.then_some("the other index holds the same value, bit for bit")
        }
        "memory.peak" => {
            // Which of several fullest steps is named is free in a heap.
            let heap = good.options.alias == Alias::Heap && good.caps.placed;
            heap.then_some("as many bytes are live in the other step")
        }
        "memory.lower_bound" => {
            // A bound that no packing reached: only a search could tell whether it holds.
            let open = !good.memory.optimal && good.options.alias == Alias::Heap;
            open.then_some("between the peak and the top any bound might hold")
        }
        "resource.offset" => moved_freely(good, plan, *row),
        "step order" | "pass order" => {
            // The run shows that what was exchanged does not touch each other; the log tells of the old order.
            let free = good.options.order == Order::Optimized;
            let told = !examine(plan).is_clean();
            (free && told).then_some("any order in which every read is right would do")
        }
        "barrier.hand_over" => {
            let named = |p: &Plan| p.resources[p.barriers[*row].hand_over.index()].last;
            let tie = named(good) == named(plan);
            tie.then_some("both tenants had the memory until the same step")
        }
        "decision.reason" => {
            let (from, to) = (good.decisions[*row].reason, plan.decisions[*row].reason);
            may_replace(from, to).then_some("both reasons are true, and one is enough")
        }
        _ => None,
    }
}

/// An offset in a heap that serves as well: aligned, below the same top, over no live neighbour, after the same tenant.
fn moved_freely(good: &Plan, mutant: &Plan, row: usize) -> Option<&'static str> {
    let range = |p: &Plan, r: usize| match p.resources[r].placement {
        Placement::Heap { offset } => Some((offset, offset + p.resources[r].bytes.max(1))),
        _ => None,
    };
    let own = &mutant.resources[row];
    let (start, end) = range(mutant, row)?;
    let texture = good.graph.resources[row].desc.texture().is_some();
    let alignment = if texture { good.caps.texture_alignment_bytes } else { good.caps.buffer_alignment_bytes };
    if !start.is_multiple_of(alignment) {
        return None;
    }
    for (other, neighbour) in good.resources.iter().enumerate() {
        let Some((s, e)) = range(good, other).filter(|_| other != row) else {
            continue;
        };
        let alive = neighbour.first <= own.last && own.first <= neighbour.last;
        if alive && start < e && s < end {
            return None;
        }
    }
    Some("any aligned place below the top that no live resource has is as good")
}

/// Whether two reasons answer the same question, so that both can be true at once.
fn may_replace(from: Reason, to: Reason) -> bool {
    question(from) == question(to) && question(from) != 0
}

/// Questions that can have several true answers; 0 for those that have one.
fn question(reason: Reason) -> u8 {
    use Reason as R;
    match reason {
        // A pass can be needed for several outputs, by several readers.
        R::KeptSideEffect | R::KeptExport(_) | R::KeptImport(_) | R::KeptHistory(_) | R::KeptReadBy(..) => 1,
        // Several outputs and parts can be in vain, each in its way.
        R::CulledUnread(_) | R::CulledReaderCulled(..) | R::CulledOverwritten(..) => 2,
        // Several objections can stand.
        R::Split(..) => 3,
        R::NotInlined(..) => 4,
        R::NeedsMemory(_) => 5,
        // Several parts can be loaded, stored, dropped.
        R::LoadWritten(_) | R::LoadEntry => 6,
        R::StoreReadBy(_) | R::StoreResolved(_) | R::StoreExport | R::StoreImport | R::StoreHistory => 7,
        R::DiscardUnread | R::DiscardOverwritten | R::StoreUnchanged => 8,
        _ => 0,
    }
}

/// Whether the oracle reports a mutant. The decision log is full of echoes of the plan, so where the log itself is not what
/// was changed, something else than its truth must be reported.
pub fn is_caught(mutant: &Mutant) -> bool {
    let report = examine(&mutant.plan);
    let log = mutant.field.starts_with("decision");
    let mut violations = report.violations.iter();
    violations.any(|v| log || v.rule != Rule::Decision) || !report.wastes.is_empty()
}

/// What was changed, in words.
fn difference(good: &Plan, mutant: &Mutant) -> String {
    let rows = |p: &Plan| {
        let Plan { pass_steps, steps, step_passes, attachments, resources, slots, barriers, memory, decisions, .. } =
            p.clone();
        let mut words: Vec<String> = vec![format!("{pass_steps:?}"), format!("{memory:?}")];
        words.extend(steps.iter().map(|r| format!("{r:?}")));
        words.extend(step_passes.iter().map(|r| format!("{r:?}")));
        words.extend(attachments.iter().map(|r| format!("{r:?}")));
        words.extend(resources.iter().map(|r| format!("{r:?}")));
        words.extend(slots.iter().map(|r| format!("{r:?}")));
        words.extend(barriers.iter().map(|r| format!("{r:?}")));
        words.extend(decisions.iter().map(|r| format!("{r:?}")));
        words
    };
    let (before, after) = (rows(good), rows(&mutant.plan));
    let changed = before.iter().zip(&after).find(|(a, b)| a != b);
    changed.map_or_else(String::new, |(a, b)| format!("{a} became {b}"))
}
