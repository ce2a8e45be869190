//! Sets of options whose error is proved to stay below a limit, from bounds that need no measurement.
//!
//! A bound is on the largest difference of any channel of any pixel, before both pictures are rounded to 8 bits. It is
//! also a bound on the root mean square. Bounds of several options add up, by the triangle inequality: each is derived
//! for the frame that already has the options before it. An option without a proof is never chosen.

use super::groups::{FrameOption, Group};
use super::measured::Choices;
use super::select::Offers;
use crate::feature_culling::{Decision, Effect, EffectSet, Fact, Facts, Proof};
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
    /// Index of the option in each group. Without a row in `bounds`, it is the finest of the choices, and
    /// [`Guaranteed::apply`] keeps the option of the reference.
    pub options: Vec<usize>,
    /// Predicted time of a frame, in ms; it is not proved.
    pub ms: f64,
    /// Bound of the whole set, in 8-bit steps: the sum of `bounds`, and one step for rounding if it is above 0.
    pub steps: f64,
    /// Name of the group and of the option, and its bound, for each option that is not the reference's.
    pub bounds: Vec<(&'static str, &'static str, StepBound)>,
}

impl Guaranteed {
    /// Changes the reference to the chosen frame: applies the options that have a proof, and no others.
    pub fn apply(&self, reference: &mut FrameSettings) {
        for (group, option, _) in &self.bounds {
            if let Some(option) = Group::of(group).and_then(|group| group.option(option)) {
                (option.apply)(reference);
            }
        }
    }
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
/// The bound holds with and without feature culling of both frames. If culling drops an effect from only one of them, the
/// bound of this drop is added, or there is no proof.
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
        let mut reasons = vec!["rounding of radiance before a linear tone curve".into()];
        let culled = culled_steps([&frame.settings, &other.settings], [EffectSet::NONE; 2], facts, &mut reasons)?;
        return Some(StepBound { steps: steps + culled, proof: reasons.join("; ") });
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
            add(&mut reasons, row);
        }
        (own.apply(settings), own.dropped())
    };
    let [(ours, dropped), (theirs, also)] = [reduced(&frame.settings), reduced(&other.settings)];
    if ours != theirs || !steps.is_finite() {
        return None;
    }
    steps += culled_steps([&frame.settings, &other.settings], [dropped, also], facts, &mut reasons)?;
    Some(StepBound { steps, proof: reasons.join("; ") })
}

/// Adds the reason of a drop.
fn add(reasons: &mut Vec<String>, row: &Fact) {
    let reason = format!("{} [{}]: {}", row.effect.name(), row.proof, row.reason);
    if !reasons.contains(&reason) {
        reasons.push(reason);
    }
}

/// Returns a bound, in 8-bit steps, on how much feature culling moves two frames apart; `None` if there is no proof.
///
/// A drop may depend on an option: radiance is stored in 8 bits only if no effect reads it. A drop from both frames
/// leaves the same settings, so the frames move apart only by drops from one of them. `counted` are drops that are
/// already part of the bound. There is no proof if both frames keep different amounts of an effect.
fn culled_steps(
    frames: [&Settings; 2],
    counted: [EffectSet; 2],
    facts: &mut impl FnMut(&Settings, EffectSet) -> Facts,
    reasons: &mut Vec<String>,
) -> Option<f64> {
    let culled = frames.map(|settings| facts(settings, EffectSet::NONE));
    let mut steps = 0.0;
    for effect in Effect::ALL {
        let is_dropped = |row: &&Fact| row.decision == Decision::Dropped;
        let rows = [0, 1].map(|at| culled[at].of(effect).filter(is_dropped));
        if let [Some(_), Some(_)] = rows {
            let kept = Effect::ALL.into_iter().filter(|other| *other != effect).collect();
            let [ours, theirs] =
                [0, 1].map(|at| Settings { measure: frames[0].measure, ..culled[at].apply_but(frames[0], kept) });
            if ours != theirs {
                return None;
            }
            continue;
        }
        for (row, counted) in rows.into_iter().zip(counted) {
            if let Some(row) = row.filter(|_| !counted.contains(effect)) {
                steps += drop_steps(row.proof)?;
                add(reasons, row);
            }
        }
    }
    Some(steps)
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
/// concave with a linear toe, so `E(x) − E(x (1 − ε))` is largest at `x = 1`.
///
/// Values below 2^−14 are rounded to multiples of 2^−19, or of 2^−24 as half floats, twice each. Together they change by at
/// most `δ = 2^−18 + 2^−23` more. Exposure compensation multiplies stored values, and therefore also `δ`, by `2^EV`.
/// Vignette only darkens. So `x` changes to at least `x (1 − ε) − δ 2^EV`. The slope of `E` is at most 12.92, so the picture
/// changes by at most `E(1) − E(1 − ε) + 12.92 δ 2^EV`. Factors below 1 are not used.
///
/// Excluded are blended surfaces, which round once each, and effects that read the stored radiance or detect edges.
/// Weights of a tone-mapped resolve and separate post-processing passes also round, and are excluded.
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
        || settings.tone_resolve
        || settings.split_post
        || settings.stored.is_some();
    let known = [settings.hdr_format, format].iter().all(|f| matches!(f, Format::Rg11b10Ufloat | Format::Rgba16Float));
    if !linear || reads || settings.blended || settings.fxaa || !known {
        return None;
    }
    let kept = (1.0 - 2.0_f64.powi(-5)).powi(2) * (1.0 - 2.0_f64.powi(-10)).powi(2);
    let encoded = 1.055 * kept.powf(1.0 / 2.4) - 0.055;
    let brightened = f64::from(post.compensation_ev).max(0.0).exp2();
    let small = (2.0_f64.powi(-18) + 2.0_f64.powi(-23)) * brightened;
    Some(255.0 * (1.0 - encoded + 12.92 * small))
}

/// Chooses the fastest set whose error is proved to be at most `max_steps` 8-bit steps from `reference`. Times are those of
/// `offers`; its errors are ignored. The reference is always possible, with a bound of 0.
///
/// Each bound is derived alone, and the set is chosen by the sums. Then bounds are derived again one after
/// the other, each for the frame with the options before it. An option that fails there has no row in
/// [`Guaranteed::bounds`], and the reference's option remains.
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
        let mut facts = Facts::default();
        facts.rows = asked.map(row).collect();
        facts
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
        let mut frame = finest;
        found.apply(&mut frame);
        assert_eq!(frame.settings, Settings { occlusion: None, ..finest.settings });
        // Choices without the finest options: no proof is found for the others, and they are not applied.
        let fewer: Choices = GROUPS.iter().map(|group| (group, vec![&group.options[0]])).collect();
        let groups = GROUPS.iter().map(|_| vec![Offer { ms: 1.0, squares: 0.0 }]).collect();
        let offers = Offers { groups, pairs: Vec::new(), fastest_ms: 1.0 };
        let none = guaranteed(&finest, &fewer, &offers, 0.5, &mut culled);
        let mut frame = finest;
        none.apply(&mut frame);
        assert_eq!((none.bounds, frame), (Vec::new(), finest));
    }

    /// Culls the HDR target only if no effect reads radiance, as in an unlit scene.
    #[test]
    fn drops_from_only_one_frame_are_counted_or_no_proof() {
        let finest = reference(&FrameSettings::DEFAULT);
        let group = Group::of("reflections").expect("a group");
        let of = |proof: Proof| {
            let mut facts = |settings: &Settings, kept: EffectSet| {
                let row = |effect, unneeded, proof| {
                    let dropped = unneeded && !kept.contains(effect);
                    let decision = if dropped { Decision::Dropped } else { Decision::Kept };
                    Fact { effect, decision, proof, reason: "none".into() }
                };
                let reads = settings.reflections.is_some();
                let mut facts = Facts::default();
                facts.rows.extend(reads.then(|| row(Effect::Reflections, true, Proof::Exact)));
                facts.rows.push(row(Effect::HdrTarget, !reads, proof));
                facts
            };
            bound(&finest, group, &group.options[0], &mut facts).map(|bound| bound.steps)
        };
        assert_eq!(of(Proof::Codes(1.0)), Some(1.0));
        assert_eq!(of(Proof::Edges), None);
    }

    #[test]
    fn rounding_is_bounded_for_linear_curves_alone() {
        let mut settings = Settings { blended: false, fxaa: false, bloom: None, ..Settings::DEFAULT };
        assert_eq!(rounding_steps(&settings, Format::Rg11b10Ufloat), None);
        settings.post.look.tone_map = ToneMap::Linear;
        let steps = rounding_steps(&settings, Format::Rg11b10Ufloat);
        assert!(steps.is_some_and(|steps| (7.0..8.0).contains(&steps)), "{steps:?}");
        settings.post.compensation_ev = -3.0;
        assert_eq!(rounding_steps(&settings, Format::Rg11b10Ufloat), steps);
        settings.post.compensation_ev = 10.0;
        let brightened = rounding_steps(&settings, Format::Rg11b10Ufloat);
        assert!(brightened.is_some_and(|steps| (20.0..22.0).contains(&steps)), "{brightened:?}");
        settings.blended = true;
        assert_eq!(rounding_steps(&settings, Format::Rg11b10Ufloat), None);
    }
}
