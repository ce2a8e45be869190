//! Three searches that run in turn, so that none takes much more than its share of the budget.
//!
//! The exact search runs first and has the default budget for itself, which suffices for most frames. The remaining
//! budget is shared with two other searches. One is the [ejection search](super::eject). The other runs cycles over
//! [joined items](super::join). They are packed first and then taken apart step by step, with an ejection search at
//! each step. (This is the multilevel scheme of graph partitioning, Karypis and Kumar 1998.)

use super::eject::Eject;
use super::exact::{self, Exact};
use super::greedy::Greedy;
use super::join::Joined;
use super::lower_bound::lower_bound;
use super::meter::{Bracket, Meter};
use super::problem::Problem;

/// Steps of the exact search before the others start.
const ALONE: u64 = 1 << 18;
/// Denominator of the exact search's share of the steps while other searches run: for few items, and for many.
const SHARES: (u64, u64) = (3, 16);
/// Steps per turn of the ejection search.
const TURN: u64 = 1 << 16;
/// Steps per item before the ejection search tries a higher capacity.
const PATIENCE: u64 = 512;
/// Limits of the expected number of partners by chance, for successive cycles.
const LIMITS: [f64; 4] = [f64::INFINITY, 0.16, 0.02, 1.0];
/// Steps per item and level of the first cycle.
const LEVEL: u64 = 64;
/// Number of items per extra penalty unit of a cycle that does not help, which delays its next turn.
const MANY: usize = 1250;

/// Maximum number of items for which the exact search gets the larger share.
const FEW: usize = 400;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Narrow {
    exact: Exact,
    eject: Eject,
    joined: Joined,
    level: Level,
}

/// The problem of joined items.
#[derive(Debug, Default)]
struct Level {
    problem: Problem,
    greedy: Greedy,
    exact: Exact,
    eject: Eject,
    best: Vec<u64>,
    offsets: Vec<u64>,
}

impl Narrow {
    /// Lowers the meter's top and raises its bound until they meet or the meter is empty.
    ///
    /// `best` contains a packing with that top and is replaced by better ones. The instance must not be dense.
    pub fn minimize(&mut self, problem: &Problem, best: &mut [u64], meter: &mut Meter<'_>) {
        self.exact.start(problem);
        self.eject.reset();
        self.eject.capacity = u64::MAX;
        self.joined.reset();
        let share = if problem.len() > FEW { SHARES.1 } else { SHARES.0 };
        let (mut exact, mut eject, mut cycles, mut turn) = (0, 0, 0, 0);
        while meter.bracket.is_open() && !meter.is_empty() {
            let before = meter.spent;
            if exact < ALONE || share * exact <= before {
                let mut bracket = meter.bracket;
                meter.turn_end = before.saturating_add((before / 8).max(ALONE - exact.min(ALONE)));
                self.exact.ask(problem, &mut bracket, best, meter);
                meter.turn_end = u64::MAX;
                meter.bracket = bracket;
                exact += meter.spent - before;
            } else if cycles <= eject {
                let top = meter.bracket.top;
                let limit = LIMITS[turn % LIMITS.len()];
                self.cycle(problem, best, (limit, cycles / 16), meter);
                turn += 1;
                let worth = if meter.bracket.top < top { 1 } else { 1 + (problem.len() / MANY) as u64 };
                cycles += worth * (meter.spent - before);
            } else {
                let bracket = meter.bracket;
                let long = PATIENCE * problem.len() as u64 + eject / 8;
                if self.eject.capacity >= bracket.top || self.eject.tried > long {
                    self.eject.lower(problem, best, (bracket.bound, bracket.top));
                }
                if self.eject.run(problem, TURN, meter) {
                    best.copy_from_slice(&self.eject.offsets);
                    meter.bracket.top = exact::top(problem, best);
                }
                eject += meter.spent - before;
            }
        }
    }

    /// Packs joined items, then takes them apart step by step. `steps` is the minimum budget of each search.
    fn cycle(&mut self, problem: &Problem, best: &mut [u64], (limit, steps): (f64, u64), meter: &mut Meter<'_>) {
        meter.spend(self.joined.join(problem, limit));
        let steps = steps + LEVEL * problem.len() as u64;
        let mut first = true;
        let (all, mut nodes) = (problem.len(), self.joined.nodes());
        while nodes > all && !meter.is_empty() {
            if self.level.problem.prepare(&self.joined.items).is_err() || self.level.problem.dense {
                return;
            }
            let Bracket { bound, top } = meter.bracket;
            let from = (!first).then_some(&self.joined.offsets);
            self.level.solve(from, bound, steps, meter);
            let placed = &self.joined.place(&self.level.offsets)[..all];
            let lowest = exact::top(problem, placed);
            if lowest < top {
                best.copy_from_slice(placed);
                meter.bracket.top = lowest;
            }
            let items = self.joined.items.len();
            if lowest == bound || 2 * items >= all {
                return;
            }
            // Doubles the number of items.
            nodes = all + (nodes - all) * (all - 2 * items) / (all - items);
            self.joined.cut(nodes);
            first = false;
        }
    }
}

impl Level {
    /// Packs the level's problem, starting from a packing, or from scratch with all searches.
    fn solve(&mut self, from: Option<&Vec<u64>>, bound: u64, steps: u64, meter: &mut Meter<'_>) {
        let Self { problem, greedy, exact, eject, best, offsets } = self;
        let mut bracket = Bracket { bound, top: 0 };
        if let Some(from) = from {
            best.clear();
            best.extend(problem.item.iter().map(|&item| from[item as usize]));
            bracket.top = exact::top(problem, best);
        } else {
            bracket.bound = lower_bound(problem).bytes;
            bracket.top = greedy.pack(problem, bracket.bound, best);
            exact.start(problem);
            let end = meter.spent.saturating_add(if problem.len() > FEW { 0 } else { steps });
            while bracket.is_open() && meter.spent < end && !meter.is_empty() {
                exact.ask(problem, &mut bracket, best, meter);
            }
        }
        eject.reset();
        let end = meter.spent.saturating_add(steps);
        while bracket.is_open() && meter.spent < end && !meter.is_empty() {
            eject.lower(problem, best, (bracket.bound, bracket.top));
            if eject.run(problem, end - meter.spent, meter) {
                best.clone_from(&eject.offsets);
                bracket.top = exact::top(problem, best);
            }
        }
        offsets.clear();
        offsets.resize(problem.len(), 0);
        for (&item, &offset) in problem.item.iter().zip(&*best) {
            offsets[item as usize] = offset;
        }
    }
}
