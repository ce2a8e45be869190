//! Budget, bounds and progress reports of a packing.

use core::ops::ControlFlow;

/// A proved lower bound and the best top found, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bracket {
    pub bound: u64,
    pub top: u64,
}

impl Bracket {
    /// Returns `true` if the packing may still be improved.
    pub fn is_open(self) -> bool {
        self.bound < self.top
    }
}

/// Progress of a packing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Lowest top found so far, in bytes.
    pub top: u64,
    /// Highest lower bound proved so far, in bytes.
    pub lower_bound: u64,
    /// Number of steps spent.
    pub steps: u64,
}

/// Receives the progress every few milliseconds, and ends the search by returning `Break`.
pub(super) type Watch<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// The budget, and the bracket reached so far.
pub(super) struct Meter<'a> {
    pub bracket: Bracket,
    /// Number of steps spent.
    pub spent: u64,
    /// End of the current search's turn, in spent steps.
    pub turn_end: u64,
    budget: u64,
    reported: u64,
    watch: &'a mut Watch<'a>,
}

/// Number of steps between two calls of the watcher.
const PAUSE: u64 = 1 << 14;

impl<'a> Meter<'a> {
    pub fn new(bracket: Bracket, budget: u64, watch: &'a mut Watch<'a>) -> Self {
        Self { bracket, spent: 0, turn_end: u64::MAX, budget, reported: 0, watch }
    }

    /// Returns `true` if the budget is spent, the turn is over, or the watcher has ended the search.
    pub fn is_empty(&self) -> bool {
        self.spent >= self.budget.min(self.turn_end)
    }

    /// Spends the steps for examining this number of array entries. A step is 64 entries, about 0.15 µs.
    pub fn spend(&mut self, entries: u64) {
        self.spent = self.budget.min(self.spent + entries / 64 + 1);
        if self.spent - self.reported >= PAUSE {
            self.reported = self.spent;
            let Bracket { top, bound } = self.bracket;
            if (self.watch)(Progress { top, lower_bound: bound, steps: self.spent }).is_break() {
                self.budget = self.spent;
            }
        }
    }
}
