//! The portfolio: a few greedy packings in different orders, the lowest kept, stopping at the lower bound.

use super::gap::Gaps;
use super::order::{Criteria, Key, Order};
use super::problem::Problem;
use super::skyline::Skyline;
use super::sweep::Sweep;

/// Orders for the skyline, the best on render graphs first.
const ORDERS: [Order; 4] = [Order::PeakArea, Order::Area, Order::PeakWidth, Order::PeakDeath];
/// Further orders are tried while fewer items than this, or this many times the items, have been looked at.
const LOOKS: u64 = 4096;
const LOOKS_PER_ITEM: u64 = 16;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Greedy {
    skyline: Skyline,
    pub gaps: Gaps,
    sweep: Sweep,
    keys: Vec<Key>,
    /// What [`Greedy::sort`] left.
    pub order: Vec<u32>,
    trial: Vec<u64>,
}

impl Greedy {
    /// Packs all items; `offsets` receives the best packing. Returns its top.
    ///
    /// Time: `n log n` to sort, then about 10 looks at an item for each order tried. One order is always tried; more
    /// while the bound is not reached and the work stays linear.
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

    /// Sorts all items; the result stays in [`Greedy::order`].
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
