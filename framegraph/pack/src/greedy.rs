//! Greedy portfolio: packs in several orders, keeps the lowest packing, and stops at the lower bound.

use super::gap::Gaps;
use super::order::{Criteria, Key, Order};
use super::problem::Problem;
use super::skyline::Skyline;
use super::sweep::Sweep;

/// Orders for the skyline, starting with the best one for render graphs.
const ORDERS: [Order; 4] = [Order::PeakArea, Order::Area, Order::PeakWidth, Order::PeakDeath];
/// More orders are tried while fewer items than this, or than a multiple of the item count, have been examined.
const LOOKS: u64 = 4096;
const LOOKS_PER_ITEM: u64 = 16;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Greedy {
    skyline: Skyline,
    pub gaps: Gaps,
    sweep: Sweep,
    keys: Vec<Key>,
    /// Result of [`Greedy::sort`].
    pub order: Vec<u32>,
    trial: Vec<u64>,
}

impl Greedy {
    /// Packs all items and returns the top of the best packing, which is written to `offsets`.
    ///
    /// Time: `n log n` for sorting, then about 10 operations per item for each order. Tries at least one order, and
    /// more while the bound is not reached and the total work is linear.
    pub fn pack(&mut self, problem: &Problem, bound: u64, offsets: &mut Vec<u64>) -> u64 {
        let n = problem.len();
        offsets.clear();
        offsets.resize(n, 0);
        self.trial.clear();
        self.trial.resize(n, 0);
        self.skyline.looks = 0;
        self.gaps.looks = 0;
        if problem.dense {
            return self.sweep.pack(problem, offsets);
        }
        let mut best = u64::MAX;
        for order in ORDERS {
            self.sort(problem, order);
            let top = self.skyline.pack(problem, &self.order, &mut self.trial);
            best = keep(top, best, &mut self.trial, offsets);
            if best <= bound || self.skyline.looks > LOOKS.max(LOOKS_PER_ITEM * n as u64) {
                return best;
            }
        }
        self.sort(problem, Order::Size);
        let top = self.gaps.pack(problem, &self.order, &mut self.trial);
        keep(top, best, &mut self.trial, offsets)
    }

    /// Sorts all items; the result is stored in [`Greedy::order`].
    pub fn sort(&mut self, problem: &Problem, order: Order) {
        let criteria = Criteria { total: &problem.total, weights: &[] };
        self.keys.clear();
        self.keys.extend((0..problem.len()).map(|i| order.key(problem, criteria, i)));
        self.keys.sort_unstable();
        self.order.clear();
        self.order.extend(self.keys.iter().map(|key| key.2));
    }
}

fn keep(top: u64, best: u64, trial: &mut Vec<u64>, offsets: &mut Vec<u64>) -> u64 {
    if top < best {
        core::mem::swap(trial, offsets);
    }
    best.min(top)
}
