//! An independent verifier of packings, the optimum by brute force, and random instances.

use super::super::random::Random;
use super::super::*;

pub(super) fn item(lower: u32, upper: u32, size: u64, align: u64) -> Interval {
    Interval { lower, upper, size, align }
}

pub(super) fn meet(a: &Interval, b: &Interval) -> bool {
    a.lower < b.upper && b.lower < a.upper
}

/// Returns what is wrong with a packing, if anything. Follows the definition and shares no code with the solvers.
pub(super) fn fault(items: &[Interval], offsets: &[u64], packing: &Packing) -> Option<String> {
    if offsets.len() != items.len() {
        return Some(format!("{} offsets for {} items", offsets.len(), items.len()));
    }
    for (i, (a, &at)) in items.iter().zip(offsets).enumerate() {
        if at % a.align != 0 {
            return Some(format!("item {i} at {at} is not aligned to {}", a.align));
        }
        for (j, (b, &other)) in items.iter().zip(offsets).enumerate().take(i) {
            if meet(a, b) && at < other + b.size && other < at + a.size {
                return Some(format!("items {j} and {i} overlap at {other} and {at}"));
            }
        }
    }
    let top = items.iter().zip(offsets).map(|(item, at)| if item.size == 0 { 0 } else { at + item.size }).max();
    if packing.top != top.unwrap_or(0) {
        return Some(format!("the top is {top:?}, not {}", packing.top));
    }
    let live =
        |t: u32| items.iter().filter(|item| item.lower <= t && t < item.upper).map(|item| item.size).sum::<u64>();
    let peak = items.iter().map(|item| live(item.lower)).max().unwrap_or(0);
    if (packing.peak, live(packing.peak_at)) != (peak, peak) {
        return Some(format!("the peak is {peak}, not {} at {}", packing.peak, packing.peak_at));
    }
    let ordered = packing.peak <= packing.lower_bound && packing.lower_bound <= packing.top;
    let proved = packing.optimal == (packing.lower_bound == packing.top);
    (!ordered || !proved).then(|| format!("the bracket is wrong: {packing:?}"))
}

/// Packs and verifies.
pub(super) fn packed(
    items: &[Interval],
    previous: Option<&[Option<u64>]>,
    options: Options,
    scratch: &mut Scratch,
) -> (Packing, Vec<u64>) {
    let mut offsets = vec![99; 3];
    let packing = pack(items, previous, &options, scratch, &mut offsets).expect("a valid instance");
    if let Some(fault) = fault(items, &offsets, &packing) {
        panic!("{fault}\nof {items:?}\nat {offsets:?}");
    }
    (packing, offsets)
}

pub(super) fn exact(budget_steps: u64) -> Options {
    Options { effort: Effort::Exact, budget_steps }
}

pub(super) const EFFORTS: [Effort; 2] = [Effort::Greedy, Effort::Exact];

/// Finds the minimum top: first fit in every order.
///
/// One order reaches it: in an optimal packing in which no item can be moved down, first fit in the order of the
/// offsets places every item at its offset.
pub(super) fn brute_force(items: &[Interval], offsets: &mut Vec<Option<u64>>, top: u64, best: &mut u64) {
    if top >= *best {
        return;
    }
    let placed = |i: usize, offsets: &[Option<u64>]| offsets[i].map(|at| (at, at + items[i].size));
    if offsets.iter().all(Option::is_some) {
        *best = top;
        return;
    }
    for i in 0..items.len() {
        if offsets[i].is_some() {
            continue;
        }
        let others: Vec<_> =
            (0..items.len()).filter(|&j| meet(&items[i], &items[j])).filter_map(|j| placed(j, offsets)).collect();
        let candidates = others.iter().map(|other| other.1.next_multiple_of(items[i].align)).chain([0]);
        let free = |&at: &u64| others.iter().all(|other| at + items[i].size <= other.0 || other.1 <= at);
        let at = candidates.filter(free).min().expect("the place above all items is free");
        offsets[i] = Some(at);
        brute_force(items, offsets, top.max(at + items[i].size), best);
        offsets[i] = None;
    }
}

/// Returns up to seven small items, sometimes aligned, empty or equal.
pub(super) fn tiny(random: &mut Random) -> Vec<Interval> {
    let (times, sizes) = (2 + random.below(8), 1 + random.below(9));
    let aligned = random.below(3) == 0;
    let mut items: Vec<Interval> = Vec::new();
    for _ in 0..random.below(8) {
        let lower = random.below(times);
        let upper = lower + 1 + random.below(times - lower);
        let align = if aligned { 1 << random.below(3) } else { 1 };
        let fresh = item(lower as u32, upper as u32, random.below(sizes + 1), align);
        let again = random.below(4) == 0;
        items.push(items.last().copied().filter(|_| again).unwrap_or(fresh));
    }
    items
}

/// Returns a graph of 10 to 60 resources; sizes are log-uniform multiples of 64 KiB.
pub(super) fn graph(random: &mut Random) -> Vec<Interval> {
    let count = 10 + random.below(51);
    let passes = count / 2 + 2;
    let resource = |_| {
        let lower = random.below(passes);
        let upper = lower + 1 + random.below(passes - lower).min(random.below(12));
        let size = (65536 << random.below(8)) + 65536 * random.below(16);
        item(lower as u32, upper as u32, size, 65536)
    };
    (0..count).map(resource).collect()
}
