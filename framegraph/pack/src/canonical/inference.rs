//! Inference: effects of a placement or a refusal on the positions of other items, and capacity tests.

use super::super::problem::{Problem, align_up};
use super::{Canonical, Component, Frame};

impl Canonical {
    /// Places item `i` at its floor and raises its neighbors. Returns `false` if a capacity test fails; must be undone
    /// in any case.
    pub(super) fn place(&mut self, problem: &Problem, i: usize) -> bool {
        let mark = self.raised.len();
        let span = problem.span(i);
        self.offsets[i] = self.floor[i];
        self.placed[i] = true;
        self.total[span.clone()].iter_mut().for_each(|total| *total -= problem.size[i]);
        self.crossing[span.start..span.end - 1].iter_mut().for_each(|count| *count -= 1);
        let end = self.floor[i] + problem.size[i];
        for j in problem.neighbors(i) {
            self.looks += 1;
            if self.placed[j] || self.floor[j] >= end {
                continue;
            }
            let floor = align_up(end, problem.align[j]);
            self.raised.push((j as u32, self.floor[j], self.bound[j]));
            self.floor[j] = floor;
            self.bound[j] = self.bound[j].max(floor);
            if !self.within(floor + problem.size[j]) {
                return false;
            }
        }
        self.looks += span.len() as u64;
        span.into_iter().all(|s| self.fits(problem, s))
            && (mark..self.raised.len()).all(|k| self.witnesses_hold(problem, self.raised[k].0))
    }

    /// Updates the bounds of refused items after a placement at `level`.
    pub(super) fn reconsider(&mut self, problem: &Problem, component: Component, level: u64, equal: &[u32]) -> bool {
        self.looks += u64::from(component.end - component.first);
        (component.first..component.end).all(|k| {
            let i = self.arena[k as usize] as usize;
            self.placed[i] || self.bound[i] == self.floor[i] || self.refuse(problem, i, level, equal)
        })
    }

    /// Refuses the floor for item `i`: raises its bound to the end of the lowest item that can be below it.
    ///
    /// Unplaced items end up at `level` or higher. Returns `false` if no item can be below it, or if a capacity test
    /// fails.
    pub(super) fn refuse(&mut self, problem: &Problem, i: usize, level: u64, equal: &[u32]) -> bool {
        let roof = self.floor[i] + problem.size[i];
        let mut end = u64::MAX;
        for j in problem.neighbors(i) {
            self.looks += 1;
            let lowest = self.bound[j].max(level);
            if !self.placed[j] && lowest < roof && equal[j] != equal[i] {
                end = end.min(lowest + problem.size[j]);
            }
        }
        if end == u64::MAX {
            return false;
        }
        let bound = align_up(end, problem.align[i]);
        if bound <= self.bound[i] {
            return true;
        }
        let lo = problem.lo[i] as usize;
        (problem.born[lo]..problem.born[lo + 1]).all(|j| {
            let j = j as usize;
            if self.placed[j] || equal[j] != equal[i] {
                return true;
            }
            self.raised.push((j as u32, self.floor[j], self.bound[j]));
            self.bound[j] = bound;
            self.within(bound + problem.size[j]) && self.witnesses_hold(problem, j as u32)
        })
    }

    /// Checks the sections whose witness is item `i`, and selects new witnesses where needed.
    fn witnesses_hold(&mut self, problem: &Problem, i: u32) -> bool {
        let mut span = problem.span(i as usize);
        self.looks += span.len() as u64 / 4;
        span.all(|s| self.witness[s] != i || self.fits(problem, s))
    }

    /// Checks that section `s` can hold its unplaced items above the lowest of their bounds.
    fn fits(&mut self, problem: &Problem, s: usize) -> bool {
        let total = self.total[s];
        let w = self.witness[s] as usize;
        if total == 0 || !self.placed[w] && self.bound[w] + total <= self.capacity {
            return true;
        }
        let mut lowest = u64::MAX;
        for &j in problem.members(s) {
            self.looks += 1;
            let j = j as usize;
            if self.placed[j] {
                continue;
            }
            lowest = lowest.min(self.bound[j]);
            if lowest + total <= self.capacity {
                self.witnessed.push((s as u32, w as u32));
                self.witness[s] = j as u32;
                return true;
            }
        }
        self.failures[s] += 1;
        self.within(lowest + total)
    }

    /// Returns `true` if an end is within the capacity. Otherwise records the shortfall.
    fn within(&mut self, end: u64) -> bool {
        if end > self.capacity {
            self.shortfall = self.shortfall.min(end - self.capacity);
        }
        end <= self.capacity
    }

    pub(super) fn undo(&mut self, problem: &Problem, frame: Frame) {
        for (i, floor, bound) in self.raised.drain(frame.raised as usize..).rev() {
            self.floor[i as usize] = floor;
            self.bound[i as usize] = bound;
        }
        for (s, witness) in self.witnessed.drain(frame.witnessed as usize..).rev() {
            self.witness[s as usize] = witness;
        }
        let i = frame.item as usize;
        let span = problem.span(i);
        self.placed[i] = false;
        self.crossing[span.start..span.end - 1].iter_mut().for_each(|count| *count += 1);
        self.total[span].iter_mut().for_each(|total| *total += problem.size[i]);
        self.components.truncate(frame.components as usize);
        self.arena.truncate(frame.arena as usize);
    }
}
