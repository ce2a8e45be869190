//! Rules for what happens to the whole picture.

use super::decided::Facts;
use super::effect::Effect;
use super::fact::{Fact, Proof};
use super::occluders::covers;
use super::rule_input::RuleInput;
use crate::effects::color::surface::HDR_FORMAT;
use crate::gpu_scene::view::Background;
use framegraph_scene::camera::exposure_from_ev100;
use framegraph_shaders::layout::{Grading, ToneMap};

pub(super) fn rules(case: &RuleInput<'_>, facts: &mut Facts) {
    let settings = case.settings;
    let post = &settings.post;
    let empty = case.seen.instances.is_empty();
    if settings.sky {
        let cover = covers(&case.seen, case.input.views);
        let dropped = format!("`{}` covers the whole picture", cover.unwrap_or_default());
        let kept = "no one instance covers the whole picture";
        facts.rows.push(Fact::decide(Effect::Sky, Proof::Exact, cover.is_some(), dropped, kept));
    }
    let zero =
        |effect, unneeded, dropped: String, kept: &str| Fact::decide(effect, Proof::Exact, unneeded, dropped, kept);
    if post.vignette_ev != 0.0 {
        let strength = format!("its strength is {} stops", post.vignette_ev);
        facts.rows.push(zero(Effect::Vignette, post.vignette_ev <= 0.0, strength.clone(), &strength));
    }
    if let Some(fade) = post.edge_fade {
        let none = fade.color == [1.0; 3];
        facts.rows.push(zero(Effect::EdgeFade, none, "its color is white, a factor of 1".into(), "its color dims"));
    }
    if post.look.grading != Grading::NEUTRAL {
        facts.rows.push(Fact::kept(Effect::Grading, Proof::Exact, "it is not neutral"));
    }
    if post.dither > 0.0 {
        facts.rows.push(dither(case, empty));
    }
    if settings.hdr_format == HDR_FORMAT {
        facts.rows.push(hdr_target(case));
    }
    if settings.fxaa {
        facts.rows.push(fxaa(case, empty));
    }
    if settings.taa.is_some() {
        let why = "all pixels of all frames are the same: there is nothing to add up";
        facts.rows.push(Fact::decide(Effect::Taa, Proof::Variant, is_even(case, empty), why, "the picture has edges"));
    }
    if settings.samples > 1 {
        let count = case.seen.instances.len();
        let kept = format!("{count} instances are in view, and have edges");
        facts.rows.push(Fact::decide(Effect::Msaa, Proof::Variant, empty, "nothing is in view that has edges", kept));
    }
}

/// Returns true if all pixels are equal.
fn is_even(case: &RuleInput<'_>, empty: bool) -> bool {
    let post = &case.settings.post;
    let constant = matches!(case.input.background, Background::None | Background::Constant(_)) || !case.settings.sky;
    let lens = case.settings.fog.is_some() || case.settings.bloom.is_some();
    empty && constant && !lens && post.vignette_ev <= 0.0 && post.edge_fade.is_none()
}

fn dither(case: &RuleInput<'_>, empty: bool) -> Fact {
    let proof = Proof::Codes(0.5 * case.settings.post.dither + 0.5);
    let why = "all pixels are the same: there are no steps to hide";
    Fact::decide(Effect::Dither, proof, is_even(case, empty), why, "the picture may have gradients")
}

/// Returns the maximum pre-exposed radiance of the picture; infinite if something visible is lit, fogged or textured.
pub(super) fn most_light(case: &RuleInput<'_>) -> f32 {
    let settings = case.settings;
    let exposed = |nits: f32| {
        let most = case.input.views.iter().map(|view| exposure_from_ev100(view.ev100)).fold(0.0, f32::max);
        nits * most
    };
    let behind = match case.input.background {
        Background::None => 0.0,
        Background::Constant(nits) => exposed(nits.max_element()),
        _ if !settings.sky => 0.0,
        _ => f32::INFINITY,
    };
    let known =
        case.surfaces.lit == 0 && !case.surfaces.may_exceed_one && settings.fog.is_none() && settings.scene_levels == 0;
    if known { behind.max(1.0) } else { f32::INFINITY }
}

/// Radiance that is at most 1 and only cut off at 1 loses nothing in a target of the picture's own codes.
fn hdr_target(case: &RuleInput<'_>) -> Fact {
    let (settings, post) = (case.settings, &case.settings.post);
    let linear = post.look.tone_map == ToneMap::Linear
        && !post.look.luminance_scaling
        && !post.look.gamut_mapping
        && post.look.grading == Grading::NEUTRAL
        && post.compensation_ev == 0.0
        && post.by == crate::grading::GradeBy::Direct;
    let within = most_light(case) <= 1.0;
    let blended = case.seen.most(|lists| lists.blend.len());
    // Each surface that blends is rounded to a code, and dither sees the rounded color.
    let proof = Proof::Codes(0.5 * blended as f32 + 1.0);
    let plain = linear && within && post.vignette_ev <= 0.0 && post.edge_fade.is_none() && settings.scene_levels == 0;
    let why = "all that is seen is unlit and at most 1, and the tone curve is linear: eight bits of codes hold it";
    let kept = if linear { "light may be beyond 1" } else { "the tone curve or grading is not linear" };
    let lens = settings.dof.is_some() || settings.bloom.is_some();
    let history = lens || settings.reflections.is_some() || settings.taa.is_some() || settings.stored.is_some();
    Fact::decide(Effect::HdrTarget, proof, plain && !history, why, kept)
}

fn fxaa(case: &RuleInput<'_>, empty: bool) -> Fact {
    let effect = Effect::Fxaa;
    let samples = case.settings.samples;
    if is_even(case, empty) {
        return Fact::decide(effect, Proof::Exact, true, "all pixels are the same: there is no edge", "");
    }
    let why = format!("{samples} samples have softened edges, and a filter after them blurs what they resolved");
    Fact::decide(effect, Proof::Truer, samples > 1 && !empty, why, "edges have one sample")
}
