//! Minimizes the top: decision searches at capacities between the lower bound and the best packing.
//!
//! A search usually succeeds quickly or not at all, depending on the order in which it tries items. Each capacity is
//! therefore searched under several orders with a small limit, which doubles from round to round. Some orders prefer
//! sections where earlier searches failed.

use super::canonical::{Canonical, Outcome};
use super::meter::{Bracket, Meter};
use super::order::Order;
use super::problem::Problem;

/// The orders of each decision search; the weighted ones use failure counts.
const ORDERS: [Order; 7] = [
    Order::PeakWidth,
    Order::PeakArea,
    Order::PeakSpan,
    Order::WidthPeak,
    Order::WeightedPeak,
    Order::PeakDeath,
    Order::WeightedArea,
];
/// Placements per search in the first round, in addition to two per item.
const FIRST_LIMIT: u64 = 512;
/// Weight of a section without failures, and of the one with the most.
const WEIGHTS: (u32, u32) = (256, 2560);

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Exact {
    search: Canonical,
    /// For each item, the first item of equal lifetime, size and alignment.
    equal: Vec<u32>,
    keys: Vec<(u64, u64, u64, u32)>,
    unit: u64,
    /// Position in the sequence of searches: limits double from round to round, and each round has up to four
    /// capacities.
    round: u32,
    part: u32,
}

impl Exact {
    /// Starts a new instance, which must not be dense.
    pub fn start(&mut self, problem: &Problem) {
        (self.unit, self.round, self.part) = (problem.unit(), 0, 0);
        self.find_equal(problem);
        for list in [&mut self.search.failures, &mut self.search.weights] {
            list.clear();
            list.resize(problem.sections(), 0);
        }
    }

    /// Runs the next search. Lowers the top or raises the bound of an open bracket, or neither.
    ///
    /// `best` contains a packing with that top and is replaced by better ones.
    pub fn ask(&mut self, problem: &Problem, bracket: &mut Bracket, best: &mut [u64], meter: &mut Meter<'_>) {
        // Search at the bound itself; then, with less effort, at the middle, three quarters and seven eighths of the
        // bracket.
        let width = bracket.top - bracket.bound;
        let capacity = bracket.bound + (width - (width >> self.part)) / self.unit * self.unit;
        let pointless = self.part > 0 && (capacity == bracket.bound || capacity >= bracket.top);
        if !pointless {
            let limit = (FIRST_LIMIT + 2 * problem.len() as u64) << self.round;
            match self.decide(problem, capacity, if self.part == 0 { limit } else { limit / 4 }, meter) {
                Outcome::Found => {
                    best.copy_from_slice(&self.search.offsets);
                    bracket.top = top(problem, best);
                    return;
                }
                Outcome::Refuted(next) => {
                    bracket.bound = next.min(bracket.top);
                    return;
                }
                Outcome::Undecided => self.part += 1,
            }
        }
        if pointless || self.part == 4 {
            (self.round, self.part) = ((self.round + 1).min(32), 0);
        }
    }

    /// Searches one capacity under all orders, each with at most `limit` placements.
    fn decide(&mut self, problem: &Problem, capacity: u64, limit: u64, meter: &mut Meter<'_>) -> Outcome {
        self.search.failures.fill(0);
        for order in ORDERS {
            self.weigh_by_failures();
            let outcome = self.search.run(problem, &self.equal, capacity, order, limit, meter);
            if outcome != Outcome::Undecided {
                return outcome;
            }
        }
        Outcome::Undecided
    }

    fn weigh_by_failures(&mut self) {
        let worst = self.search.failures.iter().copied().max().unwrap_or(0).max(1);
        let range = u64::from(WEIGHTS.1 - WEIGHTS.0);
        for (weight, &count) in self.search.weights.iter_mut().zip(&self.search.failures) {
            *weight = WEIGHTS.0 + (u64::from(count) * range / u64::from(worst)) as u32;
        }
    }

    /// Determines for each item the first one of equal lifetime, size and alignment.
    fn find_equal(&mut self, problem: &Problem) {
        let span = |i: usize| u64::from(problem.lo[i]) << 32 | u64::from(problem.hi[i]);
        self.keys.clear();
        self.keys.extend((0..problem.len()).map(|i| (span(i), problem.size[i], problem.align[i], i as u32)));
        self.keys.sort_unstable();
        self.equal.clear();
        self.equal.resize(problem.len(), 0);
        for k in 0..self.keys.len() {
            let (span, size, align, i) = self.keys[k];
            let same = k > 0 && (self.keys[k - 1].0, self.keys[k - 1].1, self.keys[k - 1].2) == (span, size, align);
            self.equal[i as usize] = if same { self.equal[self.keys[k - 1].3 as usize] } else { i };
        }
    }
}

/// Returns the highest end.
pub(super) fn top(problem: &Problem, offsets: &[u64]) -> u64 {
    offsets.iter().zip(&problem.size).map(|(offset, size)| offset + size).max().unwrap_or(0)
}
