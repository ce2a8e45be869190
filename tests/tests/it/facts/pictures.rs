//! Fog, depth of field and bloom on both sides of their thresholds: culling stays within its bounds, and kept effects
//! are visible.

use super::TestResult;
use crate::stage::gpu;
use framegraph_passes::feature_culling::{Decision, Effect, EffectSet, FactMemory, Proof};
use framegraph_passes::{BloomSettings, DofSettings, FogSettings, Settings};
use tests::measure::facts::{Drawn, Easel, SIZE_PX, cases};

/// A frame with one effect and a black background, so that visible distances are bounded.
const BARE: Settings = Settings { shadows: None, fxaa: false, sky: false, ..Settings::DEFAULT };

/// Expected decision and difference without the effect.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Expected {
    /// Culled, and no bit changes.
    SameBits,
    /// Culled, and no 8-bit value changes by more than one.
    SameCodes,
    /// Kept, close to the threshold; the picture may be equal.
    Kept,
    /// Kept, and visible.
    Seen,
}

#[test]
fn air_and_lens_change_the_picture_where_they_are_kept() -> TestResult {
    let Some(gpu) = gpu("air_and_lens_change_the_picture_where_they_are_kept") else { return Ok(()) };
    let fog = |fog| (Effect::Fog, "floor", Settings { fog: Some(fog), ..BARE });
    let dof = |dof| (Effect::DepthOfField, "ball", Settings { dof: Some(dof), ..BARE });
    let bloom = |bloom| (Effect::Bloom, "cards", Settings { bloom: Some(bloom), ..BARE });
    let of_air = |density| FogSettings { density, falloff: 0.0, ..FogSettings::DEFAULT };
    let of_lens = |f_number| DofSettings { focus_m: 2.0, f_number, focal_length_m: Some(0.1), ..DofSettings::DEFAULT };
    let of_light = |threshold_at| BloomSettings { threshold_at, ..BloomSettings::DEFAULT };
    let rows = [
        (fog(of_air(0.0)), Expected::SameBits),
        (fog(FogSettings { most_opacity: 0.0, ..of_air(1.0) }), Expected::SameBits),
        (fog(of_air(0.0002)), Expected::SameCodes),
        (fog(of_air(0.0004)), Expected::Kept),
        (fog(of_air(0.5)), Expected::Seen),
        (dof(DofSettings { scale: 0.0, ..of_lens(1.0) }), Expected::SameBits),
        (dof(DofSettings { most_before_px: 0.0, most_behind_px: 0.0, ..of_lens(1.0) }), Expected::SameBits),
        (dof(of_lens(64.0)), Expected::SameCodes),
        (dof(of_lens(1.0)), Expected::Seen),
        (bloom(BloomSettings { strength: 0.0, ..of_light(0.1) }), Expected::SameBits),
        (bloom(BloomSettings { levels: 0, ..of_light(0.1) }), Expected::SameBits),
        (bloom(of_light(1.1)), Expected::SameCodes),
        (bloom(of_light(0.9)), Expected::Kept),
        (bloom(of_light(0.1)), Expected::Seen),
    ];
    let mut easel = Easel::new(&gpu);
    for name in ["floor", "ball", "cards"] {
        let case = cases().into_iter().find(|case| case.name == name).ok_or("a case")?;
        let mut drawn = Drawn::new(&gpu, case)?;
        for ((effect, _, asked), expected) in rows.iter().filter(|((_, of, _), _)| *of == name) {
            let asked = asked.for_scene(&drawn.case.scene, SIZE_PX);
            let facts = drawn.facts(&asked, EffectSet::NONE, &mut FactMemory::default());
            let fact = facts.of(*effect).ok_or("the effect is asked for")?;
            let dropped = fact.decision == Decision::Dropped;
            assert_eq!(dropped, matches!(expected, Expected::SameBits | Expected::SameCodes), "{fact:?}");
            assert!(!dropped || !matches!(fact.proof, Proof::Texels(_) | Proof::Truer), "{fact:?}");
            let [with, without] = [asked, asked.without(*effect)].map(|settings| drawn.picture(&mut easel, &settings));
            let (with, without) = (with?, without?);
            let apart = with.iter().zip(&without).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
            let holds = match expected {
                Expected::SameBits => apart == 0,
                Expected::SameCodes => apart <= 1,
                Expected::Kept => true,
                Expected::Seen => apart > 2,
            };
            assert!(holds, "{expected:?}: {apart} codes apart; {fact:?}");
        }
    }
    Ok(())
}
