//! Placements that stay put: earlier offsets are kept as far as they cost nothing.
//!
//! The rule, in this order: the top is as low as without earlier offsets; then earlier offsets are kept, those of large
//! items first. An earlier offset counts if it is aligned and free of those already kept. Items without one go into the
//! gaps. Where that does not fit under the top, the earlier offsets in the way of what did not fit are given up, for a few
//! rounds; if it still does not fit, the new packing is taken as it is.

use super::gap::{Gaps, UNPLACED};
use super::problem::Problem;

/// How often earlier offsets may be given up.
const ROUNDS: u32 = 8;

/// Reusable memory.
#[derive(Debug, Default)]
pub(super) struct Stable {
    /// The earlier offset of each item; [`UNPLACED`] without one, or given up.
    earlier: Vec<u64>,
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
            previous[problem.item[i] as usize]
                .filter(valid)
                .unwrap_or(UNPLACED)
        }));
    }

    /// Packs under `capacity`, keeping earlier offsets; with [`UNPLACED`] for the capacity that always succeeds.
    ///
    /// `order` is that in which offsets are kept and gaps are filled. Returns the top; the packing is in `self.offsets`.
    pub fn pack(
        &mut self,
        problem: &Problem,
        order: &[u32],
        capacity: u64,
        gaps: &mut Gaps,
    ) -> Option<u64> {
        (0..ROUNDS).find_map(|_| self.round(problem, order, capacity, gaps))
    }

    fn round(
        &mut self,
        problem: &Problem,
        order: &[u32],
        capacity: u64,
        gaps: &mut Gaps,
    ) -> Option<u64> {
        let Self { earlier, offsets } = self;
        offsets.clear();
        offsets.resize(problem.len(), UNPLACED);
        let (mut top, mut fits) = (0, true);
        for &i in order {
            let i = i as usize;
            if earlier[i] != UNPLACED
                && earlier[i] + problem.size[i] <= capacity
                && is_free(problem, offsets, i, earlier[i])
            {
                offsets[i] = earlier[i];
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
                    problem.neighbors(i).for_each(|j| earlier[j] = UNPLACED);
                }
            }
        }
        fits.then_some(top)
    }

    /// How many items are where they were.
    pub fn kept(previous: &[Option<u64>], offsets: &[u64]) -> usize {
        previous
            .iter()
            .zip(offsets)
            .filter(|(previous, offset)| **previous == Some(**offset))
            .count()
    }
}

fn is_free(problem: &Problem, offsets: &[u64], i: usize, offset: u64) -> bool {
    let end = offset + problem.size[i];
    let clear = |j: usize| {
        offsets[j] == UNPLACED || end <= offsets[j] || offsets[j] + problem.size[j] <= offset
    };
    problem.neighbors(i).all(|j| j == i || clear(j))
}
