//! Ejection search: items displace each other below a capacity that is slightly too low, until all are placed.
//!
//! Initially, the items of the best packing that end above the capacity are unplaced. An unplaced item is placed where
//! it overlaps the least weight, and the overlapped items become unplaced. Ejected items become heavier, so items that
//! are hard to place tend to stay. (Follows Nagata and Bräysy 2009, "A powerful route minimization heuristic for the
//! vehicle routing problem with time windows".) From time to time, all placed items are moved down or up, which joins
//! gaps.
//!
//! The search proves nothing. It lowers the top of instances with too many items for the exact search.

use super::gap::UNPLACED;
use super::meter::Meter;
use super::problem::{Problem, align_up};
use super::random::Random;

/// Initial weight of the largest item; others have less, by the square root of their area.
const WEIGHT: f64 = (1 << 20) as f64;
/// All weights are halved when one exceeds this value.
const HEAVIEST: u64 = 1 << 44;
/// The capacity is lowered by this fraction of the distance between bound and top, or by less after a failure.
const PART: u64 = 16;
/// Cost of a neighbor in array entries: it is read and sorted twice.
const LOOKS: u64 = 24;

/// The search and its reusable memory.
#[derive(Debug, Default)]
pub(super) struct Eject {
    /// Offset of each item; [`UNPLACED`] while it is unplaced.
    pub offsets: Vec<u64>,
    /// Maximum end of all items.
    pub capacity: u64,
    /// Steps since the capacity was lowered.
    pub tried: u64,
    part: u64,
    weight: Vec<u64>,
    waiting: Vec<u32>,
    placements: u64,
    random: Random,
    upward: bool,
    /// Start and weight, and end and weight, of each placed neighbor; both ascending.
    starts: Vec<(u64, u64)>,
    ends: Vec<(u64, u64)>,
    order: Vec<u32>,
    level: Vec<u64>,
}

impl Eject {
    /// Resets the weights; the next [`Eject::lower`] initializes them.
    pub fn reset(&mut self) {
        self.weight.clear();
        self.waiting.clear();
        self.part = PART;
        self.random = Random::default();
        self.placements = 0;
    }

    /// Starts to lower a packing with the given top towards the bound.
    pub fn lower(&mut self, problem: &Problem, packing: &[u64], (bound, top): (u64, u64)) {
        if self.weight.is_empty() {
            let area = |i: usize| (problem.size[i] as f64 * problem.span(i).len() as f64).sqrt();
            let most = (0..problem.len()).map(area).fold(1.0, f64::max);
            self.weight.extend((0..problem.len()).map(|i| 1 + (WEIGHT * area(i) / most) as u64));
        }
        let unit = problem.unit();
        self.part = if self.waiting.is_empty() { (self.part / 2).max(PART) } else { 2 * self.part };
        self.tried = 0;
        self.capacity = top - ((top - bound) / self.part / unit * unit).max(unit).min(top - bound);
        self.offsets.clear();
        self.offsets.extend_from_slice(packing);
        self.waiting.clear();
        for (i, offset) in self.offsets.iter_mut().enumerate() {
            if *offset + problem.size[i] > self.capacity {
                *offset = UNPLACED;
                self.waiting.push(i as u32);
            }
        }
    }

    /// Runs until all items are placed, `steps` are spent, or the meter is empty. Returns `true` if all items are
    /// placed.
    pub fn run(&mut self, problem: &Problem, steps: u64, meter: &mut Meter<'_>) -> bool {
        let (start, end) = (meter.spent, meter.spent.saturating_add(steps));
        let often = problem.len() as u64 / 4 + 1;
        while let Some(i) = self.next() {
            if meter.spent >= end || meter.is_empty() {
                self.waiting.push(i as u32);
                self.tried += meter.spent - start;
                return false;
            }
            self.placements += 1;
            let offset = self.lightest(problem, i);
            self.push_out(problem, i, offset);
            self.offsets[i] = offset;
            meter.spend(LOOKS * self.starts.len() as u64);
            if self.placements.is_multiple_of(often) {
                self.upward = !self.upward;
                self.settle(problem);
                meter.spend(problem.len() as u64 * 16);
            }
        }
        self.upward = false;
        self.settle(problem);
        true
    }

    /// Selects an unplaced item: a random one or the heaviest.
    fn next(&mut self) -> Option<usize> {
        if self.waiting.is_empty() {
            return None;
        }
        let k = match self.random.below(2) {
            0 => self.random.below(self.waiting.len() as u64) as usize,
            _ => (0..self.waiting.len()).max_by_key(|&k| self.weight[self.waiting[k] as usize])?,
        };
        Some(self.waiting.swap_remove(k) as usize)
    }

    /// Returns the offset where item `i` overlaps the least weight: on top of a neighbor, or directly below one.
    fn lightest(&mut self, problem: &Problem, i: usize) -> u64 {
        let Self { starts, ends, offsets, weight, .. } = self;
        starts.clear();
        ends.clear();
        for j in problem.neighbors(i).filter(|&j| offsets[j] != UNPLACED) {
            starts.push((offsets[j], weight[j]));
            ends.push((offsets[j] + problem.size[j], weight[j]));
        }
        starts.sort_unstable_by_key(|start| start.0);
        ends.sort_unstable_by_key(|end| end.0);
        let (size, align) = (problem.size[i], problem.align[i]);
        let mut best = Candidate { weight: u64::MAX, offset: 0, equals: 0 };
        let upward = core::iter::once(0).chain(ends.iter().map(|end| align_up(end.0, align)));
        best.scan(upward, starts, ends, (size, self.capacity), &mut self.random);
        if best.weight > 0 {
            let roofs = starts.iter().map(|start| start.0).chain([self.capacity]);
            let downward = roofs.filter(|&roof| roof >= size).map(|roof| (roof - size) & !(align - 1));
            best.scan(downward, starts, ends, (size, self.capacity), &mut self.random);
        }
        best.offset
    }

    /// Ejects everything that item `i` overlaps at `offset`, and increases its weight.
    fn push_out(&mut self, problem: &Problem, i: usize, offset: u64) {
        let mut heaviest = 0;
        for j in problem.neighbors(i) {
            let start = self.offsets[j];
            if start != UNPLACED && start < offset + problem.size[i] && offset < start + problem.size[j] {
                self.offsets[j] = UNPLACED;
                self.waiting.push(j as u32);
                self.weight[j] += self.weight[j] / 50 + 1;
                heaviest = heaviest.max(self.weight[j]);
            }
        }
        if heaviest > HEAVIEST {
            self.weight.iter_mut().for_each(|weight| *weight = *weight / 2 + 1);
        }
    }

    /// Moves every placed item down as far as possible, or up to the capacity.
    fn settle(&mut self, problem: &Problem) {
        let Self { offsets, order, level, .. } = self;
        order.clear();
        order.extend((0..problem.len() as u32).filter(|&i| offsets[i as usize] != UNPLACED));
        order.sort_unstable_by_key(|&i| (offsets[i as usize], i));
        if self.upward {
            order.reverse();
        }
        level.clear();
        level.resize(problem.sections(), if self.upward { self.capacity } else { 0 });
        for &i in order.iter() {
            let i = i as usize;
            let levels = &mut level[problem.span(i)];
            if self.upward {
                let roof = levels.iter().copied().min().unwrap_or(0);
                offsets[i] = (roof - problem.size[i]) & !(problem.align[i] - 1);
                levels.fill(offsets[i]);
            } else {
                let floor = levels.iter().copied().max().unwrap_or(0);
                offsets[i] = align_up(floor, problem.align[i]);
                levels.fill(offsets[i] + problem.size[i]);
            }
        }
    }
}

/// The best offset so far.
struct Candidate {
    weight: u64,
    offset: u64,
    /// Number of offsets with that weight so far; each is equally likely to be selected.
    equals: u64,
}

impl Candidate {
    /// Examines ascending offsets.
    fn scan(
        &mut self,
        offsets: impl Iterator<Item = u64>,
        starts: &[(u64, u64)],
        ends: &[(u64, u64)],
        (size, capacity): (u64, u64),
        random: &mut Random,
    ) {
        let (mut started, mut ended, mut weight) = (0, 0, 0);
        for offset in offsets {
            if offset + size > capacity {
                break;
            }
            while started < starts.len() && starts[started].0 < offset + size {
                weight += starts[started].1;
                started += 1;
            }
            while ended < ends.len() && ends[ended].0 <= offset {
                weight -= ends[ended].1;
                ended += 1;
            }
            if weight < self.weight {
                *self = Self { weight, offset, equals: 1 };
            } else if weight == self.weight {
                self.equals += 1;
                self.offset = if random.below(self.equals) == 0 { offset } else { self.offset };
            }
            if self.weight == 0 {
                break;
            }
        }
    }
}
