//! Lower bound of the top: the maximum of live bytes, plus unavoidable padding.

use super::problem::{Problem, align_up};

/// A lower bound for every packing, and its origin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LowerBound {
    /// Lower bound of the top, in bytes.
    pub bytes: u64,
    /// Maximum of live bytes, in bytes.
    pub peak: u64,
    /// A time at which the maximum is reached.
    pub at: u32,
}

/// Returns the maximum of live bytes plus the unavoidable padding in that section.
///
/// All items of a section start at multiples of their smallest alignment, so the size of each is rounded up to it,
/// except that of the topmost. At best, the topmost is the one with the most padding.
pub(super) fn lower_bound(problem: &Problem) -> LowerBound {
    let mut bound = LowerBound::default();
    let mut section = None;
    for (s, &total) in problem.total.iter().enumerate() {
        if total > bound.peak {
            bound = LowerBound { bytes: total, peak: total, at: problem.time[s] };
            section = Some(s);
        }
    }
    if let Some(s) = section
        && !problem.dense
        && problem.align.iter().any(|&align| align > 1)
    {
        let members = || problem.members(s).iter().map(|&i| i as usize);
        let align = members().map(|i| problem.align[i]).min().unwrap_or(1);
        let waste = |i: usize| align_up(problem.size[i], align) - problem.size[i];
        let spared = members().map(waste).max().unwrap_or(0);
        bound.bytes += members().map(waste).sum::<u64>() - spared;
    }
    bound
}
