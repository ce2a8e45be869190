//! Adversarial search for scenes that break a proved bound of an option.

use super::facts::random::{Dice, random_case};
use super::facts::{Drawn, Easel};
use framegraph_passes::feature_culling::{EffectSet, FactMemory};
use framegraph_passes::quality::{GROUPS, Group, ROUNDING_STEPS, StepBound, bound};
use framegraph_passes::{FrameSettings, Settings};
use framegraph_shaders::layout::{Grading, ToneMap};
use framegraph_wgpu::Gpu;
use std::collections::BTreeMap;
use std::error::Error;

/// Result of a search.
#[derive(Clone, Debug, Default)]
pub struct Search {
    /// Number of scenes.
    pub scenes: u64,
    /// Number of drawn frames with a proved bound above 0, and of those with 0.
    pub proved: [usize; 2],
    /// Number of proofs by group and option.
    pub options: BTreeMap<String, usize>,
    /// Largest ratio of the error to the bound with its rounding, with scene, options and both values in 8-bit steps.
    pub worst: (f64, String),
    /// Number of frames whose error exceeds the bound.
    pub broken: usize,
}

/// Bound that replaces the proved one, or `None` for the proved one. Used to plant a wrong bound.
pub type Planted<'a> = &'a dyn Fn(&Group, &str) -> Option<StepBound>;

/// Draws the scenes `numbers` with and without all options that have a bound, and compares the largest differences.
///
/// Scenes share 8 settings, so that they share shaders. Half of them have a linear tone curve without effects that read
/// radiance, for the bound on formats; radiance is stored there. In each group, the first option with a bound is used.
///
/// Half of the scenes have exposure compensation of up to 14 EV, and the camera's exposure is lower by as much. Stored
/// radiance is small then, where formats round it coarsely. Frames are compared as requested, and after feature culling.
///
/// # Errors
/// The device fails.
pub fn search(
    gpu: &Gpu,
    numbers: std::ops::Range<u64>,
    planted: Planted<'_>,
    progress: &mut dyn FnMut(u64),
) -> Result<Search, Box<dyn Error>> {
    let mut easel = Easel::new(gpu);
    let mut found = Search::default();
    for number in numbers {
        progress(number);
        let mut case = random_case(number, number % 8);
        case.asked.samples = 1;
        let mut dice = Dice::new(number ^ 0xb0d5);
        if dice.chance(0.5) {
            let brighter_ev = dice.between(-2.0, 14.0) as f32;
            case.asked.post.compensation_ev = brighter_ev;
            case.ev100 += brighter_ev;
        }
        easel.inline = number % 2 != 0;
        if number % 2 == 0 {
            plain(&mut case.asked);
            case.asked.blended = Settings::DEFAULT.for_scene(&case.scene, case.size_px).blended;
        }
        let mut drawn = Drawn::new(gpu, case)?;
        let reference = FrameSettings { settings: drawn.case.asked, ..FrameSettings::DEFAULT };
        let (mut frame, mut steps, mut names) = (reference, 0.0, Vec::new());
        for group in &GROUPS {
            let mut facts =
                |settings: &Settings, kept: EffectSet| drawn.facts(settings, kept, &mut FactMemory::default());
            let own = group.options.iter().find_map(|option| {
                let mut other = frame;
                (option.apply)(&mut other);
                let proved = || bound(&frame, group, option, &mut facts);
                let bound = planted(group, option.name).or_else(proved)?;
                (other != frame).then_some((other, bound, option.name))
            });
            if let Some((other, bound, name)) = own {
                (frame, steps) = (other, steps + bound.steps);
                let name = format!("{}: {name}", group.name);
                *found.options.entry(name.clone()).or_default() += 1;
                names.push(name);
            }
        }
        found.scenes += 1;
        if names.is_empty() {
            continue;
        }
        found.proved[usize::from(steps == 0.0)] += 1;
        let mut apart = 0.0;
        for culled in [false, true] {
            let [ours, truth] = [&frame, &reference].map(|frame| {
                let facts = drawn.facts(&frame.settings, EffectSet::NONE, &mut FactMemory::default());
                let settings = if culled { facts.apply(&frame.settings) } else { frame.settings };
                drawn.picture(&mut easel, &settings)
            });
            let most = ours?.iter().zip(&truth?).map(|(a, b)| a.abs_diff(*b)).max();
            apart = most.map_or(0.0, f64::from).max(apart);
        }
        let most = if steps > 0.0 { steps + ROUNDING_STEPS } else { 0.0 };
        // Frames with a bound of 0 must be equal.
        let ratio = if apart == 0.0 { 0.0 } else { apart / most };
        found.broken += usize::from(ratio > 1.0);
        if ratio > found.worst.0 {
            found.worst = (ratio, format!("scene {number}, {}: {apart} of {most:.2} steps", names.join(", ")));
        }
    }
    Ok(found)
}

fn plain(settings: &mut Settings) {
    (settings.bloom, settings.dof, settings.taa, settings.fxaa) = (None, None, None, false);
    (settings.reflections, settings.post.edge_fade) = (None, None);
    settings.post.look.tone_map = ToneMap::Linear;
    settings.post.look.grading = Grading::NEUTRAL;
    (settings.post.look.luminance_scaling, settings.post.look.gamut_mapping) = (false, false);
    settings.post.by = framegraph_passes::grading::GradeBy::Direct;
}

impl std::fmt::Display for Search {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [above, zero] = self.proved;
        writeln!(f, "{} scenes: {above} frames with a proved bound above 0, {zero} proved equal.", self.scenes)?;
        writeln!(f, "\n| option | proofs |\n| --- | ---: |")?;
        self.options.iter().try_for_each(|(name, count)| writeln!(f, "| {name} | {count} |"))?;
        writeln!(f, "\nWorst ratio of error to bound: {:.3} ({}).", self.worst.0, self.worst.1)?;
        write!(f, "{} frames exceed their bound.", self.broken)
    }
}
