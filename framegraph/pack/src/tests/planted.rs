//! Packings with a known optimum, and the searches that run in turn.

use core::ops::ControlFlow;

use super::super::*;
use super::oracle::{exact, fault, packed};
use crate::planted::{Cuts, Planted};

/// Budgets for the exact search alone, and for turns of all searches.
const ALONE: u64 = 1 << 18;
const TURNS: u64 = 3 << 20;

fn small(cuts: Cuts) -> Planted {
    Planted { items: 240, times: 200, units: 400, ..Planted::square(cuts) }
}

#[test]
fn planted_packings_are_nearly_found_again() {
    let (mut scratch, mut alone) = (Scratch::default(), 0);
    for cuts in Cuts::ALL {
        for (seed, unit_bytes) in [(1, 1), (2, 256)] {
            let plan = Planted { unit_bytes, ..small(cuts) };
            let (items, height) = (plan.items(seed), plan.height_bytes());
            let [first, last] = [ALONE, TURNS].map(|budget| packed(&items, None, exact(budget), &mut scratch).0);
            assert!(first.lower_bound == height && last.top <= first.top, "{plan:?}");
            // Required is 5 % for 1,000 items in a minute; the result here is at most 1.9 %.
            assert!(last.top * 100 <= height * 105, "{plan:?}, seed {seed}: {} of {height}", last.top);
            alone += u32::from(first.top * 100 > height * 105);
        }
    }
    assert!(alone >= 4, "the exact search alone suffices for all but {alone}");
}

#[test]
fn planted_packings_with_pieces_left_out_are_proved() {
    for (cuts, seed) in [(Cuts::Even, 3), (Cuts::Long, 4), (Cuts::Brief, 5), (Cuts::Pinwheels, 6)] {
        let plan = Planted { left_out_percent: 15, ..small(cuts) };
        let (packing, _) = packed(&plan.items(seed), None, exact(TURNS), &mut Scratch::default());
        assert!(packing.optimal && packing.top <= plan.height_bytes(), "{plan:?}: {packing:?}");
    }
}

#[test]
fn turns_leave_nothing_behind() {
    let mut scratch = Scratch::default();
    for cuts in Cuts::ALL {
        let items = Planted { items: 150, ..small(cuts) }.items(8);
        let pack = |scratch: &mut Scratch| packed(&items, None, exact(ALONE + (1 << 19)), scratch);
        assert_eq!(pack(&mut scratch), pack(&mut Scratch::default()), "stale state in the scratch: {cuts:?}");
    }
}

#[test]
fn who_watches_sees_the_bracket_narrow_and_ends_it() {
    let items = small(Cuts::Long).items(1);
    let (mut seen, mut offsets) = (Vec::new(), Vec::new());
    let mut watch = |progress: Progress| {
        seen.push(progress);
        if seen.len() < 24 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let packing = pack_watched(&items, None, &exact(u64::MAX), &mut Scratch::default(), &mut offsets, &mut watch);
    let packing = packing.expect("a valid instance");
    assert_eq!(fault(&items, &offsets, &packing), None);
    assert_eq!((seen.len(), seen[23].steps), (24, packing.steps));
    assert!(packing.top <= seen[23].top && seen[23].top < seen[0].top, "{seen:?}");
    let narrows = |a: &Progress, b: &Progress| a.top >= b.top && a.lower_bound <= b.lower_bound && a.steps < b.steps;
    assert!(seen.windows(2).all(|pair| narrows(&pair[0], &pair[1])), "{seen:?}");
    // The same number of steps as budget gives the same packing.
    assert_eq!(packed(&items, None, exact(packing.steps), &mut Scratch::default()), (packing, offsets));
}
