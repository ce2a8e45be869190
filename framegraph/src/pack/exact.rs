//! The lowest top: decision searches at rising limits, from the lower bound up and from the best packing down.
//!
//! A search that succeeds does so quickly or hardly ever, depending on the order it tries items in. So every capacity
//! is asked under a portfolio of orders with a small limit first, and the limit doubles from round to round. Some
//! orders look at where earlier searches failed; and each round adds short searches that take some sections, picked
//! at random from a fixed seed, for more important than they are (after Gomes, Selman and Kautz 1998 on restarts and
//! heavy tails).
//!
//! Where parts of a frame are less crowded, searching them together with the rest wastes the effort: a failure in one
//! place is answered by rearranging another. So each order is also tried on the *core*, the items of the fullest
//! sections, and the rest is put into the gaps; what does not fit joins the core. A core that has no packing refutes
//! the whole.

use core::ops::Range;

use super::canonical::{Canonical, Meter, Outcome};
use super::gap::{Gaps, UNPLACED};
use super::order::Order;
use super::problem::Problem;
use super::random::Random;

/// The orders each decision is searched under; the weighted ones by failures.
const ORDERS: [Order; 9] = [
    Order::PeakWidth,
    Order::PeakArea,
    Order::PeakSpan,
    Order::WidthPeak,
    Order::WeightedPeak,
    Order::PeakDeath,
    Order::WeightedArea,
    Order::SpanPeak,
    Order::WeightedSize,
];
/// Placements that the first round may try in each search, beyond two for each item.
const FIRST_LIMIT: u64 = 512;
/// The orders of the searches with random weights, which may try `RESTART_LIMIT` placements for each item.
const RESTART_ORDERS: [Order; 3] = [Order::WeightedPeak, Order::WeightedSize, Order::WeightedArea];
const RESTART_LIMIT: u64 = 4;
/// Items alive in a section with more than this share of the capacity are in the core.
const CORE_SHARE: (u64, u64) = (7, 8);
/// How often the core may grow in one attempt.
const GROWTH: u32 = 4;
/// The weight of a section: from the smallest to the largest.
const WEIGHTS: (u32, u32) = (256, 2560);

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Exact {
    search: Canonical,
    random: Random,
    twins: Vec<u32>,
    keys: Vec<(u64, u64, u64, u32)>,
    all: Vec<u32>,
    core: Vec<u32>,
    rest: Vec<u32>,
    trial: Vec<u64>,
}

/// One capacity and what to spend on it: more each round, divided by `share`.
#[derive(Clone, Copy)]
struct Attempt {
    capacity: u64,
    round: u32,
    share: u64,
}

/// A proved lower bound and the best top found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bracket {
    pub bound: u64,
    pub top: u64,
}

impl Exact {
    /// Lowers `bracket.top` and raises `bracket.bound` until they meet, or the rounds are over or the meter is empty.
    ///
    /// `best` holds a packing with that top and receives better ones. Not for dense instances.
    pub fn minimize(
        &mut self,
        problem: &Problem,
        mut bracket: Bracket,
        rounds: Range<u32>,
        best: &mut [u64],
        gaps: &mut Gaps,
        meter: &mut Meter,
    ) -> Bracket {
        let unit = problem.unit();
        self.find_twins(problem);
        self.all.clear();
        self.all.extend(0..problem.len() as u32);
        self.random = Random::default();
        let sections = problem.sections();
        for list in [&mut self.search.failures, &mut self.search.weights] {
            list.clear();
            list.resize(sections, 0);
        }
        for round in rounds {
            // The bound itself; then, with less effort, the middle of the bracket, three quarters, seven eighths.
            let mut part = 0;
            while part < 4 && bracket.bound < bracket.top && meter.left > 0 {
                let width = bracket.top - bracket.bound;
                let capacity = bracket.bound + (width - (width >> part)) / unit * unit;
                if part > 0 && (capacity == bracket.bound || capacity >= bracket.top) {
                    break;
                }
                let effort = Attempt { capacity, round, share: if part == 0 { 1 } else { 4 } };
                match self.attempt(problem, effort, gaps, meter) {
                    Outcome::Found => {
                        best.copy_from_slice(&self.trial);
                        bracket.top = top(problem, best);
                    }
                    Outcome::Refuted(next) => bracket.bound = next.min(bracket.top),
                    Outcome::Undecided => part += 1,
                }
            }
            if bracket.bound >= bracket.top || meter.left == 0 {
                break;
            }
        }
        bracket
    }

    /// Asks for one capacity under all orders. A packing found is left in `self.trial`.
    fn attempt(&mut self, problem: &Problem, attempt: Attempt, gaps: &mut Gaps, meter: &mut Meter) -> Outcome {
        let items = problem.len() as u64;
        let limit = ((FIRST_LIMIT + 2 * items) << attempt.round.min(32)) / attempt.share;
        self.search.failures.fill(0);
        self.find_core(problem, attempt.capacity);
        for order in ORDERS {
            let outcome = self.ask(problem, attempt.capacity, (order, limit), gaps, meter);
            if outcome != Outcome::Undecided {
                return outcome;
            }
        }
        let restarts = (ORDERS.len() as u64 * limit / (RESTART_LIMIT * items)).max(1);
        for restart in 0..restarts {
            for weight in &mut self.search.weights {
                *weight = if self.random.below(8) == 0 { WEIGHTS.1 } else { WEIGHTS.0 };
            }
            let order = RESTART_ORDERS[restart as usize % RESTART_ORDERS.len()];
            let subset = (&self.all[..], &self.twins[..]);
            let outcome = self.search.run(problem, subset, attempt.capacity, order, RESTART_LIMIT * items, meter);
            if outcome != Outcome::Undecided || meter.left == 0 {
                return self.take(outcome);
            }
        }
        Outcome::Undecided
    }

    /// One search of everything and, if that is undecided, of the core.
    fn ask(
        &mut self,
        problem: &Problem,
        capacity: u64,
        (order, limit): (Order, u64),
        gaps: &mut Gaps,
        meter: &mut Meter,
    ) -> Outcome {
        self.weigh_by_failures();
        let outcome = self.search.run(problem, (&self.all, &self.twins), capacity, order, limit, meter);
        if outcome != Outcome::Undecided {
            return self.take(outcome);
        }
        for _ in 0..GROWTH {
            if self.core.len() == self.all.len() || meter.left == 0 {
                break;
            }
            match self.search.run(problem, (&self.core, &self.twins), capacity, order, limit, meter) {
                Outcome::Found if self.complete(problem, capacity, gaps) => return Outcome::Found,
                Outcome::Found => {}
                other => return other,
            }
        }
        Outcome::Undecided
    }

    /// Keeps the offsets of a search of everything.
    fn take(&mut self, outcome: Outcome) -> Outcome {
        if outcome == Outcome::Found {
            self.trial.clear();
            self.trial.extend_from_slice(&self.search.offsets);
        }
        outcome
    }

    fn weigh_by_failures(&mut self) {
        let worst = self.search.failures.iter().copied().max().unwrap_or(0).max(1);
        let range = u64::from(WEIGHTS.1 - WEIGHTS.0);
        for (weight, &count) in self.search.weights.iter_mut().zip(&self.search.failures) {
            *weight = WEIGHTS.0 + (u64::from(count) * range / u64::from(worst)) as u32;
        }
    }

    /// Puts what is not in the core into gaps, largest first. What does not fit joins the core.
    fn complete(&mut self, problem: &Problem, capacity: u64, gaps: &mut Gaps) -> bool {
        self.trial.clear();
        self.trial.resize(problem.len(), UNPLACED);
        for &i in &self.core {
            self.trial[i as usize] = self.search.offsets[i as usize];
        }
        let before = self.core.len();
        for &i in &self.rest {
            match gaps.best(problem, i as usize, &self.trial, capacity) {
                Some(offset) => self.trial[i as usize] = offset,
                None => self.core.push(i),
            }
        }
        let trial = &self.trial;
        self.rest.retain(|&i| trial[i as usize] != UNPLACED);
        self.core.len() == before
    }

    fn find_core(&mut self, problem: &Problem, capacity: u64) {
        let threshold = (u128::from(capacity) * u128::from(CORE_SHARE.0) / u128::from(CORE_SHARE.1)) as u64;
        self.core.clear();
        self.rest.clear();
        for &i in &self.all {
            let crowded = problem.total[problem.span(i as usize)].iter().any(|&total| total > threshold);
            if crowded { &mut self.core } else { &mut self.rest }.push(i);
        }
        self.rest.sort_unstable_by_key(|&i| (core::cmp::Reverse(problem.size[i as usize]), i));
    }

    /// Numbers items so that those with equal lifetime, size and alignment have equal numbers.
    fn find_twins(&mut self, problem: &Problem) {
        let span = |i: usize| u64::from(problem.lo[i]) << 32 | u64::from(problem.hi[i]);
        self.keys.clear();
        self.keys.extend((0..problem.len()).map(|i| (span(i), problem.size[i], problem.align[i], i as u32)));
        self.keys.sort_unstable();
        self.twins.clear();
        self.twins.resize(problem.len(), 0);
        for k in 0..self.keys.len() {
            let (span, size, align, i) = self.keys[k];
            let same = k > 0 && (self.keys[k - 1].0, self.keys[k - 1].1, self.keys[k - 1].2) == (span, size, align);
            self.twins[i as usize] = if same { self.twins[self.keys[k - 1].3 as usize] } else { i };
        }
    }
}

/// The highest end.
pub(super) fn top(problem: &Problem, offsets: &[u64]) -> u64 {
    offsets.iter().zip(&problem.size).map(|(offset, size)| offset + size).max().unwrap_or(0)
}
