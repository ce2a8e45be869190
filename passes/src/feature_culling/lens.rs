//! Rules for fog, depth of field and bloom.

use super::decided::Facts;
use super::effect::Effect;
use super::fact::{Fact, Proof};
use super::readback_rules;
use super::rule_input::RuleInput;
use super::visibility::fit_camera;
use crate::effects::bloom::{Blend, BloomSettings, Threshold};
use crate::effects::dof::DofSettings;
use crate::effects::fog::FogSettings;
use crate::gpu_scene::view::ViewSettings;

/// Greatest opacity of fog that changes the picture by at most half an 8-bit step, for fog no brighter than white.
const LEAST_OPACITY: f64 = 1.0 / 512.0;

pub(super) fn rules(case: &RuleInput<'_>, facts: &mut Facts) {
    if let Some(fog) = &case.settings.fog {
        facts.rows.push(fogged(case, fog));
    }
    if let Some(dof) = &case.settings.dof {
        let row = readback_rules::focused(case, dof, focused(case, dof), facts);
        facts.rows.push(row);
    }
    if let Some(bloom) = &case.settings.bloom {
        let row = readback_rules::glowing(case, bloom, glowing(case, bloom), facts);
        facts.rows.push(row);
    }
}

/// Returns the least and greatest distance of visible surfaces along the view axis and along rays, in meters;
/// infinite for the sky.
fn distances(case: &RuleInput<'_>, view: &ViewSettings) -> [f64; 3] {
    let camera = fit_camera(view);
    let (mut near, mut far, mut straight) = (f64::INFINITY, camera.range_m().0, 0.0_f64);
    for bounds in case.seen.instances.iter().map(|i| &case.seen.scene.instances[*i].bounds) {
        for corner in bounds.corners() {
            let ahead = camera.ahead_m(corner);
            (near, far) = (near.min(ahead), far.max(ahead));
            straight = straight.max((corner - view.camera.eye).length());
        }
    }
    let end = |far: f64| if case.settings.sky { f64::INFINITY } else { far };
    [near.max(camera.range_m().0), end(far), end(straight)]
}

fn fogged(case: &RuleInput<'_>, fog: &FogSettings) -> Fact {
    let effect = Effect::Fog;
    if !fog.is_seen() || fog.most_opacity <= 0.0 {
        let why = format!("it hides nothing: density {}, opacity {} at most", fog.density, fog.most_opacity);
        return Fact::decide(effect, Proof::Exact, true, why, "");
    }
    let opacity = |view: &ViewSettings| {
        let [_, _, far] = distances(case, view);
        let boxes = case.seen.instances.iter().map(|i| case.seen.scene.instances[*i].bounds.min.y);
        // Fog is densest at the lowest point that a ray can pass.
        let lowest = boxes.fold(view.camera.eye.y, f64::min) - f64::from(fog.height_m);
        let densest = f64::from(fog.density) * (-f64::from(fog.falloff) * lowest).exp();
        let way = (far.min(fog.cut_off_m.into()) - f64::from(fog.start_m)).max(0.0);
        // The mean density of the whole ray applies beyond the clear start, so the start does not help.
        let way = if fog.exact || way == 0.0 { way } else { far.min(fog.cut_off_m.into()) };
        (-(-densest * way).exp_m1()).min(fog.most_opacity.into())
    };
    let most = case.input.views.iter().map(opacity).fold(0.0, f64::max);
    let few = case.memory.within(effect, most, LEAST_OPACITY);
    let numbers = format!("it hides {most:.2e} of what is seen at most");
    Fact::decide(effect, Proof::Codes(0.5), few, numbers.clone(), numbers)
}

fn focused(case: &RuleInput<'_>, dof: &DofSettings) -> Fact {
    let effect = Effect::DepthOfField;
    if !dof.is_seen() {
        return Fact::decide(effect, super::screen::apart(case), true, "its circles have no size", "");
    }
    let radius = |view: &ViewSettings| {
        let [near, far, _] = distances(case, view);
        readback_rules::radius_px(view, dof, near.min(far)).max(readback_rules::radius_px(view, dof, far))
    };
    let most = case.input.views.iter().map(radius).fold(0.0, f64::max);
    let few = case.memory.within(effect, most, readback_rules::LEAST_RADIUS_PX);
    let numbers = format!("circles of confusion have a radius of {most:.2} pixels at most");
    Fact::decide(effect, super::screen::apart(case), few, numbers.clone(), numbers)
}

fn glowing(case: &RuleInput<'_>, bloom: &BloomSettings) -> Fact {
    let effect = Effect::Bloom;
    let row = |unneeded, why: String, kept: &str| Fact::decide(effect, super::screen::apart(case), unneeded, why, kept);
    if !bloom.is_seen() {
        return row(true, format!("nothing of it is added: strength {}, {} levels", bloom.strength, bloom.levels), "");
    }
    let (most, at) = (super::picture::most_light(case), bloom.threshold_at);
    let dark = bloom.threshold != Threshold::None && bloom.blend == Blend::Add && most < at;
    let why = format!("light is at most {most:.2}, and what glows begins at {at:.2}");
    row(dark, why, "light may be beyond the threshold, if there is one")
}
