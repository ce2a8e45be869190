//! What a packing may spend, what it has reached, and who is told so.

use core::ops::ControlFlow;

/// A proved lower bound and the best top found, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bracket {
    pub bound: u64,
    pub top: u64,
}

impl Bracket {
    /// There is still something to find.
    pub fn is_open(self) -> bool {
        self.bound < self.top
    }
}

/// How far a packing has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The lowest top found so far, bytes.
    pub top: u64,
    /// No packing has a lower top, as far as is proved, bytes.
    pub lower_bound: u64,
    /// Steps spent of the budget.
    pub steps: u64,
}

/// Is told the progress every few milliseconds, and ends the search by breaking.
pub(super) type Watch<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// The budget, and the bracket that it has bought so far.
pub(super) struct Meter<'a> {
    pub bracket: Bracket,
    /// Steps spent.
    pub spent: u64,
    /// Where the turn of the search that works now ends, in steps spent.
    pub turn_end: u64,
    budget: u64,
    told: u64,
    watch: &'a mut Watch<'a>,
}

/// Steps between two calls of the watcher.
const PAUSE: u64 = 1 << 14;

impl<'a> Meter<'a> {
    pub fn new(bracket: Bracket, budget: u64, watch: &'a mut Watch<'a>) -> Self {
        Self { bracket, spent: 0, turn_end: u64::MAX, budget, told: 0, watch }
    }

    /// The budget is spent, or the turn is over, or the watcher wants no more.
    pub fn is_empty(&self) -> bool {
        self.spent >= self.budget.min(self.turn_end)
    }

    /// A step is 64 array entries looked at, about 0.15 µs.
    pub fn spend(&mut self, entries: u64) {
        self.spent = self.budget.min(self.spent + entries / 64 + 1);
        if self.spent - self.told >= PAUSE {
            self.told = self.spent;
            let Bracket { top, bound } = self.bracket;
            if (self.watch)(Progress { top, lower_bound: bound, steps: self.spent }).is_break() {
                self.budget = self.spent;
            }
        }
    }
}
