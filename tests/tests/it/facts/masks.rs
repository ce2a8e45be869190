//! Combinations of effects: each frame with and without feature culling.

use super::TestResult;
use crate::stage::gpu;
use framegraph_passes::feature_culling::{Effect, EffectSet, FactMemory};
use framegraph_scene::{Light, LightKind};
use glam::{DMat4, DVec3};
use tests::measure::facts::{Case, Drawn, Easel, MASKED, cases, compare_mask, some_masks};

/// Each pair of effects occurs together, separately and not at all.
#[test]
fn some_masks_have_every_pair_in_every_state() {
    let masks = some_masks(false);
    for a in 0..MASKED.len() {
        for b in 0..a {
            let mut states = [false; 4];
            masks.iter().for_each(|mask| states[(mask >> a & 1 | (mask >> b & 1) << 1) as usize] = true);
            assert_eq!(states, [true; 4], "{:?} and {:?}", MASKED[a], MASKED[b]);
        }
    }
}

/// `cargo run --release -p tests --bin measure -- facts --every-mask` tests all 4096 combinations.
#[test]
fn what_is_dropped_changes_no_more_than_its_class_says() -> TestResult {
    let Some(gpu) = gpu("what_is_dropped_changes_no_more_than_its_class_says") else { return Ok(()) };
    let mut easel = Easel::new(&gpu);
    for case in cases() {
        // Single effects are tested in the cheapest scenes; the two most expensive scenes are drawn with all effects
        // and with none.
        let masks = match case.name {
            "nothing" => some_masks(true),
            "ball" | "full" => vec![0, some_masks(false).into_iter().max().unwrap_or(0)],
            _ => test_report::share(some_masks(false)),
        };
        let mut drawn = Drawn::new(&gpu, case)?;
        let mut dropped = EffectSet::NONE;
        for mask in masks {
            let found = compare_mask(&mut easel, &mut drawn, mask)?;
            let name = drawn.case.name;
            println!("{name} {mask:012b}: {} of {} codes", found.largest_codes, found.bound_codes);
            assert!(found.holds(), "{name} {mask:012b}: {found:?}");
            dropped = found.dropped.iter().fold(dropped, EffectSet::with);
        }
        assert!(dropped != EffectSet::NONE || drawn.case.name == "full", "{}", drawn.case.name);
    }
    Ok(())
}

/// Effects of unlit, invisible or empty objects: culling them changes no bit, or nothing is culled.
#[test]
fn what_adds_nothing_changes_no_bit() -> TestResult {
    let Some(gpu) = gpu("what_adds_nothing_changes_no_bit") else { return Ok(()) };
    let mut easel = Easel::new(&gpu);
    let [.., night, _] = cases();
    let mut decided = |case: Case| -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let asked = case.asked.without(Effect::Reflections);
        let mut drawn = Drawn::new(&gpu, case)?;
        let facts = drawn.facts(&asked, EffectSet::NONE, &mut FactMemory::default());
        drawn.picture(&mut easel, &facts.apply(&asked))
    };
    let plain = decided(night.clone())?;
    let lit = |case: &mut Case, kind| {
        let lamp = case.scene.lights[0].clone();
        case.scene.lights.push(Light { kind, ..lamp });
    };
    let put = |case: &mut Case, at: DMat4| {
        let first = case.scene.instances[1].clone();
        case.scene.add_instance("more", first.mesh, first.material, at);
    };
    let changes: [(&str, &dyn Fn(&mut Case)); 5] = [
        ("a lamp of no intensity", &|case| lit(case, LightKind::Point { intensity_candela: 0.0, range_m: None })),
        ("a sun of no illuminance", &|case| {
            lit(case, LightKind::Directional { illuminance_lux: 0.0, angular_radius_rad: 0.1 });
        }),
        ("a lamp behind the camera", &|case| {
            let kind = LightKind::Point { intensity_candela: 1e4, range_m: Some(1.0) };
            lit(case, kind);
            if let Some(lamp) = case.scene.lights.last_mut() {
                lamp.position = DVec3::new(0.0, 1.0, 40.0);
            }
        }),
        ("a block behind the camera", &|case| put(case, DMat4::from_translation(DVec3::new(0.0, 0.0, 40.0)))),
        ("a block without area", &|case| {
            put(case, DMat4::from_translation(DVec3::new(0.1, 0.5, 0.6)) * DMat4::from_scale(DVec3::splat(1e-9)));
        }),
    ];
    for (what, change) in changes {
        let mut case = night.clone();
        change(&mut case);
        assert!(decided(case)? == plain, "{what}");
    }
    let mut brighter = night.clone();
    lit(&mut brighter, LightKind::Point { intensity_candela: 1e4, range_m: None });
    assert!(decided(brighter)? != plain, "a lamp that shines is seen");
    Ok(())
}
