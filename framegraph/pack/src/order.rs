//! Orders in which solvers consider items: by a criterion, then by a second one, then by birth.

use super::problem::Problem;

/// The order of items. Each name lists the criteria, all descending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Live bytes of the item's fullest section, then area.
    PeakArea,
    /// Live bytes of the item's fullest section, then length of the lifetime.
    PeakWidth,
    /// Live bytes of the item's fullest section, then end of the lifetime.
    PeakDeath,
    /// Live bytes of the item's fullest section, then number of sections.
    PeakSpan,
    /// Length of the lifetime, then live bytes of the fullest section.
    WidthPeak,
    /// Area, then size.
    Area,
    /// Size, then length of the lifetime.
    Size,
    /// Maximum of live bytes times weight over the item's sections, then length of the lifetime.
    WeightedPeak,
    /// Maximum weight of the item's sections, then area.
    WeightedArea,
}

/// Inputs of the orders, apart from the items.
#[derive(Clone, Copy)]
pub(super) struct Criteria<'a> {
    /// Live bytes of each section, over the relevant items.
    pub total: &'a [u64],
    /// Weight of each section; used only by weighted orders.
    pub weights: &'a [u32],
}

/// Sort key; ascending keys give the order.
pub(super) type Key = (u64, u64, u32);

impl Order {
    /// Returns the sort key of item `i`.
    pub fn key(self, problem: &Problem, criteria: Criteria<'_>, i: usize) -> Key {
        let peak = || criteria.total[problem.span(i)].iter().copied().max().unwrap_or(0);
        let width = u64::from(problem.width[i]);
        let span = u64::from(problem.hi[i] - problem.lo[i]);
        // Combines a major criterion with the size in one number.
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
