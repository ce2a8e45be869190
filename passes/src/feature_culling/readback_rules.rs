//! Rules based on measurements of earlier frames, for properties that no bound on the CPU proves.

use super::decided::Facts;
use super::effect::Effect;
use super::fact::{Decision, Fact, Proof};
use super::rule_input::RuleInput;
use super::visibility::fit_camera;
use crate::effects::bloom::{Blend, BloomSettings, Threshold};
use crate::effects::dof::DofSettings;
use crate::effects::exposure::Measurement;
use crate::gpu_scene::view::ViewSettings;
use framegraph_scene::camera::exposure_from_ev100;
use framegraph_shaders::layout::Projection;

/// Factor on measured values, since they are some frames old.
const SAFETY: f64 = 2.0;
/// Largest circle of confusion without effect, as a radius in pixels: radii below 1 are rounded to 0.
pub(super) const LEAST_RADIUS_PX: f64 = 0.5;

/// Returns the radius of the circle of confusion in pixels, at a distance from the eye plane in meters; infinite
/// without perspective.
pub(super) fn radius_px(view: &ViewSettings, dof: &DofSettings, distance_m: f64) -> f64 {
    let camera = fit_camera(view);
    if !camera.is_perspective() {
        return f64::INFINITY;
    }
    let projection = Projection::new(&view.camera.clip_from_view(camera.width_over_height));
    let (focus, endless_px) = dof.lens(&projection, view.size_px[1]);
    0.5 * f64::from(endless_px) * (1.0 - f64::from(focus) / distance_m).abs()
}

/// Decides bloom by measurements if bounds keep it, and requests the next measurement.
pub(super) fn glowing(case: &RuleInput<'_>, bloom: &BloomSettings, row: Fact, facts: &mut Facts) -> Fact {
    let thresholds = bloom.threshold != Threshold::None && bloom.blend == Blend::Add;
    if !measures(case, &row) || !thresholds || case.input.views.len() != 1 {
        return row;
    }
    facts.measure.light = true;
    let Measurement::Known(measured) = case.input.measured else { return unknown(row) };
    let Some(nits) = measured.most_nits else { return unknown(row) };
    let light = f64::from(nits) * f64::from(exposure_from_ev100(case.input.views[0].ev100));
    // With a hard threshold, texels exactly at the threshold glow.
    let at = f64::from(bloom.threshold_at);
    let dark = SAFETY * light < at && case.memory.within(Effect::Bloom, SAFETY * light, at);
    let why = format!("light was {light:.2} at most {}, and what glows begins at {at:.2}", ago(measured.frames_ago));
    Fact::decide(Effect::Bloom, Proof::Late, dark, why.clone(), why)
}

/// Decides depth of field by measurements if bounds keep it, and requests the next measurement.
pub(super) fn focused(case: &RuleInput<'_>, dof: &DofSettings, row: Fact, facts: &mut Facts) -> Fact {
    if !measures(case, &row) || case.input.views.len() != 1 {
        return row;
    }
    facts.measure.depth = true;
    let Measurement::Known(measured) = case.input.measured else { return unknown(row) };
    let Some(distances_m) = measured.distances_m else { return unknown(row) };
    let most =
        distances_m.map(|distance| radius_px(&case.input.views[0], dof, distance)).into_iter().fold(0.0, f64::max);
    let few = case.memory.within(Effect::DepthOfField, SAFETY * most, LEAST_RADIUS_PX);
    let ago = ago(measured.frames_ago);
    let why = format!("circles of confusion had a radius of {most:.2} pixels at most {ago}");
    Fact::decide(Effect::DepthOfField, Proof::Late, few, why.clone(), why)
}

/// Returns whether frames are measured and bounds leave a decision open.
fn measures(case: &RuleInput<'_>, row: &Fact) -> bool {
    let forced = case.input.forced.contains(row.effect);
    row.decision == Decision::Kept && !forced && case.input.measured != Measurement::Off
}

fn unknown(row: Fact) -> Fact {
    Fact { proof: Proof::Late, reason: format!("{}; no measure of it has come yet", row.reason), ..row }
}

fn ago(frames: u32) -> String {
    match frames {
        1 => "a frame ago".into(),
        more => format!("{more} frames ago"),
    }
}
