//! Sets of options whose error is proved to stay below a limit, from bounds that need no measurement.
//!
//! A bound is on the largest difference of any channel of any pixel, before both pictures are rounded to 8 bits. It is
//! also a bound on the root mean square. Bounds of several options add up, by the triangle inequality: each is derived
//! for the frame that already has the options before it. An option without a proof is never chosen.

use super::groups::{FrameOption, Group};
use super::measured::Choices;
use super::select::Offers;
use crate::feature_culling::{Decision, Effect, EffectSet, Facts, Proof};
use crate::frame::Settings;
use crate::frame::frame_settings::FrameSettings;
use crate::grading::GradeBy;
use framegraph::Format;
use framegraph_shaders::layout::{Grading, ToneMap};

/// A proved bound on the error of one option.
#[derive(Clone, Debug, PartialEq)]
pub struct StepBound {
    /// Largest difference of a channel, in 8-bit steps.
    pub steps: f64,
    /// Facts that the proof uses.
    pub proof: String,
}

/// Chosen set with its proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Guaranteed {
    /// Index of the option in each group.
    pub options: Vec<usize>,
    /// Predicted time of a frame, in ms; it is not proved.
    pub ms: f64,
    /// Bound of the whole set, in 8-bit steps: the sum of `bounds`, and one step for rounding if it is above 0.
    pub steps: f64,
    /// Name of the group and of the option, and its bound, for each option that is not the reference's.
    pub bounds: Vec<(&'static str, &'static str, StepBound)>,
}

/// Largest rounding, in 8-bit steps, that a bound leaves out: both pictures are rounded to the nearest step.
pub const ROUNDING_STEPS: f64 = 1.0;

/// Returns a bound on the difference between `frame` and the same frame with an option; `None` if there is no proof.
///
/// Three proofs exist:
/// - The frames are equal.
/// - Feature culling reduces both frames to the same settings. The bound is the sum of the bounds of all drops
///   ([`Proof::Exact`]: 0, [`Proof::Variant`]: 1, [`Proof::Codes`]). Only effects that differ between the frames are
///   dropped. Drops with other kinds of bounds are no proof.
/// - Only the format of radiance differs ([`rounding_steps`]).
///
/// `facts` runs feature culling on settings, where the effects of the set are always kept.
pub fn bound(
    frame: &FrameSettings,
    group: &Group,
    option: &FrameOption,
    facts: &mut impl FnMut(&Settings, EffectSet) -> Facts,
) -> Option<StepBound> {
    let mut other = *frame;
    (option.apply)(&mut other);
    if other == *frame {
        return Some(StepBound { steps: 0.0, proof: "the frame has this option".into() });
    }
    let formats =
        FrameSettings { settings: Settings { hdr_format: other.settings.hdr_format, ..frame.settings }, ..*frame };
    if other == formats
        && let Some(steps) = rounding_steps(&frame.settings, other.settings.hdr_format)
    {
        return Some(StepBound { steps, proof: "rounding of radiance before a linear tone curve".into() });
    }
    if other != (FrameSettings { settings: other.settings, ..*frame }) {
        return None;
    }
    let differs =
        |effect: &Effect| group.effects.contains(effect) || frame.settings.has(*effect) != other.settings.has(*effect);
    let differing: EffectSet = Effect::ALL.into_iter().filter(differs).collect();
    let (mut steps, mut reasons) = (0.0, Vec::new());
    let mut reduced = |settings: &Settings| {
        let all = facts(settings, EffectSet::NONE);
        let proved = |effect: &Effect| {
            let row = all.of(*effect);
            differing.contains(*effect) && row.is_some_and(|row| drop_steps(row.proof).is_some())
        };
        let kept = Effect::ALL.into_iter().filter(|effect| !proved(effect)).collect();
        let own = facts(settings, kept);
        for row in own.rows.iter().filter(|row| row.decision == Decision::Dropped) {
            steps += drop_steps(row.proof).unwrap_or(f64::INFINITY);
            let reason = format!("{} [{}]: {}", row.effect.name(), row.proof, row.reason);
            if !reasons.contains(&reason) {
                reasons.push(reason);
            }
        }
        own.apply(settings)
    };
    let equal = reduced(&frame.settings) == reduced(&other.settings);
    equal.then(|| StepBound { steps, proof: reasons.join("; ") }).filter(|bound| bound.steps.is_finite())
}

/// Returns the bound of a drop in 8-bit steps; `None` if it is of another kind.
fn drop_steps(proof: Proof) -> Option<f64> {
    match proof {
        Proof::Exact => Some(0.0),
        Proof::Variant => Some(1.0),
        Proof::Codes(steps) => Some(steps.into()),
        Proof::Texels(_) | Proof::Edges | Proof::Truer | Proof::Late => None,
    }
}

/// Returns a bound on the change of the picture, in 8-bit steps, if radiance is stored in `format` instead of the
/// format of the settings. `None` if no proof covers the settings.
///
/// A float format with `m` mantissa bits changes a value by at most a share of 2^−m; Vulkan allows truncation. Radiance is
/// rounded when it is stored, and again when samples are resolved, in both formats: the share is at most
/// `ε = 1 − (1 − 2^−m)² (1 − 2^−10)²`, where `m = 5` for the blue channel of `Rg11b10Ufloat`. Exposure and vignette are
/// factors, and a linear tone curve clamps each channel to 0…1, so the share remains. The sRGB encoding `E` is
/// concave with a linear toe, so `E(x) − E(x (1 − ε))` is largest at `x = 1`. Values below 2^−14 are
/// rounded to multiples of 2^−19, at a slope of 12.92.
///
/// Excluded are blended surfaces, which round once each, and effects that read the stored radiance or detect edges.
pub fn rounding_steps(settings: &Settings, format: Format) -> Option<f64> {
    let post = &settings.post;
    let linear = post.look.tone_map == ToneMap::Linear
        && !post.look.luminance_scaling
        && !post.look.gamut_mapping
        && post.look.grading == Grading::NEUTRAL
        && post.by == GradeBy::Direct
        && post.edge_fade.is_none();
    let reads = settings.bloom.is_some()
        || settings.dof.is_some()
        || settings.taa.is_some()
        || settings.reflections.is_some()
        || settings.upscale.is_some()
        || settings.scene_levels > 0
        || settings.stored.is_some();
    let known = [settings.hdr_format, format].iter().all(|f| matches!(f, Format::Rg11b10Ufloat | Format::Rgba16Float));
    if !linear || reads || settings.blended || settings.fxaa || !known {
        return None;
    }
    let kept = (1.0 - 2.0_f64.powi(-5)).powi(2) * (1.0 - 2.0_f64.powi(-10)).powi(2);
    let encoded = 1.055 * kept.powf(1.0 / 2.4) - 0.055;
    Some(255.0 * (1.0 - encoded + 12.92 * 2.0_f64.powi(-18)))
}

/// Chooses the fastest set whose error is proved to be at most `max_steps` 8-bit steps from `reference`. Times are those of
/// `offers`; its errors are ignored. The reference is always possible, with a bound of 0.
///
/// Each bound is derived alone, and the set is chosen by the sums. Then bounds are derived again one after
/// the other, each for the frame with the options before it. An option that fails there is replaced by that of
/// the reference.
pub fn guaranteed(
    reference: &FrameSettings,
    choices: &Choices,
    offers: &Offers,
    max_steps: f64,
    facts: &mut impl FnMut(&Settings, EffectSet) -> Facts,
) -> Guaranteed {
    let mut proved = Offers { pairs: Vec::new(), ..offers.clone() };
    for ((group, options), own) in choices.iter().zip(&mut proved.groups) {
        for (option, offer) in options.iter().zip(own) {
            offer.squares = bound(reference, group, option, facts).map_or(f64::INFINITY, |bound| bound.steps);
        }
    }
    let total = |sum: f64| if sum > 0.0 { sum + ROUNDING_STEPS } else { 0.0 };
    let within = proved.front().into_iter().find(|set| total(set.squares) <= max_steps);
    let mut options = within.map_or_else(|| proved.finest(), |set| set.options);
    let (mut frame, mut sum, mut bounds) = (*reference, 0.0, Vec::new());
    for ((group, own), index) in choices.iter().zip(&mut options) {
        let option = own[*index];
        let found = bound(&frame, group, option, facts);
        match found.filter(|found| total(sum + found.steps) <= max_steps) {
            Some(found) => {
                let before = frame;
                (option.apply)(&mut frame);
                sum += found.steps;
                if frame != before {
                    bounds.push((group.name, option.name, found));
                }
            }
            None => *index = own.len() - 1,
        }
    }
    Guaranteed { ms: proved.predicted(&options).ms, options, steps: total(sum), bounds }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature_culling::Fact;
    use crate::quality::{GROUPS, Offer, reference};

    /// Feature culling of a scene in which only ambient occlusion and the sun's shadows are without effect.
    fn culled(settings: &Settings, kept: EffectSet) -> Facts {
        let row = |(effect, proof)| {
            let decision = if kept.contains(effect) { Decision::Kept } else { Decision::Dropped };
            Fact { effect, decision, proof, reason: "none".into() }
        };
        let rows = [(Effect::Occlusion, Proof::Variant), (Effect::SunShadows, Proof::Truer)];
        let asked = rows.into_iter().filter(|(effect, _)| settings.has(*effect));
        Facts { rows: asked.map(row).collect(), ..Facts::default() }
    }

    #[test]
    fn only_proved_options_are_chosen() {
        let finest = reference(&FrameSettings::DEFAULT);
        let of = |name: &str, option: usize| {
            let group = Group::of(name).expect("a group");
            bound(&finest, group, &group.options[option], &mut culled)
        };
        assert_eq!(of("occlusion", 0).map(|bound| bound.steps), Some(1.0), "dropped from one of both frames");
        assert_eq!(of("occlusion", 1).map(|bound| bound.steps), Some(2.0), "dropped from both");
        assert_eq!(of("sun-shadows", 0), None, "a bound of another kind");
        assert_eq!(of("edges", 0), None);
        let choices: Choices = GROUPS.iter().map(|group| (group, group.options.iter().collect())).collect();
        let offer = |(index, _)| Offer { ms: index as f64, squares: 0.0 };
        let groups = GROUPS.iter().map(|group| group.options.iter().enumerate().map(offer).collect()).collect();
        let offers = Offers { groups, pairs: Vec::new(), fastest_ms: 1.0 };
        let sum = |max_steps| guaranteed(&finest, &choices, &offers, max_steps, &mut culled);
        let found = sum(2.0);
        assert_eq!((found.steps, found.bounds.len(), found.bounds[0].1), (2.0, 1, "none"), "{found:?}");
        assert_eq!((sum(1.9).steps, sum(1.9).bounds), (0.0, Vec::new()), "rounding is not forgotten");
    }

    #[test]
    fn rounding_is_bounded_for_linear_curves_alone() {
        let mut settings = Settings { blended: false, fxaa: false, bloom: None, ..Settings::DEFAULT };
        assert_eq!(rounding_steps(&settings, Format::Rg11b10Ufloat), None);
        settings.post.look.tone_map = ToneMap::Linear;
        let steps = rounding_steps(&settings, Format::Rg11b10Ufloat);
        assert!(steps.is_some_and(|steps| (7.0..8.0).contains(&steps)), "{steps:?}");
        settings.blended = true;
        assert_eq!(rounding_steps(&settings, Format::Rg11b10Ufloat), None);
    }
}
