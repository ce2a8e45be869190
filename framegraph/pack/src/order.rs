//! Orders in which solvers consider items: the criterion decides, then a second one, then the order of birth.

use super::problem::Problem;

/// Which items come first. Each name lists the criteria, all largest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Live bytes of the item's fullest section, then area.
    PeakArea,
    /// Live bytes of the item's fullest section, then lifetime.
    PeakWidth,
    /// Live bytes of the item's fullest section, then death.
    PeakDeath,
    /// Live bytes of the item's fullest section, then the number of sections.
    PeakSpan,
    /// Lifetime, then live bytes.
    WidthPeak,
    /// Area, then size.
    Area,
    /// Size, then lifetime.
    Size,
    /// Live bytes times weight of the section of the item where that is most, then lifetime.
    WeightedPeak,
    /// The largest weight of the item's sections, then area.
    WeightedArea,
}

/// What the orders look at besides the items themselves.
#[derive(Clone, Copy)]
pub(super) struct Criteria<'a> {
    /// Live bytes of each section, over the items that matter.
    pub total: &'a [u64],
    /// A weight for each section; only the weighted orders look at them.
    pub weights: &'a [u32],
}

/// A sort key: ascending in this is the order asked for.
pub(super) type Key = (u64, u64, u32);

impl Order {
    /// The sort key of item `i`.
    pub fn key(self, problem: &Problem, criteria: Criteria<'_>, i: usize) -> Key {
        let peak = || criteria.total[problem.span(i)].iter().copied().max().unwrap_or(0);
        let width = u64::from(problem.width[i]);
        let span = u64::from(problem.hi[i] - problem.lo[i]);
        // Lifetime first, with the size breaking ties, in one number.
        let long = |major: u64| major << 32 | problem.size[i].min(u64::from(u32::MAX));
        let (first, second) = match self {
            Self::PeakArea => (peak(), problem.area(i)),
            Self::PeakWidth => (peak(), long(width)),
            Self::PeakDeath => (peak(), long(u64::from(problem.hi[i]))),
            Self::PeakSpan => (peak(), span << 32 | u64::from(u32::MAX - i as u32)),
            Self::WidthPeak => (width, peak()),
            Self::Area => (problem.area(i), problem.size[i]),
            Self::Size => (problem.size[i], width),
            Self::WeightedPeak => {
                let weigh = |s: usize| criteria.total[s].saturating_mul(u64::from(criteria.weights[s]));
                (problem.span(i).map(weigh).max().unwrap_or(0), long(width))
            }
            Self::WeightedArea => {
                let heaviest = criteria.weights[problem.span(i)].iter().copied().max().unwrap_or(0);
                (u64::from(heaviest), problem.area(i))
            }
        };
        (!first, !second, i as u32)
    }
}
