//! Lowest position first: a greedy packing that raises all sections evenly, like a skyline.
//!
//! Rule: of all unplaced items, place the one with the lowest position above the placed items; of several, the first in
//! the given order. Items are never placed below others. This is the first descent of the exact search (module
//! `canonical`) without look-ahead. On instances without crowded sections, it reaches the lower bound more often than
//! placing by size. Low positions go to the items with the least freedom, while gap filling by size places large items
//! first and leaves no room for long ones.
//!
//! An item that does not fit at the current level waits for the item with the highest end below it, and is examined
//! again when that level is reached. An item that is live together with `k` others costs `k` comparisons and is
//! examined about 10 times.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use super::problem::{Problem, align_up};

const NONE: u32 = u32::MAX;
/// Maximum number of items of one level that are selected one by one; more are sorted first.
const FEW: usize = 64;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Skyline {
    /// Lowest position of each item, and the item that determines it; raised by every placed neighbor.
    roof: Vec<(u64, u32)>,
    /// First item that waits for each item, and the next one that waits for the same.
    head: Vec<u32>,
    next: Vec<u32>,
    rank: Vec<u32>,
    levels: BinaryHeap<Reverse<(u64, u32)>>,
    batch: Vec<(u32, u32)>,
    /// Number of examined items since the caller last reset it: the measure of work.
    pub looks: u64,
}

impl Skyline {
    /// Packs all items; `order` lists each item once, most preferred first. Returns the top. The instance must not be
    /// dense.
    pub fn pack(&mut self, problem: &Problem, order: &[u32], offsets: &mut [u64]) -> u64 {
        let n = problem.len();
        self.roof.clear();
        self.roof.resize(n, (0, NONE));
        for list in [&mut self.head, &mut self.next] {
            list.clear();
            list.resize(n, NONE);
        }
        self.rank.resize(n, 0);
        for (rank, &i) in order.iter().enumerate() {
            self.rank[i as usize] = rank as u32;
        }
        self.levels.clear();
        let mut top = 0;
        for &i in order {
            top = top.max(self.look(problem, i, 0, offsets));
        }
        while let Some(Reverse((level, owner))) = self.levels.pop() {
            self.batch.clear();
            self.wake(owner, level);
            while let Some(&Reverse((same, owner))) = self.levels.peek()
                && same == level
            {
                self.levels.pop();
                self.wake(owner, level);
            }
            if self.batch.len() > FEW {
                self.batch.sort_unstable();
                for k in 0..self.batch.len() {
                    top = top.max(self.look(problem, self.batch[k].1, level, offsets));
                }
            } else {
                top = top.max(self.place_few(problem, level, offsets));
            }
        }
        top
    }

    /// Collects the items that waited for `owner` and are free at `level`; others continue to wait.
    fn wake(&mut self, owner: u32, level: u64) {
        let mut i = core::mem::replace(&mut self.head[owner as usize], NONE);
        while i != NONE {
            let next = self.next[i as usize];
            self.looks += 1;
            let (height, blocker) = self.roof[i as usize];
            if height > level {
                self.wait(i, height, blocker);
            } else {
                self.batch.push((self.rank[i as usize], i));
            }
            i = next;
        }
    }

    /// Places the items of the batch that fit, all of which are free at `level`; others wait. Returns the highest end.
    ///
    /// An item that is blocked by an item placed here was free before, so it waits for that item. No further
    /// examination is needed.
    fn place_few(&mut self, problem: &Problem, level: u64, offsets: &mut [u64]) -> u64 {
        let mut top = 0;
        while let Some(k) = (0..self.batch.len()).min_by_key(|&k| self.batch[k].0) {
            let i = self.batch.swap_remove(k).1;
            let end = self.put(problem, i, level, offsets);
            top = top.max(end);
            let (lo, hi) = (problem.lo[i as usize], problem.hi[i as usize]);
            let mut kept = 0;
            for k in 0..self.batch.len() {
                let (rank, j) = self.batch[k];
                if problem.lo[j as usize] < hi && lo < problem.hi[j as usize] {
                    self.wait(j, end, i);
                } else {
                    self.batch[kept] = (rank, j);
                    kept += 1;
                }
            }
            self.batch.truncate(kept);
        }
        top
    }

    /// Places item `i` if nothing below it is higher than `level`; otherwise lets it wait. Returns its end, or 0.
    fn look(&mut self, problem: &Problem, i: u32, level: u64, offsets: &mut [u64]) -> u64 {
        let (height, blocker) = self.roof[i as usize];
        if height > level {
            self.wait(i, height, blocker);
            return 0;
        }
        self.put(problem, i, height, offsets)
    }

    /// Lets item `i` wait until `height`, the end of `blocker`, is reached.
    fn wait(&mut self, i: u32, height: u64, blocker: u32) {
        let head = &mut self.head[blocker as usize];
        if *head == NONE {
            self.levels.push(Reverse((height, blocker)));
        }
        self.next[i as usize] = core::mem::replace(head, i);
    }

    /// Places item `i` at `height`, rounded up to its alignment. Returns its end.
    fn put(&mut self, problem: &Problem, i: u32, height: u64, offsets: &mut [u64]) -> u64 {
        let item = i as usize;
        offsets[item] = align_up(height, problem.align[item]);
        let end = offsets[item] + problem.size[item];
        for j in problem.neighbors(item) {
            let old = self.roof[j];
            self.roof[j] = if old.0 < end { (end, i) } else { old };
        }
        end
    }
}
