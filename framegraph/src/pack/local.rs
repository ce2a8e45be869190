//! Local search over orders of placement: what sticks out at the top is placed earlier.
//!
//! An order stands for the packing that best fit makes of it (module `gap`). A move swaps an item that ends at the
//! top with one before it; it is kept unless the top rises, so the search can walk along plateaus.

use super::canonical::Meter;
use super::gap::Gaps;
use super::problem::Problem;
use super::random::Random;

/// Packings tried at most. On graphs of 10 to 60 resources more gain little, and the exact search gains it cheaper.
const TRIALS: u32 = 400;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Local {
    order: Vec<u32>,
    trial: Vec<u64>,
    /// Positions in the order, but the first, whose items end at the top.
    critical: Vec<u32>,
}

impl Local {
    /// Searches until the bound is reached or the trials or steps are spent, from the order of the offsets in `best`.
    ///
    /// `best` holds a packing with this `top` and receives better ones. Returns the top. Not for dense instances.
    pub fn search(
        &mut self,
        problem: &Problem,
        (bound, mut top): (u64, u64),
        best: &mut [u64],
        gaps: &mut Gaps,
        meter: &mut Meter,
    ) -> u64 {
        self.order.clear();
        self.order.extend(0..problem.len() as u32);
        self.order.sort_unstable_by_key(|&i| (best[i as usize], i));
        self.trial.clear();
        self.trial.resize(problem.len(), 0);
        let mut random = Random::default();
        let mut current = u64::MAX;
        let mut swap = (0, 0);
        for _ in 0..TRIALS {
            if top <= bound || meter.left == 0 {
                break;
            }
            self.order.swap(swap.0, swap.1);
            gaps.looks = 0;
            let found = gaps.pack(problem, &self.order, &mut self.trial);
            meter.spend(gaps.looks);
            if found > current {
                self.order.swap(swap.0, swap.1);
            } else {
                current = found;
                if found < top {
                    top = found;
                    best.copy_from_slice(&self.trial);
                }
                self.find_critical(problem, found);
            }
            if self.critical.is_empty() {
                break; // only the first item reaches the top: nothing to place earlier
            }
            let late = self.critical[random.below(self.critical.len() as u64) as usize];
            swap = (random.below(u64::from(late)) as usize, late as usize);
        }
        top
    }

    fn find_critical(&mut self, problem: &Problem, top: u64) {
        self.critical.clear();
        for (position, &i) in self.order.iter().enumerate() {
            let i = i as usize;
            if position > 0 && self.trial[i] + problem.size[i] == top {
                self.critical.push(position as u32);
            }
        }
    }
}
