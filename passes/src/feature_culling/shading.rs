//! Rules for how surfaces are shaded: constants of pipelines, whose off state costs nothing.

use super::decided::Facts;
use super::effect::Effect;
use super::fact::{Decision, Fact, Proof};
use super::rule_input::RuleInput;
use framegraph_scene::environment::ShBands;
use glam::Vec4;

/// Reflectance at normal incidence up to which single scattering loses too little to be seen: that of an index of 1.5, with
/// room for its rounding.
const DIELECTRIC_F0: f32 = 0.0401;
/// Maximum contribution of energy compensation in 8-bit steps, next to black (`docs/design/feature-culling.md`).
const COMPENSATION_CODES: f32 = 1.6;
/// Maximum number of 8-bit steps for a relative change of light by 1, on a curve no steeper than the encoding.
const CODES_OF_LIGHT: f64 = 255.0 / 2.2;
/// Most of the largest polynomials of the second and fourth band of irradiance over all directions.
const BAND_2: [f32; 5] = [0.5, 0.5, 2.0, 0.5, 1.0];
const BAND_4: [f32; 9] = [0.25, 0.65, 0.9, 0.95, 8.0, 0.95, 1.3, 0.65, 1.0];

pub(super) fn rules(case: &RuleInput<'_>, facts: &mut Facts) {
    let shading = &case.settings.shading;
    if shading.compensate_image || shading.compensate_punctual {
        facts.rows.push(compensation(case));
    }
    if let Some(aa) = shading.specular_aa {
        facts.rows.push(specular_aa(case, aa.variance));
    }
    if shading.bands != ShBands::Two && case.input.around.bands != ShBands::Two {
        let (row, bands) = bands(case, shading.bands);
        facts.amounts.bands = bands;
        facts.rows.push(row);
    }
    let maps = case.surfaces.occlusion_maps;
    if shading.multi_bounce || shading.specular_occlusion {
        let asked = case.settings.occlusion.is_some();
        let made = asked && facts.of(Effect::Occlusion).is_none_or(|row| row.decision == Decision::Kept);
        facts.rows.push(Fact::decide(
            Effect::OcclusionShading,
            Proof::Variant,
            maps == 0 && !made,
            "nothing is occluded: there is no ambient occlusion, and nothing in view has a texture of it",
            if made {
                "there is ambient occlusion".into()
            } else {
                format!("{maps} instances in view have a texture of it")
            },
        ));
    }
    if shading.micro_shadows {
        let dark = case.sun.is_none();
        let why =
            if dark { "the sun lights nothing that is seen" } else { "nothing in view has a texture of occlusion" };
        let kept = format!("{maps} instances in view have a texture of occlusion");
        facts.rows.push(Fact::decide(Effect::MicroShadows, Proof::Variant, dark || maps == 0, why, kept));
    }
}

fn compensation(case: &RuleInput<'_>) -> Fact {
    let f0 = case.surfaces.most_f0;
    let codes = COMPENSATION_CODES * f0 / 0.04;
    let numbers = format!("reflectance in view is {f0:.3} at most");
    let proof = if f0 == 0.0 { Proof::Variant } else { Proof::Codes(codes) };
    Fact::decide(Effect::EnergyCompensation, proof, f0 <= DIELECTRIC_F0, numbers.clone(), numbers)
}

fn specular_aa(case: &RuleInput<'_>, variance: f32) -> Fact {
    let effect = Effect::SpecularAa;
    let turn2 = case.seen.turn2(variance);
    if turn2 == 0.0 {
        let why = "every triangle in view has one normal";
        return Fact::decide(effect, Proof::Variant, true, why, "");
    }
    let floor = case.settings.shading.roughness_floor.max(case.settings.shading.precision.roughness_floor());
    let roughness = f64::from(case.surfaces.least_roughness.max(floor));
    // Highlights change as alpha² does.
    let change = 2.0 * turn2 / roughness.powi(4);
    let codes = CODES_OF_LIGHT * change;
    let numbers =
        format!("roughness in view is {roughness:.2} at least, and a pixel widens alpha² by a share of {change:.2e}");
    let few = case.memory.within(effect, codes, case.input.max_steps.into()) && roughness >= 0.5;
    Fact::decide(effect, Proof::Codes(codes as f32), few, numbers.clone(), numbers)
}

/// The row, and the bands that are enough.
fn bands(case: &RuleInput<'_>, asked: ShBands) -> (Fact, ShBands) {
    let sh = case.input.around.irradiance;
    let most = |coefficients: &[Vec4], peaks: &[f32]| -> Vec4 {
        coefficients.iter().zip(peaks).map(|(c, peak)| c.abs() * *peak).sum()
    };
    let (second, fourth) = (most(&sh[4..9], &BAND_2), most(&sh[9..18], &BAND_4));
    // Each channel is compared with its mean, since the minimum over directions is unknown.
    let share = |over: Vec4| -> f64 {
        let (over, mean) = (over.truncate(), sh[0].truncate());
        let of = |(over, mean): (f32, f32)| if over == 0.0 { 0.0 } else { f64::from(over) / f64::from(mean.max(0.0)) };
        over.to_array().into_iter().zip(mean.to_array()).map(of).fold(0.0, f64::max)
    };
    let fewer = |over: f64| case.memory.within(Effect::ShBands, CODES_OF_LIGHT * over, 0.5);
    let (all, last) = (share(second + fourth), share(fourth));
    let (enough, over) = match asked {
        _ if fewer(all) => (ShBands::Two, all),
        ShBands::Five if fewer(last) => (ShBands::Three, last),
        _ => (asked, all),
    };
    let codes = (CODES_OF_LIGHT * over) as f32;
    let numbers = format!("bands beyond {} change irradiance by a share of {over:.2e} at most", enough.count().min(2));
    let proof = if over == 0.0 { Proof::Variant } else { Proof::Codes(codes) };
    let dropped = format!("bands beyond {} change irradiance by a share of {over:.2e} at most", enough.count());
    (Fact::decide(Effect::ShBands, proof, enough != asked, dropped, numbers), enough)
}
