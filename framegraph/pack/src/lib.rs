//! Offsets in one heap for resources with fixed lifetimes: static memory planning.
//!
//! Given when each item is alive and how large it is, [`pack`] chooses offsets so that items alive together do not
//! overlap and the top, the heap's size, is low. The problem is NP-hard (Garey and Johnson 1979, SR2, "dynamic
//! storage allocation"), yet on render graphs an optimal packing with its proof is nearly always to be had: no
//! packing is lower than the peak of live bytes, so one that reaches it is optimal.
//!
//! Where resources share memory only with their like, [`classes`] numbers what is alike.
//!
//! Two efforts build on each other ([`Effort`]): a portfolio of greedy packings, and three searches that take turns.
//! Both are deterministic and measured in steps, never in time, so that equal input gives equal offsets on every machine.
//!
//! ```
//! use framegraph_pack::{Interval, Options, Scratch, pack};
//!
//! let items = [
//!     Interval { lower: 0, upper: 3, size: 4, align: 1 },
//!     Interval { lower: 3, upper: 9, size: 4, align: 1 }, // may take the place of the first
//!     Interval { lower: 0, upper: 9, size: 4, align: 1 },
//! ];
//! let mut offsets = Vec::new();
//! let packing = pack(&items, None, &Options::default(), &mut Scratch::default(), &mut offsets)?;
//! assert_eq!((packing.top, packing.lower_bound, packing.optimal), (8, 8, true));
//! assert_eq!(offsets[0], offsets[1]);
//! # Ok::<(), framegraph_pack::PackError>(())
//! ```

mod canonical;
pub mod classes;
#[cfg(feature = "testing")]
pub mod csv;
mod eject;
#[cfg(feature = "testing")]
pub mod entropy;
mod error;
mod exact;
mod gap;
mod greedy;
mod join;
mod lower_bound;
mod meter;
mod narrow;
mod order;
#[cfg(feature = "testing")]
pub mod planted;
mod problem;
mod random;
mod skyline;
mod stable;
mod sweep;
#[cfg(test)]
mod tests;

use core::ops::ControlFlow;
pub use error::PackError;
use gap::UNPLACED;
use greedy::Greedy;
use lower_bound::lower_bound;
pub use meter::Progress;
use meter::{Bracket, Meter};
use narrow::Narrow;
use order::Order;
pub use problem::Interval;
use problem::Problem;
use stable::Stable;

/// How hard to try.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Effort {
    /// The best of several greedy packings, in about linear time.
    Greedy,
    /// Greedy, then an exact search, which proves what it finds. Where it does not within the default budget, two searches
    /// that lower the top without a proof take turns with it. Files may also say `Search`, an effort between the two
    /// that never found a lower top.
    #[default]
    #[cfg_attr(feature = "serde", serde(alias = "Search"))]
    Exact,
}

/// What [`pack`] may spend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// How hard to try.
    pub effort: Effort,
    /// What the searches may spend. A step is 64 array entries looked at, about 0.15 to 0.3 µs.
    pub budget_steps: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { effort: Effort::Exact, budget_steps: 1 << 18 }
    }
}

/// Which solver the offsets are from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The earlier packing, or as much of it as fits under the same top.
    Kept,
    /// A greedy packing.
    Greedy,
    /// A search of [`Effort::Exact`].
    Exact,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packing {
    /// The highest end of any item: the heap's size, bytes.
    pub top: u64,
    /// No packing has a lower top, bytes.
    pub lower_bound: u64,
    /// The largest sum of sizes that are alive at one time, bytes; at most `lower_bound`.
    pub peak: u64,
    /// A time of that peak: the items that form it are those alive then.
    pub peak_at: u32,
    /// Whether the top is proved to be the lowest: it equals `lower_bound`.
    pub optimal: bool,
    /// Steps spent of the budget.
    pub steps: u64,
    /// How many items are at their previous offset.
    pub kept: usize,
    /// Which solver the offsets are from.
    pub method: Method,
}

/// Reusable memory: once warm, packing allocates nothing.
#[derive(Debug, Default)]
pub struct Scratch {
    problem: Problem,
    greedy: Greedy,
    narrow: Narrow,
    stable: Stable,
    best: Vec<u64>,
}

/// Chooses an offset for every item; `offsets` receives them in the order of the items.
///
/// Items alive together do not overlap, every offset is a multiple of its item's alignment, and the top is as low as
/// the effort and the budget allow.
///
/// `previous`, one entry an item, are offsets to keep: the top is never higher than without them, and under that top
/// as many as possible stay, those of large items first. Offsets that are not aligned or in each other's way are
/// taken for none.
///
/// An instance with more than 2^26 pairs of items alive together, and more than 256 an item, is only swept once in
/// the order of birth; `previous` is not looked at then.
///
/// Time: greedy packing takes about 0.4 µs an item on render graphs, and a few ns a pair of items alive together where
/// these are many. Memory: linear in the items and the sections they live in, at most about 1 KiB an item or 256 MiB.
///
/// # Errors See [`PackError`]; `offsets` is then untouched.
pub fn pack(
    items: &[Interval],
    previous: Option<&[Option<u64>]>,
    options: &Options,
    scratch: &mut Scratch,
    offsets: &mut Vec<u64>,
) -> Result<Packing, PackError> {
    pack_watched(items, previous, options, scratch, offsets, &mut |_| ControlFlow::Continue(()))
}

/// As [`pack`], and tells `watch` how far it is every few milliseconds of [`Effort::Exact`]: 2^14 steps.
///
/// Where `watch` breaks, the best packing so far is returned as if the budget had ended. So a caller that has a clock,
/// or a signal, can end the search by it; what is found in so many steps is the same on every machine.
///
/// ```
/// use framegraph_pack::{Interval, Options, Scratch, pack_watched};
/// use std::ops::ControlFlow;
/// use std::time::{Duration, Instant};
///
/// let items = [Interval { lower: 0, upper: 3, size: 4, align: 1 }, Interval { lower: 3, upper: 9, size: 4, align: 1 }];
/// let (mut offsets, end) = (Vec::new(), Instant::now() + Duration::from_secs(10));
/// let options = Options { budget_steps: u64::MAX, ..Options::default() };
/// let packing = pack_watched(&items, None, &options, &mut Scratch::default(), &mut offsets, &mut |progress| {
///     eprintln!("top {}, lower bound {}", progress.top, progress.lower_bound);
///     if Instant::now() < end { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
/// })?;
/// assert_eq!(packing.top, 4);
/// # Ok::<(), framegraph_pack::PackError>(())
/// ```
///
/// # Errors
/// See [`PackError`]; `offsets` is then untouched.
pub fn pack_watched(
    items: &[Interval],
    previous: Option<&[Option<u64>]>,
    options: &Options,
    scratch: &mut Scratch,
    offsets: &mut Vec<u64>,
    watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Packing, PackError> {
    if let Some(previous) = previous
        && previous.len() != items.len()
    {
        return Err(PackError::PreviousLength { items: items.len(), previous: previous.len() });
    }
    scratch.problem.prepare(items)?;
    let bound = lower_bound(&scratch.problem);
    let bracket = Bracket { bound: bound.bytes, top: u64::MAX };
    let mut meter = Meter::new(bracket, options.budget_steps, watch);
    let (bracket, method) = solve(scratch, previous, options.effort, &mut meter);
    offsets.clear();
    offsets.resize(items.len(), 0);
    for (&item, &offset) in scratch.problem.item.iter().zip(&scratch.best) {
        offsets[item as usize] = offset;
    }
    Ok(Packing {
        top: bracket.top,
        lower_bound: bracket.bound,
        peak: bound.peak,
        peak_at: bound.at,
        optimal: !bracket.is_open(),
        steps: meter.spent,
        kept: previous.map_or(0, |previous| Stable::kept(previous, offsets)),
        method,
    })
}

/// The efforts in their order, until bound and top meet. The packing is left in `scratch.best`.
fn solve(
    scratch: &mut Scratch,
    previous: Option<&[Option<u64>]>,
    effort: Effort,
    meter: &mut Meter<'_>,
) -> (Bracket, Method) {
    let Scratch { problem, greedy, narrow, stable, best } = scratch;
    let bound = meter.bracket.bound;
    let previous = previous.filter(|_| !problem.dense);
    let mut kept = u64::MAX;
    if let Some(previous) = previous {
        greedy.sort(problem, Order::Size);
        stable.remember(problem, previous);
        kept = stable.pack(problem, &greedy.order, UNPLACED, &mut greedy.gaps).unwrap_or(kept);
        if kept == bound {
            best.clone_from(&stable.offsets);
            return (Bracket { bound, top: kept }, Method::Kept);
        }
    }
    let top = greedy.pack(problem, bound, best);
    let mut method = Method::Greedy;
    meter.bracket.top = top;
    if effort == Effort::Exact && !problem.dense {
        narrow.minimize(problem, best, meter);
        method = if meter.bracket.top < top { Method::Exact } else { method };
    }
    let mut bracket = meter.bracket;
    if previous.is_some() {
        if kept > bracket.top {
            greedy.sort(problem, Order::Size);
            kept = stable.pack(problem, &greedy.order, bracket.top, &mut greedy.gaps).unwrap_or(u64::MAX);
        }
        if kept <= bracket.top {
            best.clone_from(&stable.offsets);
            (bracket.top, method) = (kept, Method::Kept);
        } else {
            stable.settle(problem, &greedy.order, bracket.top, best);
            bracket.top = exact::top(problem, best);
        }
    }
    (bracket, method)
}
