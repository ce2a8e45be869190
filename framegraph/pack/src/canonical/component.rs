//! Components: selection of the next item, and decomposition after a placement.

use core::ops::Range;

use super::super::order::{Criteria, Order};
use super::super::problem::Problem;
use super::{Canonical, Choice, Component};

impl Canonical {
    /// Sorts the arena from `first` on.
    pub(super) fn sort(&mut self, problem: &Problem, order: Order, first: usize) {
        let criteria = Criteria { total: &self.total, weights: &self.weights };
        self.keys.clear();
        self.keys.extend(self.arena[first..].iter().map(|&i| order.key(problem, criteria, i as usize)));
        self.keys.sort_unstable();
        self.arena.truncate(first);
        self.arena.extend(self.keys.iter().map(|key| key.2));
    }

    /// Selects the item with the lowest possible position, among the items of the component that were not refused
    /// there. Ties are resolved by the order of the items.
    pub(super) fn lowest(&mut self, component: Component) -> Choice {
        let (mut best, mut choice) = (u64::MAX, Choice::Done);
        for &i in &self.arena[component.first as usize..component.end as usize] {
            let i = i as usize;
            if self.placed[i] {
                continue;
            }
            if self.floor[i] < best && self.bound[i] == self.floor[i] {
                (best, choice) = (self.floor[i], Choice::Place(i));
            } else if matches!(choice, Choice::Done) {
                choice = Choice::Stuck;
            }
        }
        self.looks += u64::from(component.end - component.first);
        choice
    }

    /// Splits the current component at boundaries inside `span` that no item crosses. Returns the component to solve
    /// next.
    pub(super) fn split(&mut self, problem: &Problem, current: u32, span: Range<usize>, order: Order) -> u32 {
        self.cuts.clear();
        let boundaries = span.start..span.end.max(1) - 1;
        self.cuts.extend(boundaries.filter(|&s| self.crossing[s] == 0).map(|s| s as u32));
        if self.cuts.is_empty() {
            return current;
        }
        let component = self.components[current as usize];
        self.pieces.clear();
        for (k, &j) in self.arena[component.first as usize..component.end as usize].iter().enumerate() {
            if !self.placed[j as usize] {
                let piece = self.cuts.partition_point(|&cut| cut < problem.lo[j as usize]);
                self.pieces.push((piece as u64) << 32 | k as u64);
            }
        }
        self.looks += u64::from(component.end - component.first) + self.pieces.len() as u64;
        self.pieces.sort_unstable();
        let parent = (self.frames.len() as u32).wrapping_sub(1); // NONE at the root
        let mut next = component.next;
        let mut end = self.pieces.len();
        while end > 0 {
            let piece = self.pieces[end - 1] >> 32;
            let start = self.pieces[..end].partition_point(|&other| other >> 32 < piece);
            let first = self.arena.len();
            for k in start..end {
                self.arena.push(self.arena[component.first as usize + (self.pieces[k] as u32) as usize]);
            }
            self.sort(problem, order, first);
            self.components.push(Component { first: first as u32, end: self.arena.len() as u32, next, parent });
            next = self.components.len() as u32 - 1;
            end = start;
        }
        next
    }
}
