//! A prepared instance, shared by all solvers: items ordered by birth, and time compressed to sections.
//!
//! A *section* is a maximal period of time whose live set is not contained in another one. Two items are live at the
//! same time if and only if they share a section. Only sections can be full. Sections are the maximal cliques of an
//! interval graph, in time order.

use crate::error::PackError;

/// The memory demand of one resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Interval {
    /// Start of the lifetime, in any unit. The compiler uses steps.
    pub lower: u32,
    /// End of the lifetime, exclusive; above `lower`.
    pub upper: u32,
    /// Size in bytes. Items of size 0 are placed at 0 and overlap nothing.
    pub size: u64,
    /// Alignment of the offset in bytes; a power of two.
    pub align: u64,
}

/// A prepared instance. Item indices in solvers are *local*: positions in these arrays.
#[derive(Debug, Default)]
pub(super) struct Problem {
    /// Caller's index of each local item; items of size 0 are omitted.
    pub item: Vec<u32>,
    /// Size in bytes, above 0.
    pub size: Vec<u64>,
    /// Alignment in bytes, a power of two.
    pub align: Vec<u64>,
    /// Length of the lifetime in the caller's units, above 0.
    pub width: Vec<u32>,
    /// First section of each item. Ascending, because items are numbered by birth.
    pub lo: Vec<u32>,
    /// End of each item's sections, exclusive.
    pub hi: Vec<u32>,
    /// Live bytes of each section.
    pub total: Vec<u64>,
    /// A time at which all items of the section are live.
    pub time: Vec<u32>,
    /// First item born in each section or later; has one more entry than there are sections.
    pub born: Vec<u32>,
    /// Start of each section's members in `member`; has one more entry than there are sections. Empty if `dense`.
    member_at: Vec<u32>,
    member: Vec<u32>,
    /// Too many pairs of items are live at the same time to examine each. Only the sweep can pack such an instance.
    pub dense: bool,
    sorted: Vec<u64>,
    clock: Vec<u32>,
    events: Vec<u8>,
}

/// Limit of (item, section) pairs, which need 128 MiB, and limit of pairs per item. An instance that exceeds both is
/// dense, or one with twice as many pairs of items that are live at the same time.
const DENSE_PAIRS: u64 = 1 << 25;
const DENSE_PER_ITEM: u64 = 128;
const BIRTH: u8 = 1;
const DEATH: u8 = 2;

impl Problem {
    /// Number of items with a size above 0.
    pub fn len(&self) -> usize {
        self.item.len()
    }

    /// Number of sections.
    pub fn sections(&self) -> usize {
        self.total.len()
    }

    /// The sections of item `i`.
    pub fn span(&self, i: usize) -> core::ops::Range<usize> {
        self.lo[i] as usize..self.hi[i] as usize
    }

    /// The items that live in section `s`, ascending. Not available for dense instances.
    pub fn members(&self, s: usize) -> &[u32] {
        &self.member[self.member_at[s] as usize..self.member_at[s + 1] as usize]
    }

    /// Every item that shares a section with `i`, including `i`: those live at its birth, then those born later.
    pub fn neighbors(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let (lo, hi) = (self.lo[i] as usize, self.hi[i] as usize);
        let later = self.born[lo + 1] as usize..self.born[hi] as usize;
        self.members(lo).iter().map(|&j| j as usize).chain(later)
    }

    /// Length of the lifetime times size. Saturates.
    pub fn area(&self, i: usize) -> u64 {
        self.size[i].saturating_mul(u64::from(self.width[i]))
    }

    /// Fills `self` from the caller's items and reuses its memory. Time: `n log n` for sorting.
    ///
    /// # Errors
    /// Returns an error for the first invalid item in the caller's order; see [`PackError`].
    pub fn prepare(&mut self, items: &[Interval]) -> Result<(), PackError> {
        check(items)?;
        self.sort_by_birth(items);
        self.compress_time(items);
        self.check_demand()?;
        self.sum_sections();
        self.list_members();
        Ok(())
    }

    fn sort_by_birth(&mut self, items: &[Interval]) {
        self.sorted.clear();
        let live = items.iter().zip(0u64..).filter(|(item, _)| item.size > 0);
        self.sorted.extend(live.map(|(item, index)| u64::from(item.lower) << 32 | index));
        if !self.sorted.is_sorted() {
            self.sorted.sort_unstable();
        }
        self.item.clear();
        self.item.extend(self.sorted.iter().map(|&key| key as u32));
        self.size.clear();
        self.align.clear();
        self.width.clear();
        for &index in &self.item {
            let item = &items[index as usize];
            self.size.push(item.size);
            self.align.push(item.align);
            self.width.push(item.upper - item.lower);
        }
    }

    /// Converts lifetimes into ranges of sections. A section ends at a death that follows a birth.
    fn compress_time(&mut self, items: &[Interval]) {
        let Self { item, lo, hi, time, sorted, clock, events, .. } = self;
        let live = || item.iter().map(|&index| &items[index as usize]);
        let first = live().next().map_or(0, |item| item.lower);
        let last = live().map(|item| item.upper).max().unwrap_or(0);
        // Times are used as indices directly if there are few, otherwise by rank among all endpoints.
        let direct = u64::from(last - first) <= 8 * item.len() as u64;
        sorted.clear();
        if !direct {
            sorted.extend(live().flat_map(|item| [u64::from(item.lower), u64::from(item.upper)]));
            sorted.sort_unstable();
            sorted.dedup();
        }
        let slot = |t: u32| match direct {
            true => (t - first) as usize,
            false => sorted.partition_point(|&other| other < u64::from(t)),
        };
        let slots = if direct { (last - first) as usize + 1 } else { sorted.len() };
        events.clear();
        events.resize(slots, 0);
        lo.clear();
        hi.clear();
        for item in live() {
            let (birth, death) = (slot(item.lower), slot(item.upper));
            events[birth] |= BIRTH;
            events[death] |= DEATH;
            lo.push(birth as u32);
            hi.push(death as u32);
        }
        clock.clear();
        time.clear();
        let mut pending = None;
        for (t, &event) in events.iter().enumerate() {
            if event & DEATH != 0 {
                time.extend(pending.take());
            }
            clock.push(time.len() as u32);
            if event & BIRTH != 0 {
                pending = Some(if direct { first + t as u32 } else { sorted[t] as u32 });
            }
        }
        for t in lo.iter_mut().chain(hi) {
            *t = clock[*t as usize];
        }
    }

    /// Rejects instances whose offsets could exceed 2^63, separately for groups of items that share no time.
    fn check_demand(&self) -> Result<(), PackError> {
        let (mut demand, mut end) = (0u128, 0);
        for i in 0..self.len() {
            if self.lo[i] >= end {
                demand = 0;
            }
            end = end.max(self.hi[i]);
            demand += u128::from(self.size[i]) + u128::from(self.align[i] - 1);
            if demand > i64::MAX as u128 {
                return Err(PackError::TooLarge { item: self.item[i] as usize });
            }
        }
        Ok(())
    }

    fn sum_sections(&mut self) {
        let Self { size, lo, hi, total, time, born, .. } = self;
        total.clear();
        total.resize(time.len() + 1, 0);
        born.clear();
        for (i, &size) in size.iter().enumerate() {
            let (lo, hi) = (lo[i] as usize, hi[i] as usize);
            total[lo] = total[lo].wrapping_add(size);
            total[hi] = total[hi].wrapping_sub(size);
            if born.len() <= lo {
                born.resize(lo + 1, i as u32);
            }
        }
        born.resize(time.len() + 1, size.len() as u32);
        total.pop();
        let mut live = 0u64;
        for total in total {
            live = live.wrapping_add(*total);
            *total = live;
        }
    }

    fn list_members(&mut self) {
        let Self { lo, hi, time, born, member_at, member, .. } = self;
        member_at.clear();
        member.clear();
        let pairs: u64 = lo.iter().zip(hi.iter()).map(|(&lo, &hi)| u64::from(hi - lo)).sum();
        let limit = DENSE_PAIRS.max(DENSE_PER_ITEM * lo.len() as u64).min(u64::from(u32::MAX));
        self.dense = pairs > limit || pairs_alive_together(lo, hi, born) > 2 * limit;
        if self.dense {
            return;
        }
        member_at.resize(time.len() + 2, 0);
        for (&lo, &hi) in lo.iter().zip(hi.iter()) {
            for count in &mut member_at[lo as usize + 2..hi as usize + 2] {
                *count += 1;
            }
        }
        let mut sum = 0;
        for count in member_at.iter_mut() {
            sum += *count;
            *count = sum;
        }
        member.resize(pairs as usize, 0);
        for (i, (&lo, &hi)) in lo.iter().zip(hi.iter()).enumerate() {
            for at in &mut member_at[lo as usize + 1..hi as usize + 1] {
                member[*at as usize] = i as u32;
                *at += 1;
            }
        }
        member_at.pop();
    }

    /// Returns the greatest unit of all offsets of a packing without slack. These offsets are sums of sizes, rounded up
    /// to alignments.
    pub fn unit(&self) -> u64 {
        let sizes = self.size.iter().fold(0, |unit, &size| gcd(unit, size));
        let binding = self.align.iter().filter(|&&align| sizes & (align - 1) != 0);
        binding.fold(sizes, |unit, &align| gcd(unit, align)).max(1)
    }
}

/// Returns the number of pairs of items that share a section.
fn pairs_alive_together(lo: &[u32], hi: &[u32], born: &[u32]) -> u64 {
    let met = |i: usize| u64::from(born[hi[i] as usize]) - i as u64;
    (0..lo.len()).map(met).sum()
}

fn check(items: &[Interval]) -> Result<(), PackError> {
    if items.len() >= u32::MAX as usize {
        return Err(PackError::TooMany { items: items.len() });
    }
    for (index, item) in items.iter().enumerate() {
        if item.lower >= item.upper {
            return Err(PackError::EmptyLifetime { item: index, lower: item.lower, upper: item.upper });
        }
        if !item.align.is_power_of_two() {
            return Err(PackError::Alignment { item: index, align: item.align });
        }
    }
    Ok(())
}

fn gcd(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// Returns the next multiple of `align`, a power of two. Cannot overflow, because [`Problem::prepare`] bounds both.
pub(super) fn align_up(offset: u64, align: u64) -> u64 {
    (offset + (align - 1)) & !(align - 1)
}
