//! Phase 3, moves of passes: neighbors of an order that respect the dependencies.
//!
//! A moved pass takes along passes in between that it cannot be reordered with: its dependencies when it moves forward,
//! its dependents when it moves backward. Two kinds of moves are tried in rounds, until none improves the plan:
//!
//! - *gather*: places two passes that could share a step next to each other. Dependencies of the second move before the
//!   first, all others after the second.
//! - *shift*: moves a pass to another position, trying near positions first.

use super::schedule::{ScheduleScratch, could_join};
use crate::decision::Decision;
use crate::graph::Tables;
use crate::id::PassId;

/// Maximum distance of a move.
const REACH: usize = 64;

/// A change of a window of an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Move {
    /// Moves the last pass of the window behind the first.
    Gather,
    /// Moves the last pass of the window to its start.
    Forward,
    /// Moves the first pass of the window to its end.
    Backward,
}

/// An enumeration of the moves of an order.
#[derive(Debug, Default)]
pub(crate) struct Moves {
    /// Index of the next move.
    next: usize,
    /// Number of moves since the last improvement.
    fruitless: usize,
    /// Passes that move along are marked with the number of the move.
    marks: Vec<u32>,
    mark: u32,
}

/// Memory of the phase, reused between compilations. Orders are indices into the declared order.
#[derive(Debug, Default)]
pub(crate) struct OrderScratch {
    pub(super) declared: Vec<PassId>,
    pub(super) best: Vec<u32>,
    pub(super) trial: Vec<u32>,
    pub(super) moves: Moves,
    pub(super) log: Vec<Decision>,
}

impl Moves {
    /// Restarts the enumeration for orders of `passes` passes.
    pub(crate) fn start(&mut self, passes: usize) {
        let Self { next, fruitless, marks, mark } = self;
        (*next, *fruitless, *mark) = (0, 0, 0);
        marks.clear();
        marks.resize(passes, 0);
    }

    /// Reports that the last move improved the order.
    pub(crate) fn helped(&mut self) {
        self.fruitless = 0;
    }

    /// Writes the next order that differs from `order` to `out`. Returns `false` if no move is left, or if the budget
    /// `looks` of examined positions is used up.
    pub(crate) fn next(
        &mut self,
        graph: &Tables,
        declared: &[PassId],
        dependencies: &ScheduleScratch,
        order: &[u32],
        looks: &mut usize,
        out: &mut Vec<u32>,
    ) -> bool {
        let reach = REACH.min(order.len().saturating_sub(1));
        let all = order.len() * reach * 3;
        while self.fruitless < all {
            let wanted = numbered(self.next, order.len(), reach);
            self.next = (self.next + 1) % all;
            self.fruitless += 1;
            let Some((wanted, low, high)) = wanted else {
                continue;
            };
            match looks.checked_sub(high - low) {
                Some(left) => *looks = left,
                None => return false,
            }
            self.mark += 1;
            out.clear();
            out.extend(&order[..low]);
            let window = &order[low..=high];
            let moved = match wanted {
                Move::Gather => {
                    could_join(graph, declared, &order[low..=low], order[high])
                        && self.gather(dependencies, window, out)
                }
                Move::Forward => self.forward(dependencies, window, out),
                Move::Backward => self.backward(dependencies, window, out),
            };
            if moved && out[low..] != *window {
                out.extend(&order[high + 1..]);
                return true;
            }
        }
        false
    }

    fn is_taken(&self, pass: u32) -> bool {
        self.marks[pass as usize] == self.mark
    }

    /// Marks `pass` and its dependencies in `between`.
    fn take_awaited(&mut self, dependencies: &ScheduleScratch, between: &[u32], pass: u32) {
        self.marks[pass as usize] = self.mark;
        for &earlier in between.iter().rev() {
            if dependencies.waiting_for(earlier).iter().any(|(_, after)| self.is_taken(*after)) {
                self.marks[earlier as usize] = self.mark;
            }
        }
    }

    /// Moves the last pass behind the first. Returns `false` if a dependency of the last depends on the first.
    fn gather(&mut self, dependencies: &ScheduleScratch, window: &[u32], out: &mut Vec<u32>) -> bool {
        let [first, between @ .., last] = window else {
            return false;
        };
        self.take_awaited(dependencies, between, *last);
        let waiting = dependencies.waiting_for(*first);
        if waiting.iter().any(|(_, after)| after != last && between.contains(after) && self.is_taken(*after)) {
            return false;
        }
        out.extend(between.iter().filter(|p| self.is_taken(**p)));
        out.extend([first, last]);
        out.extend(between.iter().filter(|p| !self.is_taken(**p)));
        true
    }

    /// Moves the last pass of the window and its dependencies to the start.
    fn forward(&mut self, dependencies: &ScheduleScratch, window: &[u32], out: &mut Vec<u32>) -> bool {
        let [between @ .., last] = window else {
            return false;
        };
        self.take_awaited(dependencies, between, *last);
        out.extend(between.iter().filter(|p| self.is_taken(**p)));
        out.push(*last);
        out.extend(between.iter().filter(|p| !self.is_taken(**p)));
        true
    }

    /// Moves the first pass of the window and its dependents to the end.
    fn backward(&mut self, dependencies: &ScheduleScratch, window: &[u32], out: &mut Vec<u32>) -> bool {
        let [first, between @ ..] = window else {
            return false;
        };
        self.marks[*first as usize] = self.mark;
        for pass in window {
            if self.is_taken(*pass) {
                for (_, after) in dependencies.waiting_for(*pass) {
                    self.marks[*after as usize] = self.mark;
                }
            }
        }
        out.extend(between.iter().filter(|p| !self.is_taken(**p)));
        out.push(*first);
        out.extend(between.iter().filter(|p| self.is_taken(**p)));
        true
    }
}

/// Returns the move with this number; `None` if it does not exist or duplicates another one. Numbers are ordered by
/// kind, then by distance.
fn numbered(number: usize, passes: usize, reach: usize) -> Option<(Move, usize, usize)> {
    let (row, low) = (number / passes, number % passes);
    let (kind, distance) = (row / reach, row % reach + 1);
    let wanted = match kind {
        0 if distance > 1 => Move::Gather,
        1 => Move::Forward,
        2 if distance > 1 => Move::Backward,
        _ => return None,
    };
    (low + distance < passes).then_some((wanted, low, low + distance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check_source::generate::{self, Entropy, FRAME, Profile};
    use crate::compile::CompileErrors;
    use crate::compile::measure::{Measures, measure};
    use crate::compile::parts::Parts;
    use crate::compile::schedule::dependencies;

    #[test]
    fn moves_are_different_orders_that_respect_what_waits_for_what() {
        let (mut orders, mut gathered) = (0, 0);
        for seed in 0..60 {
            let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
            let (mut measures, mut parts) = (Measures::default(), Parts::default());
            measure(&graph, &crate::Caps::desktop(), FRAME, &mut measures, &mut CompileErrors::default());
            parts.number(&graph, &measures);
            let declared: Vec<_> = graph.pass_ids().collect();
            let mut waits = ScheduleScratch::default();
            dependencies(&graph, &parts, &declared, &mut waits);
            let order: Vec<u32> = (0..declared.len() as u32).collect();
            let (mut moves, mut moved, mut looks) = (Moves::default(), Vec::new(), 1 << 20);
            moves.start(order.len());
            while moves.next(&graph, &declared, &waits, &order, &mut looks, &mut moved) {
                assert_ne!(moved, order, "seed {seed}");
                let place = |pass: u32| moved.iter().position(|p| *p == pass);
                assert!(moved.len() == order.len() && order.iter().all(|p| place(*p).is_some()), "seed {seed}");
                for &before in &order {
                    let after = waits.waiting_for(before);
                    assert!(after.iter().all(|(_, after)| place(before) < place(*after)), "seed {seed}: {moved:?}");
                }
                orders += 1;
                gathered += usize::from(moves.next <= order.len() * REACH.min(order.len() - 1));
            }
            assert_eq!(moves.fruitless, order.len() * order.len().saturating_sub(1).min(REACH) * 3, "seed {seed}");
        }
        assert!(orders > 1000 && gathered > 20, "{orders} orders, {gathered} gathered");
    }

    #[test]
    fn looks_end_the_walk_and_each_window_has_one_number_a_kind() {
        let graph = generate::graph(&mut Entropy::seeded(3), &Profile::default());
        let declared: Vec<_> = graph.pass_ids().collect();
        let order: Vec<u32> = (0..declared.len() as u32).rev().collect();
        let (mut moves, mut looks) = (Moves::default(), 0);
        moves.start(order.len());
        // With budget left, the dependencies would be read, which are empty here.
        let waits = ScheduleScratch::default();
        assert!(!moves.next(&graph, &declared, &waits, &order, &mut looks, &mut Vec::new()));
        assert_eq!(numbered(0, 5, 4), None, "adjacent passes are already gathered");
        assert_eq!(numbered(5, 5, 4), Some((Move::Gather, 0, 2)));
        assert_eq!(numbered(5 * 4, 5, 4), Some((Move::Forward, 0, 1)));
        assert_eq!(numbered(5 * 4 + 4, 5, 4), None, "no pass follows the last");
        assert_eq!(numbered(5 * 8 + 5, 5, 4), Some((Move::Backward, 0, 2)));
    }
}
