//! Static memory planning: chooses offsets in a heap for resources with fixed lifetimes.
//!
//! Given the lifetime and size of each item, [`pack`] chooses offsets such that items that are live at the same time do
//! not overlap. It minimizes the top, which is the size of the heap. The problem is NP-hard (Garey and Johnson 1979,
//! SR2, "dynamic storage allocation"). For render graphs, an optimal packing is nearly always found and proved: no
//! packing is lower than the maximum of live bytes, so a packing that reaches it is optimal.
//!
//! # When to use it
//!
//! - Placed resources of a render graph, or tensors of a neural network: lifetimes are known before memory is
//!   allocated.
//! - Offline tools that need a proof of optimality, or a lower bound.
//!
//! It is not an online allocator: all lifetimes must be known. For memory that is shared only between resources of
//! equal shape, use [`classes`].
//!
//! # Example
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
//!
//! # How it works
//!
//! [`Effort`] selects between a portfolio of greedy packings, and the same followed by three searches in turn. Both are
//! deterministic and limited in steps, not in time, so equal input gives equal offsets on every machine.
//!
//! # Cargo features
//!
//! | feature | default | effect |
//! | --- | --- | --- |
//! | `serde` | no | `Serialize` and `Deserialize` for [`Effort`] |
//! | `testing` | no | random instances, instances with a known optimum, and CSV tables |

#![cfg_attr(docsrs, feature(doc_cfg))]

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

/// Effort spent on packing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Effort {
    /// The best of several greedy packings, in nearly linear time.
    Greedy,
    /// Greedy packing followed by an exact search with a proof. If the proof needs more than the default budget, two
    /// searches without proof run in turn with it. Files may also contain `Search`, a former effort between the two.
    #[default]
    #[cfg_attr(feature = "serde", serde(alias = "Search"))]
    Exact,
}

/// Effort and budget of [`pack`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Effort.
    pub effort: Effort,
    /// Budget of the searches. A step examines 64 array entries and takes about 0.15 to 0.3 µs.
    pub budget_steps: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { effort: Effort::Exact, budget_steps: 1 << 18 }
    }
}

/// The solver that found the offsets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The previous offsets, as far as they fit under the same top.
    Kept,
    /// A greedy packing.
    Greedy,
    /// A search of [`Effort::Exact`].
    Exact,
}

/// Result of packing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packing {
    /// The highest end of any item, which is the size of the heap, in bytes.
    pub top: u64,
    /// Lower bound of the top of any packing, in bytes.
    pub lower_bound: u64,
    /// Maximum of the live bytes over time; at most `lower_bound`.
    pub peak: u64,
    /// A time at which the maximum is reached.
    pub peak_at: u32,
    /// The top is proved to be minimal: it equals `lower_bound`.
    pub optimal: bool,
    /// Number of steps spent.
    pub steps: u64,
    /// Number of items at their previous offset.
    pub kept: usize,
    /// The solver that found the offsets.
    pub method: Method,
}

/// Reusable memory: once warm, packing does not allocate.
#[derive(Debug, Default)]
pub struct Scratch {
    problem: Problem,
    greedy: Greedy,
    narrow: Narrow,
    stable: Stable,
    best: Vec<u64>,
}

/// Chooses an offset for every item and writes them to `offsets`, in the order of the items.
///
/// Items that are live at the same time do not overlap, every offset is a multiple of its item's alignment, and the top
/// is minimized within the limits of `options`.
///
/// `previous` contains offsets to keep, one entry per item. They never raise the top; within that top, as many as
/// possible are kept, starting with large items. Offsets that are misaligned or overlap each other are ignored.
///
/// Instances are called dense if more than 2^26 pairs of items, and more than 256 per item, are live at the same time.
/// They are packed by a single sweep in the order of birth, ignoring `previous`.
///
/// Time: greedy packing takes about 0.4 µs per item on render graphs, plus a few ns per pair of items that are live at
/// the same time. Memory: linear in the number of items and their sections, at most about 1 KiB per item or 256 MiB.
///
/// # Errors
///
/// See [`PackError`]; `offsets` is unchanged in case of an error.
pub fn pack(
    items: &[Interval],
    previous: Option<&[Option<u64>]>,
    options: &Options,
    scratch: &mut Scratch,
    offsets: &mut Vec<u64>,
) -> Result<Packing, PackError> {
    pack_watched(items, previous, options, scratch, offsets, &mut |_| ControlFlow::Continue(()))
}

/// Packs like [`pack`] and reports progress to `watch` every 2^14 steps (a few milliseconds) of [`Effort::Exact`].
///
/// If `watch` returns `Break`, the best packing so far is returned, as if the budget had ended. A caller can so end the
/// search by time or by a signal. The result after a given number of steps is the same on every machine.
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
/// See [`PackError`]; `offsets` is unchanged in case of an error.
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

/// Runs the solvers of the effort until bound and top meet. The packing is stored in `scratch.best`.
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
