//! How low can the top be? The live bytes of the fullest section, and what alignment must waste there.

use super::problem::{Problem, align_up};

/// A bound that holds for every packing, and where it comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LowerBound {
    /// No packing has a lower top, bytes.
    pub bytes: u64,
    /// The largest sum of sizes alive at one time, bytes.
    pub peak: u64,
    /// A time of that peak.
    pub at: u32,
}

/// The peak of live bytes, raised by unavoidable padding in that section.
///
/// All items of a section start at multiples of their smallest alignment, so each but the topmost takes its size
/// rounded up to that. The topmost is at best the one that wastes most.
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
