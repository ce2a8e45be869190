//! Stable packing: keeps previous offsets as far as they do not raise the top.
//!
//! The top has priority; then previous offsets are kept, starting with large items. A previous offset is valid if it is
//! aligned and does not overlap the ones already kept. Other items are placed into gaps. If they do not fit under the
//! top, the previous offsets in their way are dropped, for a few rounds. If they still do not fit, the new packing is
//! used, and its items are moved back to their previous offsets where those are free.

use super::gap::{Gaps, UNPLACED};
use super::problem::Problem;

/// Maximum number of rounds.
const ROUNDS: u32 = 8;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Stable {
    /// The previous offset of each item; [`UNPLACED`] if there is none.
    earlier: Vec<u64>,
    /// Previous offsets that were not dropped.
    wanted: Vec<u64>,
    /// The packing that keeps them.
    pub offsets: Vec<u64>,
}

impl Stable {
    /// Stores the previous offsets, indexed by the caller's items.
    pub fn remember(&mut self, problem: &Problem, previous: &[Option<u64>]) {
        self.earlier.clear();
        self.earlier.extend((0..problem.len()).map(|i| {
            // Offsets with an end beyond 2^63 are ignored, so that sums of offset and size cannot overflow.
            let limit = i64::MAX as u64 - problem.size[i];
            let valid = |offset: &u64| offset.is_multiple_of(problem.align[i]) && *offset <= limit;
            previous[problem.item[i] as usize].filter(valid).unwrap_or(UNPLACED)
        }));
    }

    /// Packs within `capacity` and keeps previous offsets. Always succeeds if the capacity is [`UNPLACED`].
    ///
    /// `order` determines the order in which offsets are kept and gaps are filled. Returns the top; the packing is
    /// stored in `self.offsets`.
    pub fn pack(&mut self, problem: &Problem, order: &[u32], capacity: u64, gaps: &mut Gaps) -> Option<u64> {
        self.wanted.clear();
        self.wanted.extend_from_slice(&self.earlier);
        (0..ROUNDS).find_map(|round| self.round(problem, order, (capacity, round < ROUNDS / 2), gaps))
    }

    /// Makes one attempt. If an item does not fit, the previous offsets around it are dropped for the next attempt;
    /// initially only those of items that are not larger.
    fn round(
        &mut self,
        problem: &Problem,
        order: &[u32],
        (capacity, gently): (u64, bool),
        gaps: &mut Gaps,
    ) -> Option<u64> {
        let Self { wanted, offsets, .. } = self;
        offsets.clear();
        offsets.resize(problem.len(), UNPLACED);
        let (mut top, mut fits) = (0, true);
        for &i in order {
            let i = i as usize;
            if wanted[i] != UNPLACED
                && wanted[i] + problem.size[i] <= capacity
                && is_free(problem, offsets, i, wanted[i])
            {
                offsets[i] = wanted[i];
                top = top.max(offsets[i] + problem.size[i]);
            }
        }
        for &i in order {
            let i = i as usize;
            if offsets[i] != UNPLACED {
                continue;
            }
            match gaps.best(problem, i, offsets, capacity) {
                Some(offset) => {
                    offsets[i] = offset;
                    top = top.max(offset + problem.size[i]);
                }
                None => {
                    fits = false;
                    for j in problem.neighbors(i) {
                        if !gently || problem.size[j] <= problem.size[i] {
                            wanted[j] = UNPLACED;
                        }
                    }
                }
            }
        }
        fits.then_some(top)
    }

    /// Moves items of a finished packing back to their previous offsets if those are free and end at or below `top`.
    pub fn settle(&self, problem: &Problem, order: &[u32], top: u64, offsets: &mut [u64]) {
        let mut moved = true;
        let mut rounds = 0;
        while moved && rounds < ROUNDS {
            (moved, rounds) = (false, rounds + 1);
            for &i in order {
                let i = i as usize;
                let earlier = self.earlier[i];
                let elsewhere = earlier != UNPLACED && earlier != offsets[i];
                let low = elsewhere && earlier + problem.size[i] <= top;
                if low && is_free(problem, offsets, i, earlier) {
                    offsets[i] = earlier;
                    moved = true;
                }
            }
        }
    }

    /// Returns the number of items at their previous offset.
    pub fn kept(previous: &[Option<u64>], offsets: &[u64]) -> usize {
        previous.iter().zip(offsets).filter(|(previous, offset)| **previous == Some(**offset)).count()
    }
}

fn is_free(problem: &Problem, offsets: &[u64], i: usize, offset: u64) -> bool {
    let end = offset + problem.size[i];
    let clear = |j: usize| offsets[j] == UNPLACED || end <= offsets[j] || offsets[j] + problem.size[j] <= offset;
    problem.neighbors(i).all(|j| j == i || clear(j))
}
