//! Rules for what looks around in the picture, and for what is seen through something.

use super::decided::Facts;
use super::effect::Effect;
use super::fact::{Fact, Proof};
use super::rule_input::RuleInput;

/// Returns the bound for effects that keep post-processing out of the color pass.
pub(super) fn apart(case: &RuleInput<'_>) -> Proof {
    if case.settings.samples > 1 { Proof::Edges } else { Proof::Variant }
}

pub(super) fn rules(case: &RuleInput<'_>, facts: &mut Facts) {
    if let Some(occlusion) = &case.settings.occlusion {
        facts.rows.push(around(case, occlusion));
    }
    if let Some(reflections) = &case.settings.reflections {
        facts.rows.push(reflected(case, reflections));
    }
    see_through(case, facts);
}

fn around(case: &RuleInput<'_>, occlusion: &crate::OcclusionSettings) -> Fact {
    let drop = |proof, why: String| Fact::decide(Effect::Occlusion, proof, true, why, "");
    let crate::OcclusionSettings { radius_m, intensity, power, .. } = *occlusion;
    if !occlusion.occludes() {
        return drop(
            Proof::Exact,
            format!("it occludes nothing: radius {radius_m} m, intensity {intensity}, power {power}"),
        );
    }
    if case.is_dark() {
        return drop(Proof::Variant, "no light comes from all around, which is all that it dims".into());
    }
    if case.seen.most(|lists| lists.opaque.len() + lists.mask.len()) == 0 || case.surfaces.lit == 0 {
        return drop(Proof::Variant, "nothing is seen that it could darken".into());
    }
    match case.seen.loners(radius_m.into()) {
        Some(count) => drop(
            Proof::Truer,
            format!("{count} convex instances are seen, and nothing is within {radius_m} m of any: all are open"),
        ),
        None => Fact::kept(
            Effect::Occlusion,
            Proof::Truer,
            format!("of what is seen, some is not convex or has something within {radius_m} m"),
        ),
    }
}

fn reflected(case: &RuleInput<'_>, reflections: &crate::ReflectionSettings) -> Fact {
    let (reach_m, most) = (reflections.reach_m, reflections.most_roughness);
    let drop = |proof, why: String| Fact::decide(Effect::Reflections, proof, true, why, "");
    let least = case.surfaces.least_roughness;
    if case.seen.most(|lists| lists.opaque.len() + lists.mask.len()) == 0 || case.surfaces.lit == 0 {
        return drop(apart(case), "nothing is seen that reflects".into());
    }
    if least >= most {
        return drop(
            Proof::Variant,
            format!("roughness in view is {least:.2} at least, and rays end from {most:.2} on"),
        );
    }
    match case.seen.loners(reach_m.into()) {
        Some(count) => drop(
            Proof::Truer,
            format!("{count} convex instances are seen, and nothing is within the {reach_m} m of rays from any"),
        ),
        None => Fact::kept(
            Effect::Reflections,
            Proof::Truer,
            format!("roughness in view is from {least:.2} on, and something may be within the {reach_m} m of rays"),
        ),
    }
}

fn see_through(case: &RuleInput<'_>, facts: &mut Facts) {
    let settings = case.settings;
    // A blended surface may be refractive too; it is drawn in the blended pass over the same background.
    let glass = case.seen.most(|lists| lists.transmit.len() + case.seen.transmissive(&lists.blend));
    let blended = case.seen.most(|lists| lists.blend.len());
    if settings.scene_levels > 0 {
        let kept = format!("{glass} transmissive instances are in view");
        facts.rows.push(Fact::decide(
            Effect::Transmission,
            apart(case),
            glass == 0,
            "no transmissive instance is in view",
            kept,
        ));
    }
    if settings.glass_layers > 1 {
        let deep = case.seen.most(|lists| lists.transmit_layers.iter().map(|l| usize::from(*l) + 1).max().unwrap_or(1));
        let asked = usize::from(settings.glass_layers);
        let (dropped, kept) = (
            format!("glass lies in {deep} layers over itself, of {asked}"),
            format!("glass lies in {deep} layers over itself"),
        );
        facts.rows.push(Fact::decide(Effect::GlassLayers, Proof::Exact, deep < asked, dropped, kept));
        facts.amounts.glass_layers = deep.min(asked) as u8;
    }
    if settings.blended {
        let kept = format!("{blended} instances in view blend");
        facts.rows.push(Fact::decide(Effect::Blending, apart(case), blended == 0, "no instance in view blends", kept));
    }
}
