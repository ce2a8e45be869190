//! Lowest position first: a greedy packing that grows all sections evenly, like a skyline.
//!
//! The rule: of all items not yet placed, take the one that can sit lowest on top of what is placed; among equals the
//! first of the given order. No item is ever put under another. This is the first descent of the exact search (module
//! `canonical`) without its look-ahead, and where no section is crowded it reaches the lower bound more often than
//! placing by size: positions low in the heap go to the items that have least freedom, while gap filling by size lets
//! the large items choose first and strands the long ones.
//!
//! An item that cannot sit at the current level waits on the item that blocks it highest, and is looked at again only
//! when that level is reached. Items alive together with `k` others cost `k` comparisons and about 10 looks each.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use super::problem::{Problem, align_up};

const NONE: u32 = u32::MAX;
/// Up to so many items of one level are picked one by one; more are sorted first.
const FEW: usize = 64;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Skyline {
    /// What each item would have to sit on, and whose end that is; raised by every neighbor placed.
    roof: Vec<(u64, u32)>,
    /// First item that waits on each item, and the next that waits on the same.
    head: Vec<u32>,
    next: Vec<u32>,
    rank: Vec<u32>,
    levels: BinaryHeap<Reverse<(u64, u32)>>,
    batch: Vec<(u32, u32)>,
    /// Looks taken at an item since the caller last reset it: the measure of work.
    pub looks: u64,
}

impl Skyline {
    /// Packs all items; `order` lists each item once, most preferred first. Returns the top. Not for dense instances.
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

    /// Collects those that waited on `owner` and are free at `level`; the others wait on.
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

    /// Places what fits of the batch, all of which is free at `level`; the rest waits. Returns the highest end.
    ///
    /// What an item placed here blocks was free until then, so it waits on that item: no other look is needed.
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

    /// Places item `i` if nothing under it is higher than `level`, else lets it wait. Returns its end, or 0.
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

    /// Puts item `i` on `height`, or as little above as its alignment asks for. Returns its end.
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
