//! Three searches that take turns, so that none spends much more than the others.
//!
//! The exact search begins, and has the default budget to itself: on frames it is all that is needed. What it leaves
//! open the [ejection search](super::eject) lowers, and both work on [joined items](super::join) as well.

use super::eject::Eject;
use super::exact::{self, Exact};
use super::greedy::Greedy;
use super::join::Joined;
use super::lower_bound::lower_bound;
use super::meter::{Bracket, Meter};
use super::problem::Problem;

/// Steps of the exact search before the others begin.
const ALONE: u64 = 1 << 18;
/// Steps of the first turn on joined items, and of a turn of the ejection search.
const TURN: u64 = 1 << 18;
/// Which pairs are joined, turn by turn: those of which chance gives an item so many at most.
const CHANCES: [f64; 3] = [0.5, 0.1, f64::INFINITY];

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Narrow {
    exact: Exact,
    eject: Eject,
    joined: Joined,
    kernel: Kernel,
}

/// The problem of joined items.
#[derive(Debug, Default)]
struct Kernel {
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
    /// `best` holds a packing with that top and receives better ones. Not for dense instances.
    pub fn minimize(&mut self, problem: &Problem, best: &mut [u64], meter: &mut Meter<'_>) {
        self.exact.start(problem);
        self.eject.reset();
        self.eject.capacity = u64::MAX;
        let (mut exact, mut eject, mut joined, mut turn) = (0, 0, 0, 0);
        while meter.bracket.is_open() && !meter.is_empty() {
            let before = meter.spent;
            if exact < ALONE || exact <= eject.max(joined) {
                let mut bracket = meter.bracket;
                self.exact.ask(problem, &mut bracket, best, meter);
                meter.bracket = bracket;
                exact += meter.spent - before;
            } else if joined <= eject {
                let chance = CHANCES[turn % CHANCES.len()];
                self.join(problem, best, chance, TURN << (turn / CHANCES.len()), meter);
                turn += 1;
                joined += meter.spent - before;
            } else {
                let bracket = meter.bracket;
                if self.eject.capacity >= bracket.top {
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

    /// Packs joined items, for so many steps with each search.
    fn join(&mut self, problem: &Problem, best: &mut [u64], chance: f64, steps: u64, meter: &mut Meter<'_>) {
        meter.spend(self.joined.join(problem, chance));
        if self.joined.items.len() == problem.len() || self.kernel.problem.prepare(&self.joined.items).is_err() {
            return;
        }
        let bracket = self.kernel.minimize(meter.bracket.top, steps, meter);
        if bracket.top < meter.bracket.top {
            self.joined.expand(&self.kernel.offsets, best);
            meter.bracket.top = exact::top(problem, best);
        }
    }
}

impl Kernel {
    fn minimize(&mut self, top: u64, steps: u64, meter: &mut Meter<'_>) -> Bracket {
        let Self { problem, greedy, exact, eject, best, offsets } = self;
        let bound = lower_bound(problem).bytes;
        let mut bracket = Bracket { bound, top: greedy.pack(problem, bound, best) };
        exact.start(problem);
        let end = meter.spent.saturating_add(steps);
        while bracket.is_open() && bracket.bound < top && meter.spent < end && !meter.is_empty() {
            exact.ask(problem, &mut bracket, best, meter);
        }
        eject.reset();
        let end = meter.spent.saturating_add(steps);
        while bracket.is_open() && bracket.bound < top && meter.spent < end && !meter.is_empty() {
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
        bracket
    }
}
