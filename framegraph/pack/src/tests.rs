//! Compares packings with an independent verifier, with brute force, and with published instances.

mod oracle;
mod planted;
mod published;

mod stable;

use super::random::Random;
use super::*;
use oracle::{EFFORTS, brute_force, exact, graph, item, packed, tiny};

#[test]
fn tiny_instances_match_brute_force() {
    let (mut random, mut scratch) = (Random(1), Scratch::default());
    let (mut above_peak, mut missed) = (0, 0);
    for _ in 0..1500 {
        let items = tiny(&mut random);
        let mut best = u64::MAX;
        brute_force(&items, &mut vec![None; items.len()], 0, &mut best);
        for effort in EFFORTS {
            let (packing, _) = packed(&items, None, Options { effort, budget_steps: 1 << 16 }, &mut scratch);
            assert!(packing.lower_bound <= best && best <= packing.top, "{packing:?} but {best} of {items:?}");
            assert!(effort < Effort::Exact || packing.optimal && packing.top == best, "{packing:?} of {items:?}");
            missed += u32::from(packing.top > best);
        }
        above_peak += u32::from(best > items.iter().map(|a| a.size).max().unwrap_or(0));
    }
    // Negative control: greedy must miss some optima, and the largest item must not always determine the optimum.
    assert!(missed > 5 && above_peak > 500, "{missed} {above_peak}");
}

#[test]
fn random_graphs_reach_the_bound() {
    let (mut random, mut scratch) = (Random(2), Scratch::default());
    let count = 300;
    let mut optimal = [0; 2];
    for _ in 0..count {
        let items = graph(&mut random);
        let tops = EFFORTS.map(|effort| packed(&items, None, Options { effort, ..exact(1 << 16) }, &mut scratch).0);
        assert!(tops[0].top >= tops[1].top, "{tops:?}");
        for (count, packing) in optimal.iter_mut().zip(tops) {
            *count += u32::from(packing.optimal);
        }
    }
    // Required are 97 %; the exact search reaches 100 %, the greedy portfolio 98 %.
    assert!(optimal[1] >= count * 99 / 100 && optimal[0] >= count * 90 / 100, "{optimal:?}");
}

#[test]
fn the_same_scratch_gives_the_same_packing() {
    let (mut random, mut scratch) = (Random(3), Scratch::default());
    for _ in 0..60 {
        let items = if random.below(2) == 0 { graph(&mut random) } else { tiny(&mut random) };
        let options = Options { effort: EFFORTS[random.below(2) as usize], budget_steps: 1 << random.below(14) };
        assert_eq!(
            packed(&items, None, options, &mut scratch),
            packed(&items, None, options, &mut Scratch::default()),
            "stale state in the scratch"
        );
    }
}

#[test]
fn edge_cases() {
    let mut scratch = Scratch::default();
    let (packing, offsets) = packed(&[], None, exact(9), &mut scratch);
    assert!(packing.optimal && packing.top == 0 && offsets.is_empty());
    let (packing, _) = packed(&[item(0, u32::MAX, 0, 1 << 63)], None, exact(9), &mut scratch);
    assert!(packing.optimal && packing.top == 0);
    let (packing, _) = packed(&[item(u32::MAX - 1, u32::MAX, 7, 8)], None, exact(9), &mut scratch);
    assert!(packing.optimal && (packing.top, packing.peak_at) == (7, u32::MAX - 1));
    // Far apart in time: memory must not be proportional to the time range.
    let (packing, _) = packed(&[item(0, 1, 5, 4), item(u32::MAX - 1, u32::MAX, 7, 8)], None, exact(9), &mut scratch);
    assert!(packing.optimal && packing.top == 7);
    let huge = i64::MAX as u64;
    let (packing, _) = packed(&[item(0, 1, huge, 1), item(1, 2, huge, 1)], None, exact(9), &mut scratch);
    assert!(packing.optimal && packing.top == huge);
    let (packing, offsets) = packed(&[item(0, 2, 5, 1); 40], None, exact(1 << 12), &mut scratch);
    assert!(packing.optimal && packing.top == 200 && offsets.contains(&195));
}

#[test]
fn bad_instances_are_refused_with_the_item() {
    let mut scratch = Scratch::default();
    let mut refuse = |items: &[Interval], previous: Option<&[Option<u64>]>| {
        let mut offsets = vec![7];
        let error = pack(items, previous, &exact(9), &mut scratch, &mut offsets).expect_err("an invalid instance");
        assert_eq!(offsets, [7], "offsets must be untouched");
        error
    };
    let good = item(0, 2, 4, 4);
    assert_eq!(refuse(&[good, item(3, 3, 1, 1)], None), PackError::EmptyLifetime { item: 1, lower: 3, upper: 3 });
    assert_eq!(refuse(&[item(3, 2, 0, 1)], None), PackError::EmptyLifetime { item: 0, lower: 3, upper: 2 });
    assert_eq!(refuse(&[good, item(0, 1, 1, 0)], None), PackError::Alignment { item: 1, align: 0 });
    assert_eq!(refuse(&[good, good, item(0, 1, 1, 12)], None), PackError::Alignment { item: 2, align: 12 });
    assert_eq!(refuse(&[good, item(0, 1, u64::MAX, 1)], None), PackError::TooLarge { item: 1 });
    assert_eq!(refuse(&[item(0, 1, 1, 1 << 63), item(0, 1, 1, 1)], None), PackError::TooLarge { item: 0 });
    let half = item(0, 1, 1 << 62, 1);
    assert_eq!(refuse(&[half, good, half], None), PackError::TooLarge { item: 2 });
    let error = refuse(&[good], Some(&[]));
    assert_eq!(error, PackError::PreviousLength { items: 1, previous: 0 });
    assert!(error.to_string().contains("one for each"));
}

#[test]
fn dense_instances_are_swept() {
    let mut random = Random(6);
    // More than half of all pairs are live at the same time; the limit is 2^26 pairs.
    let times = 40;
    let items: Vec<Interval> = (0..18000)
        .map(|_| {
            let (a, b) = (random.below(times) as u32, random.below(times) as u32);
            item(a.min(b), a.max(b) + 1, 1 + random.below(500), 1 << random.below(4))
        })
        .collect();
    let mut offsets = Vec::new();
    let packing = pack(&items, None, &exact(1 << 12), &mut Scratch::default(), &mut offsets).expect("a valid instance");
    // Checking all pairs would take too long: at a few times, the live items must be disjoint.
    for t in (0..times as u32).step_by(5) {
        let mut live: Vec<_> = (0..items.len()).filter(|&i| items[i].lower <= t && t < items[i].upper).collect();
        live.sort_by_key(|&i| offsets[i]);
        let disjoint = |pair: &[usize]| offsets[pair[0]] + items[pair[0]].size <= offsets[pair[1]];
        assert!(live.windows(2).all(disjoint), "overlap at {t}");
    }
    assert!(items.iter().zip(&offsets).all(|(item, at)| at % item.align == 0));
    assert_eq!(items.iter().zip(&offsets).map(|(item, at)| at + item.size).max(), Some(packing.top));
    // First fit over time reaches 1.07 times the peak.
    assert!(packing.top as f64 <= 1.2 * packing.peak as f64 && packing.steps == 0, "{packing:?}");
}
