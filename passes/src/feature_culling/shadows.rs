//! Rules for shadows.

use super::decided::Facts;
use super::effect::Effect;
use super::fact::{Fact, Proof};
use super::rule_input::RuleInput;

/// Maximum ratio of the farthest to the nearest receiver for which one cascade suffices. Its texels are then at most
/// twice as wide on screen as those of four cascades.
const ONE_MAP: f64 = 1.86;

pub(super) fn rules(case: &RuleInput<'_>, facts: &mut Facts) {
    let Some(shadows) = &case.settings.shadows else { return };
    let mut sun_dropped = false;
    if shadows.cascades > 0 {
        let (proof, why) = why_no_sun(case);
        let kept = format!("{} instances may cast upon what is seen", case.need.sun_casters);
        sun_dropped = why.is_some();
        facts.rows.push(Fact::decide(Effect::SunShadows, proof, sun_dropped, why.unwrap_or_default(), kept));
    }
    if shadows.cascades > 1 {
        facts.rows.push(cascades(case, sun_dropped));
    }
    if shadows.contact.is_some() {
        let row = |proof, unneeded, why: &str| {
            Fact::decide(Effect::ContactShadows, proof, unneeded, why, "the sun may shine on what is near of casters")
        };
        facts.rows.push(match case.sun {
            None => row(Proof::Exact, true, "the sun lights nothing that is seen"),
            // Without casters, a ray through the picture can only hit the surface that it started from.
            Some(_) => row(Proof::Truer, sun_dropped, "nothing casts upon what is seen"),
        });
    }
    if shadows.local_maps > 0 {
        facts.rows.push(lamps(case, [shadows.local_maps(), shadows.local_layers()]));
        let needed = if case.need.lamp_casters == 0 { [0; 2] } else { [case.need.lamp_maps, case.need.lamp_layers] };
        [facts.amounts.lamp_maps, facts.amounts.lamp_layers] = needed.map(|count| count as u8);
    }
}

/// Returns the reason why the sun's maps are not needed, if any.
fn why_no_sun(case: &RuleInput<'_>) -> (Proof, Option<String>) {
    let Some(risen) = case.risen else { return (Proof::Exact, Some("no sun is on".into())) };
    if case.sun.is_none() {
        let below = -risen.direction.as_dvec3().y.asin().to_degrees();
        let where_ =
            if below < 0.0 { format!("the sun is {:.1}° below the horizon, and ", -below) } else { String::new() };
        let lit = case.surfaces.lit;
        return (Proof::Exact, Some(format!("{where_}none of {lit} instances in view turns toward it")));
    }
    let none = case.need.sun_casters == 0;
    (Proof::Variant, none.then(|| "no instance is between what is seen and the sun".into()))
}

fn cascades(case: &RuleInput<'_>, sun_dropped: bool) -> Fact {
    let effect = Effect::Cascades;
    let Some((near, far)) = case.need.receivers_m.filter(|_| !sun_dropped) else {
        return Fact::decide(effect, Proof::Exact, true, "the sun has no map", "");
    };
    let (near, ratio) = (near.max(1e-6), far / near.max(1e-6));
    let few = case.memory.within(effect, ratio, ONE_MAP);
    let numbers = format!("shadows fall from {near:.2} m to {far:.2} m, a ratio of {ratio:.2}");
    let (dropped, kept) = (format!("{numbers}, within {ONE_MAP}"), format!("{numbers}, beyond {ONE_MAP}"));
    Fact::decide(effect, Proof::Texels(2.0), few, dropped, kept)
}

/// Maps and layers are as many as `asked`.
fn lamps(case: &RuleInput<'_>, asked: [u16; 2]) -> Fact {
    let effect = Effect::LampShadows;
    let need = &case.need;
    if need.lamp_maps == 0 {
        return Fact::decide(effect, Proof::Exact, true, "no lamp that casts reaches what is seen", "");
    }
    if need.lamp_casters == 0 {
        let why = format!("nothing casts into {} maps of lamps", need.lamp_maps);
        return Fact::decide(effect, Proof::Variant, true, why, "");
    }
    let [maps, layers] = asked.map(usize::from);
    let numbers = format!("lamps that reach what is seen have {} maps in {} layers", need.lamp_maps, need.lamp_layers);
    let fewer = need.lamp_maps < maps || need.lamp_layers < layers;
    Fact::decide(effect, Proof::Exact, fewer, format!("{numbers}, of {maps} in {layers}"), numbers)
}
