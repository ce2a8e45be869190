//! Combinations of effects: each frame as it is asked for against the frame as it is decided.

use super::TestResult;
use crate::stage::{LIGHT, gpu};
use framegraph_passes::facts::{EffectSet, FactMemory};
use framegraph_passes::ibl::cache::Cache;
use tests::measure::facts::{Drawn, Easel, MASKED, cases, compare_mask, some_masks};

/// Any two effects are there together, each without the other, and both not.
#[test]
fn some_masks_have_every_pair_in_every_state() {
    let masks = some_masks();
    for a in 0..MASKED.len() {
        for b in 0..a {
            let mut states = [false; 4];
            masks.iter().for_each(|mask| states[(mask >> a & 1 | (mask >> b & 1) << 1) as usize] = true);
            assert_eq!(states, [true; 4], "{:?} and {:?}", MASKED[a], MASKED[b]);
        }
    }
    assert!(masks.len() < 48, "{}", masks.len());
}

/// `cargo run --release -p tests --bin facts -- --every-mask` goes through all 4096.
#[test]
fn what_is_dropped_changes_no_more_than_its_class_says() -> TestResult {
    let Some(gpu) = gpu("what_is_dropped_changes_no_more_than_its_class_says") else { return Ok(()) };
    let mut easel = Easel::new(&gpu);
    for case in cases() {
        let mut drawn = Drawn::new(&gpu, case, &Cache::at(LIGHT))?;
        let mut dropped = EffectSet::NONE;
        for mask in some_masks() {
            let found = compare_mask(&mut easel, &mut drawn, mask)?;
            let name = drawn.case.name;
            println!("{name} {mask:012b}: {} of {} codes", found.largest_codes, found.bound_codes);
            assert!(found.holds(), "{name} {mask:012b}: {found:?}");
            dropped = found.dropped.iter().fold(dropped, EffectSet::with);
        }
        println!("{}", drawn.facts(&drawn.case.asked, EffectSet::NONE, &mut FactMemory::default()).text(&[]));
        assert!(dropped != EffectSet::NONE || drawn.case.name == "full", "{}", drawn.case.name);
    }
    Ok(())
}
