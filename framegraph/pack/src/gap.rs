//! Best fit: places one item into the tightest gap between placed items.
//!
//! Applied to all items by decreasing size, this is the classic "greedy by size" of memory planners (Pisarchyk and Lee
//! 2020, "Efficient Memory Management for Deep Neural Net Inference"). Unlike the skyline, it can also complete partial
//! packings.

use super::problem::{Problem, align_up};

/// Offset of an unplaced item.
pub(super) const UNPLACED: u64 = u64::MAX;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Gaps {
    /// Offset and end of each placed neighbor, ascending.
    taken: Vec<(u64, u64)>,
    /// Number of neighbors examined since the caller last reset it: the measure of work.
    pub looks: u64,
}

impl Gaps {
    /// Returns the offset of the tightest gap below `capacity` that fits item `i`; the lowest of several.
    ///
    /// `offsets` contains the placed items; others are [`UNPLACED`]. With [`UNPLACED`] as capacity a place always
    /// exists: above all neighbors.
    pub fn best(&mut self, problem: &Problem, i: usize, offsets: &[u64], capacity: u64) -> Option<u64> {
        let (size, align) = (problem.size[i], problem.align[i]);
        self.taken.clear();
        for j in problem.neighbors(i) {
            self.looks += 1;
            if offsets[j] != UNPLACED && j != i {
                self.taken.push((offsets[j], offsets[j] + problem.size[j]));
            }
        }
        self.taken.sort_unstable();
        let (mut best, mut best_gap, mut roof) = (None, u64::MAX, 0);
        for &(offset, end) in &self.taken {
            let start = align_up(roof, align);
            if start + size <= offset && offset - roof < best_gap {
                (best, best_gap) = (Some(start), offset - roof);
            }
            roof = roof.max(end);
        }
        let start = align_up(roof, align);
        best.or((start + size <= capacity).then_some(start))
    }

    /// Packs all items in the given order. Returns the top.
    pub fn pack(&mut self, problem: &Problem, order: &[u32], offsets: &mut [u64]) -> u64 {
        offsets.fill(UNPLACED);
        let mut top = 0;
        for &i in order {
            let i = i as usize;
            offsets[i] = self.best(problem, i, offsets, UNPLACED).unwrap_or(0);
            top = top.max(offsets[i] + problem.size[i]);
        }
        top
    }
}
