//! Mutation tests of the oracle: correct plans with a single change must be reported as a violation or as waste.
//!
//! Exceptions are listed in [`excuse`], each with the reason why the changed field does not matter.
//!
//! ```
//! use framegraph_check::mutation::MutationReport;
//! use framegraph_check::generate::{self, Entropy, Profile};
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

use crate::check::{Rule, examine};
use framegraph::decision::Reason;
use framegraph::options::{Alias, Order};
use framegraph::plan::{LoadOp, Placement, Plan};
use mutator::Mutator;
use std::collections::BTreeMap;

/// Result of mutating correct plans.
#[derive(Debug, Default)]
pub struct MutationReport {
    /// Number of mutated plans.
    pub plans: usize,
    /// Number of mutants.
    pub mutants: usize,
    /// Number of reported mutants.
    pub caught: usize,
    /// Number of mutants and of reported mutants, by field.
    pub fields: BTreeMap<&'static str, (usize, usize)>,
    /// Number of equivalent mutants, by field and reason.
    pub excused: BTreeMap<(&'static str, &'static str), usize>,
    /// Descriptions of the other mutants, which the oracle wrongly accepts.
    pub alive: Vec<String>,
}

impl MutationReport {
    /// Adds the mutants of a correct plan.
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

/// Calls `visit` with every mutant of a plan.
pub fn mutants(plan: &Plan, visit: &mut dyn FnMut(Mutant)) {
    let mut mutator = Mutator { plan, visit };
    mutator.with("compilation", 0, |p| *p.compilation = 0);
    steps::steps(&mut mutator);
    steps::attachments(&mut mutator);
    places::resources(&mut mutator);
    places::slots(&mut mutator);
    places::memory(&mut mutator);
    log::decisions(&mut mutator);
    log::barriers(&mut mutator);
}

/// Returns the reason why an unreported mutant is equivalent to the plan; `None` if it is not.
pub fn excuse(good: &Plan, mutant: &Mutant) -> Option<&'static str> {
    let Mutant { field, row, plan } = mutant;
    match *field {
        "attachment.clear" => {
            let a = plan.attachments()[*row];
            if a.load != LoadOp::Clear && a.stencil_load != LoadOp::Clear {
                return Some("the clear value is unused, because neither op clears");
            }
            let value = |p: &Plan| p.graph().clears().get(p.attachments()[*row].clear as usize).copied();
            let same = value(good).is_some() && value(good) == value(plan);
            same.then_some("the other index has the same value, bit for bit")
        }
        "memory.peak" => {
            // In a heap, any of several steps with the most live bytes may be named.
            let heap = good.options().alias == Alias::Heap && good.caps().placed;
            heap.then_some("the other step has as many live bytes")
        }
        "memory.lower_bound" => {
            // The bound is below the size of the packing; only a search could verify it.
            let open = !good.memory().optimal && good.options().alias == Alias::Heap;
            open.then_some("any bound between the peak and the size may be valid")
        }
        "resource.offset" => moved_freely(good, plan, *row),
        "step order" | "pass order" => {
            // The run shows that the exchanged passes are independent; only the log describes the old order.
            let free = good.options().order == Order::Optimized;
            let reported = !examine(plan).is_clean();
            (free && reported).then_some("any order with correct reads is valid")
        }
        "barrier.aliases" => {
            let named = |p: &Plan| p.resources()[p.barriers()[*row].aliases.index()].last;
            let tie = named(good) == named(plan);
            tie.then_some("both resources used the memory until the same step")
        }
        "decision.reason" => {
            let (from, to) = (good.decisions()[*row].reason, plan.decisions()[*row].reason);
            may_replace(from, to).then_some("both reasons are true")
        }
        _ => None,
    }
}

/// Accepts a heap offset that is aligned, within the heap, overlaps no live resource, and follows the same resource.
fn moved_freely(good: &Plan, mutant: &Plan, row: usize) -> Option<&'static str> {
    let range = |p: &Plan, r: usize| match p.resources()[r].placement {
        Placement::Heap { offset } => Some((offset, offset + p.resources()[r].bytes.max(1))),
        _ => None,
    };
    let own = &mutant.resources()[row];
    let (start, end) = range(mutant, row)?;
    let texture = good.graph().resources()[row].desc.texture().is_some();
    let alignment = if texture { good.caps().texture_alignment_bytes } else { good.caps().buffer_alignment_bytes };
    if !start.is_multiple_of(alignment) {
        return None;
    }
    for (other, neighbour) in good.resources().iter().enumerate() {
        let Some((s, e)) = range(good, other).filter(|_| other != row) else {
            continue;
        };
        let alive = neighbour.first <= own.last && own.first <= neighbour.last;
        if alive && start < e && s < end {
            return None;
        }
    }
    Some("any aligned, free offset within the heap is valid")
}

/// Returns `true` if both reasons can be true at the same time.
fn may_replace(from: Reason, to: Reason) -> bool {
    question(from) == question(to) && question(from) != 0
}

/// Returns a number for groups of reasons that can be true at the same time; 0 for other reasons.
fn question(reason: Reason) -> u8 {
    use Reason as R;
    match reason {
        // A pass can be needed for several outputs, by several readers.
        R::KeptSideEffect | R::KeptExport(_) | R::KeptImport(_) | R::KeptHistory(_) | R::KeptReadBy(..) => 1,
        // Several outputs and parts can be unused for different reasons.
        R::CulledUnread(_) | R::CulledReaderCulled(..) | R::CulledOverwritten(..) => 2,
        // Several objections can exist.
        R::Split(..) => 3,
        R::NotInlined(..) => 4,
        R::NeedsMemory(_) => 5,
        // Several parts can be loaded, stored or dropped.
        R::LoadWritten(_) | R::LoadEntry => 6,
        R::StoreReadBy(_) | R::StoreResolved(_) | R::StoreExport | R::StoreImport | R::StoreHistory => 7,
        R::DiscardUnread | R::DiscardOverwritten | R::StoreUnchanged => 8,
        _ => 0,
    }
}

/// Returns `true` if the oracle reports a mutant. The log describes the rest of the plan, so an incorrect row only
/// counts if the log itself was changed.
pub fn is_caught(mutant: &Mutant) -> bool {
    let report = examine(&mutant.plan);
    let log = mutant.field.starts_with("decision");
    let mut violations = report.violations.iter();
    violations.any(|v| log || v.rule != Rule::Decision) || !report.wastes.is_empty()
}

/// Describes the change.
fn difference(good: &Plan, mutant: &Mutant) -> String {
    let rows = |p: &Plan| {
        let mut words: Vec<String> = vec![format!("{:?}", p.pass_steps()), format!("{:?}", p.memory())];
        words.extend(p.steps().iter().map(|r| format!("{r:?}")));
        words.extend(p.step_passes().iter().map(|r| format!("{r:?}")));
        words.extend(p.attachments().iter().map(|r| format!("{r:?}")));
        words.extend(p.resources().iter().map(|r| format!("{r:?}")));
        words.extend(p.slots().iter().map(|r| format!("{r:?}")));
        words.extend(p.barriers().iter().map(|r| format!("{r:?}")));
        words.extend(p.decisions().iter().map(|r| format!("{r:?}")));
        words
    };
    let (before, after) = (rows(good), rows(&mutant.plan));
    let changed = before.iter().zip(&after).find(|(a, b)| a != b);
    changed.map_or_else(String::new, |(a, b)| format!("{a} became {b}"))
}
