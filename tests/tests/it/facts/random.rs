//! Random scenes with and without feature culling: differences stay within the bounds of the culled effects.

use super::TestResult;
use crate::stage::gpu;
use framegraph_passes::feature_culling::{Decision, Effect, EffectSet, FactMemory, Proof};
use tests::measure::facts::random::random_case;
use tests::measure::facts::{Drawn, Easel, compare};

/// Number of scenes in a short run, and with `FRAMEGRAPH_TESTS=all`.
const SCENES: [u64; 2] = [150, 2000];
/// Number of settings in a short run, which mostly compiles shaders.
const SETTINGS: u64 = 12;
/// Number of scenes per device in a long run: each scene has shaders of its own, and drivers keep what they compiled.
const PER_DEVICE: u64 = 50;
/// Number of scenes that are drawn without a needed effect.
const BROKEN: u64 = 24;

fn apart(a: &[u8], b: &[u8]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

#[test]
fn random_scenes_keep_within_the_bounds_of_what_is_dropped() -> TestResult {
    let open = || gpu("random_scenes_keep_within_the_bounds_of_what_is_dropped");
    let Some(mut gpu) = open() else { return Ok(()) };
    let all = std::env::var_os("FRAMEGRAPH_TESTS").is_some_and(|cases| cases == "all");
    let mut easel = Easel::new(&gpu);
    let (mut failures, mut changed, mut dropped) = (Vec::new(), 0, EffectSet::NONE);
    for number in 0..SCENES[usize::from(all)] {
        let of_settings = if all { number } else { number % SETTINGS };
        if all && number % PER_DEVICE == 0 {
            let Some(fresh) = open() else { return Ok(()) };
            gpu = fresh;
            easel = Easel::new(&gpu);
        }
        let mut drawn = Drawn::new(&gpu, random_case(number, of_settings))?;
        let asked = drawn.case.asked;
        let found = compare(&mut easel, &mut drawn, &asked)?;
        dropped = found.dropped.iter().fold(dropped, EffectSet::with);
        changed += u32::from(found.largest_codes > 0);
        if found.holds() {
            continue;
        }
        // Test each effect alone, to name the faulty rule.
        let facts = drawn.facts(&asked, EffectSet::NONE, &mut FactMemory::default());
        let with = drawn.picture(&mut easel, &asked)?;
        let mut alone = Vec::new();
        for effect in found.dropped.iter() {
            let codes = apart(&with, &drawn.picture(&mut easel, &asked.without(effect))?);
            let row = facts.of(effect).map(|row| (row.proof, row.reason.clone()));
            alone.push(format!("{} {codes} {row:?}", effect.name()));
        }
        let failure = format!("scene {number}: {found:?}\n    {}", alone.join("\n    "));
        println!("{failure}");
        failures.push(failure);
    }
    println!("{changed} pictures differ; dropped: {:?}", dropped.iter().map(Effect::name).collect::<Vec<_>>());
    assert!(failures.is_empty(), "{} scenes:\n{}", failures.len(), failures.join("\n"));
    // Most rules must have applied.
    assert!(dropped.iter().count() >= 8, "{dropped:?}");
    Ok(())
}

/// Negative control: a rule that wrongly culls the sun's shadows, with a bound of one 8-bit step, is detected.
#[test]
fn a_broken_rule_is_found_by_random_scenes() -> TestResult {
    let Some(gpu) = gpu("a_broken_rule_is_found_by_random_scenes") else { return Ok(()) };
    let mut easel = Easel::new(&gpu);
    let (mut tried, mut found) = (0, 0);
    for number in 0..BROKEN {
        let mut drawn = Drawn::new(&gpu, random_case(number, number % 4))?;
        let asked = drawn.case.asked;
        let facts = drawn.facts(&asked, EffectSet::NONE, &mut FactMemory::default());
        let row = facts.of(Effect::SunShadows);
        if row.is_none_or(|row| row.decision == Decision::Dropped || row.proof != Proof::Variant) {
            continue;
        }
        tried += 1;
        let with = drawn.picture(&mut easel, &asked)?;
        found += u32::from(apart(&with, &drawn.picture(&mut easel, &asked.without(Effect::SunShadows))?) > 1);
    }
    println!("{found} of {tried}");
    assert!(found > 0, "of {tried} scenes none shows that shadows are missing");
    Ok(())
}
