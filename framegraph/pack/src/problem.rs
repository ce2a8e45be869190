//! One instance, prepared once for every solver: items renumbered by birth, time compressed to sections.
//!
//! A *section* is a maximal stretch of time whose live set is contained in no other: two items are alive together
//! exactly when they share a section, and only sections can be full. (In graph words: the maximal cliques of an
//! interval graph, in time order.)

use crate::error::PackError;

/// One resource's demand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Interval {
    /// First time at which the resource is alive. Any unit; a compiler uses steps.
    pub lower: u32,
    /// First time at which it is dead again; more than `lower`.
    pub upper: u32,
    /// Bytes. An item of no bytes is placed at 0 and overlaps nothing.
    pub size: u64,
    /// The offset will be a multiple of this: a power of two.
    pub align: u64,
}

/// A prepared instance. Item indices in this module's siblings are *local*: positions in these arrays.
#[derive(Debug, Default)]
pub(super) struct Problem {
    /// Caller's index of each local item; items of size 0 are left out.
    pub item: Vec<u32>,
    /// Bytes, > 0.
    pub size: Vec<u64>,
    /// Bytes, a power of two.
    pub align: Vec<u64>,
    /// Lifetime length in the caller's time units, > 0.
    pub width: Vec<u32>,
    /// First section of each item. Ascending: items are numbered in the order of their birth.
    pub lo: Vec<u32>,
    /// One past the last section of each item.
    pub hi: Vec<u32>,
    /// Live bytes of each section.
    pub total: Vec<u64>,
    /// A time at which all items of the section are alive.
    pub time: Vec<u32>,
    /// First item born in section `s` or later; one more entry than there are sections.
    pub born: Vec<u32>,
    /// Start of each section's members in `member`; one more entry than there are sections. Empty if `dense`.
    member_at: Vec<u32>,
    member: Vec<u32>,
    /// There are too many pairs of items alive together to look at each: only the sweep can pack such an instance.
    pub dense: bool,
    sorted: Vec<u64>,
    clock: Vec<u32>,
    events: Vec<u8>,
}

/// Above this many (item, section) pairs, 128 MiB of them, and above `DENSE_PER_ITEM` of them an item, or above twice as
/// many pairs of items alive together, an instance is dense.
const DENSE_PAIRS: u64 = 1 << 25;
const DENSE_PER_ITEM: u64 = 128;
const BIRTH: u8 = 1;
const DEATH: u8 = 2;

impl Problem {
    /// Number of items of non-zero size.
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

    /// The items alive in section `s`, ascending. Not for dense instances.
    pub fn members(&self, s: usize) -> &[u32] {
        &self.member[self.member_at[s] as usize..self.member_at[s + 1] as usize]
    }

    /// Every item that is alive together with `i`, and `i` itself: those alive at its birth, then those born later.
    pub fn neighbors(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let (lo, hi) = (self.lo[i] as usize, self.hi[i] as usize);
        let later = self.born[lo + 1] as usize..self.born[hi] as usize;
        self.members(lo).iter().map(|&j| j as usize).chain(later)
    }

    /// Lifetime times size, saturating.
    pub fn area(&self, i: usize) -> u64 {
        self.size[i].saturating_mul(u64::from(self.width[i]))
    }

    /// Fills `self` from the caller's items, reusing its memory. Time: sorts, so `n log n`.
    ///
    /// # Errors
    /// See [`PackError`]; the first bad item in the caller's order is named.
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

    /// Turns lifetimes into section ranges. A section ends at a death that follows a birth.
    fn compress_time(&mut self, items: &[Interval]) {
        let Self { item, lo, hi, time, sorted, clock, events, .. } = self;
        let live = || item.iter().map(|&index| &items[index as usize]);
        let first = live().next().map_or(0, |item| item.lower);
        let last = live().map(|item| item.upper).max().unwrap_or(0);
        // Times are slots directly where they are few, else by rank among all endpoints.
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

    /// Refuses instances whose offsets could pass 2^63, item group by item group (groups share no time).
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

    /// Every offset of a packing without slack is a multiple of this: such offsets are sums of sizes, rounded up to
    /// alignments.
    pub fn unit(&self) -> u64 {
        let sizes = self.size.iter().fold(0, |unit, &size| gcd(unit, size));
        let binding = self.align.iter().filter(|&&align| sizes & (align - 1) != 0);
        binding.fold(sizes, |unit, &align| gcd(unit, align)).max(1)
    }
}

/// How many pairs of items share a section: each item meets those born in its later sections, and its birth mates.
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

/// The next multiple of `align`, a power of two. Never overflows: [`Problem::prepare`] bounds both.
pub(super) fn align_up(offset: u64, align: u64) -> u64 {
    (offset + (align - 1)) & !(align - 1)
}
