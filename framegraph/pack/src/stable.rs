//! Placements that stay put: earlier offsets are kept as far as they cost nothing.
//!
//! The rule, in this order: the top is as low as without earlier offsets; then earlier offsets are kept, those of
//! large items first. An earlier offset counts if it is aligned and free of those already kept. Items without one go
//! into the gaps. Where that does not fit under the top, the earlier offsets in the way of what did not fit are given
//! up, for a few rounds; if it still does not fit, the new packing is taken and its items go back where they find
//! their place free.

use super::gap::{Gaps, UNPLACED};
use super::problem::Problem;

/// How often earlier offsets may be given up.
const ROUNDS: u32 = 8;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Stable {
    /// The earlier offset of each item; [`UNPLACED`] without one.
    earlier: Vec<u64>,
    /// Those not given up.
    wanted: Vec<u64>,
    /// The packing that keeps them.
    pub offsets: Vec<u64>,
}

impl Stable {
    /// Notes the earlier offsets, given by the caller's item index.
    pub fn remember(&mut self, problem: &Problem, previous: &[Option<u64>]) {
        self.earlier.clear();
        self.earlier.extend((0..problem.len()).map(|i| {
            // An end beyond 2^63 is as good as none: so no sum of offset and sizes overflows.
            let limit = i64::MAX as u64 - problem.size[i];
            let valid = |offset: &u64| offset.is_multiple_of(problem.align[i]) && *offset <= limit;
            previous[problem.item[i] as usize].filter(valid).unwrap_or(UNPLACED)
        }));
    }

    /// Packs under `capacity`, keeping earlier offsets; with [`UNPLACED`] for the capacity that always succeeds.
    ///
    /// `order` is that in which offsets are kept and gaps are filled. Returns the top; the packing is in
    /// `self.offsets`.
    pub fn pack(&mut self, problem: &Problem, order: &[u32], capacity: u64, gaps: &mut Gaps) -> Option<u64> {
        self.wanted.clear();
        self.wanted.extend_from_slice(&self.earlier);
        (0..ROUNDS).find_map(|round| self.round(problem, order, (capacity, round < ROUNDS / 2), gaps))
    }

    /// One attempt. Where an item does not fit, the earlier offsets around it are given up for the next attempt; at
    /// first only those of items that are no larger.
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

    /// Moves items of a finished packing back to their earlier offsets where those are free and end by `top`.
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

    /// How many items are where they were.
    pub fn kept(previous: &[Option<u64>], offsets: &[u64]) -> usize {
        previous.iter().zip(offsets).filter(|(previous, offset)| **previous == Some(**offset)).count()
    }
}

fn is_free(problem: &Problem, offsets: &[u64], i: usize, offset: u64) -> bool {
    let end = offset + problem.size[i];
    let clear = |j: usize| offsets[j] == UNPLACED || end <= offsets[j] || offsets[j] + problem.size[j] <= offset;
    problem.neighbors(i).all(|j| j == i || clear(j))
}
