//! Budgets: measures the cost and error of the frame's options, and verifies the chosen sets.

use super::record::Rounds;
use super::statistics::quantile;
use super::studio::{Ready, Setup, Studio, codes};
use super::technique::Outcome;
use crate::reference::picture::Picture;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::quality::{
    Bound, Choices, FrameOption, GROUPS, Group, Measured, MeasuredGroup, MeasuredOption, MeasuredPair, Offers, Trial,
    reference, settle,
};
use framegraph_passes::{Facts, FrameSettings, Preset};
use glam::Vec3;

/// Scenes for measuring options; sets are tried on the first.
pub const SCENES: [&str; 3] = ["columns", "spheres", "glass"];
/// Number of errors along the Pareto front at which pairs are tested for additivity.
const TRIED: usize = 6;

/// Draws frames of option sets, and caches compiled resources.
#[derive(Debug)]
pub struct Bench<'a> {
    studio: &'a Studio<'a>,
    made: Vec<(&'static str, LightSettings, Ready)>,
    references: Vec<(&'static str, Picture)>,
}

/// Returns the reference settings: the finest preset with the finest option of each group, without dithering. Shadow
/// maps of punctual lights are off, since the scenes have none.
pub fn finest() -> FrameSettings {
    let mut frame = reference(&Preset::Ultra.frame());
    frame.settings.post.dither = 0.0;
    frame.settings.shadows = frame.settings.shadows.map(|shadows| ShadowSettings { local_maps: 0, ..shadows });
    frame
}

/// Returns the reference with other options.
pub fn with(options: impl IntoIterator<Item = &'static FrameOption>) -> FrameSettings {
    let mut frame = finest();
    options.into_iter().for_each(|option| (option.apply)(&mut frame));
    frame
}

/// Returns the set's option in each group.
pub fn chosen(choices: &Choices, set: &[usize]) -> Vec<&'static FrameOption> {
    choices.iter().zip(set).map(|((_, options), index)| options[*index]).collect()
}

fn setup(scene: &'static str, frame: &FrameSettings) -> Setup {
    Setup {
        scene,
        ev100: 14.5,
        settings: frame.settings,
        light: frame.settings.shading.light(frame.quality),
        lights: frame.lights,
        sun: Some((Vec3::new(0.5, 0.7, 0.5).normalize(), 0.0175)),
    }
}

impl<'a> Bench<'a> {
    /// Creates a bench without drawn frames.
    pub fn new(studio: &'a Studio<'a>) -> Self {
        Self { studio, made: Vec::new(), references: Vec::new() }
    }

    fn ready(&mut self, scene: &'static str, frame: &FrameSettings) -> Outcome<&mut Ready> {
        let setup = setup(scene, frame);
        let known = self.made.iter().position(|(own, light, _)| *own == scene && *light == setup.light);
        let at = match known {
            Some(at) => {
                self.studio.change(&mut self.made[at].2, &setup.settings)?;
                at
            }
            None => {
                let ready = self.studio.prepare(&setup, self.studio.size_px)?;
                self.made.push((scene, setup.light, ready));
                self.made.len() - 1
            }
        };
        Ok(&mut self.made[at].2)
    }

    fn reference(&mut self, scene: &'static str) -> Outcome<Picture> {
        if let Some((_, known)) = self.references.iter().find(|(own, _)| *own == scene) {
            return Ok(known.clone());
        }
        let gpu = self.studio.gpu;
        let picture = self.ready(scene, &finest())?.picture(gpu)?;
        self.references.push((scene, picture.clone()));
        Ok(picture)
    }

    /// Returns the mean squared difference of a frame from the reference, in squared 8-bit steps.
    ///
    /// # Errors
    /// Any error of the device.
    pub fn squares(&mut self, scene: &'static str, frame: &FrameSettings) -> Outcome<f64> {
        let truth = self.reference(scene)?;
        let gpu = self.studio.gpu;
        let ours = self.ready(scene, frame)?.picture(gpu)?;
        let apart = codes(&ours, &truth);
        Ok(apart.iter().map(|d| d * d).sum::<f64>() / apart.len() as f64)
    }

    /// Returns the median time of a frame in ms, over as many frames as for a technique.
    ///
    /// # Errors
    /// Any error of the device.
    pub fn ms(&mut self, scene: &'static str, frame: &FrameSettings) -> Outcome<f64> {
        let (gpu, Rounds { warm_up, timed }) = (self.studio.gpu, self.studio.rounds);
        let ready = self.ready(scene, frame)?;
        let mut took = Vec::new();
        for index in 0..warm_up + timed {
            let ms = ready.draw(gpu)?;
            took.extend((index >= warm_up).then_some(ms));
        }
        program::interrupt::check()?;
        took.sort_by(f64::total_cmp);
        Ok(quantile(&took, 0.5))
    }

    /// Returns the groups in which a scene leaves a choice after feature culling.
    ///
    /// # Errors
    /// Any error of the device, or an unknown name in the record.
    pub fn choices(&mut self, scene: &'static str, measured: &Measured) -> Outcome<Choices> {
        let facts = self.ready(scene, &finest())?.facts();
        Ok(measured.choices(&facts, |option| self.has(option))?)
    }

    /// Measures cost and error of each option, changed alone from the reference, on the first scene that uses its
    /// group. Then finds pairs of options that do not add up.
    ///
    /// # Errors
    /// Any error of the device.
    pub fn measured(&mut self) -> Outcome<Measured> {
        let mut measured = Measured::default();
        let mut facts = Vec::new();
        for scene in SCENES {
            facts.push((scene, self.ready(scene, &finest())?.facts()));
        }
        let cheapest = with(GROUPS.iter().filter_map(|group| self.options(group).first().copied()));
        let ends = self.timed(&[(SCENES[0], cheapest), (SCENES[0], finest())])?;
        (measured.fastest_ms, measured.reference_ms) = (ends[0], ends[1]);
        for group in &GROUPS {
            let calls = |(_, facts): &&(&str, _)| !group.is_dropped(facts);
            let scene = facts.iter().find(calls).map_or(SCENES[0], |(scene, _)| scene);
            let options = self.options(group);
            let frames: Vec<_> = options.iter().map(|option| (scene, with([*option]))).collect();
            let timed = self.timed(&frames)?;
            let mut found = Vec::new();
            for ((option, (scene, frame)), ms) in options.iter().zip(&frames).zip(timed) {
                let codes = self.squares(scene, frame)?.sqrt();
                found.push(MeasuredOption { name: option.name.to_owned(), ms, codes });
                program::interrupt::check()?;
            }
            measured.groups.push(MeasuredGroup {
                name: group.name.to_owned(),
                scene: scene.to_owned(),
                options: found,
            });
        }
        self.learn_pairs(&mut measured)?;
        Ok(measured)
    }

    /// Measures the errors of a record's options again, and keeps their times.
    ///
    /// # Errors
    /// Any error of the device, or an unknown name in the record.
    pub fn renew_errors(&mut self, measured: &mut Measured) -> Outcome<()> {
        let choices = measured.choices(&Facts::default(), |option| self.has(option))?;
        for (own, (_, options)) in measured.groups.iter_mut().zip(&choices) {
            let scene = SCENES.into_iter().find(|scene| *scene == own.scene).ok_or("a scene of another version")?;
            for found in &mut own.options {
                // The device may lack an option of another one's record.
                if let Some(option) = options.iter().find(|option| option.name == found.name) {
                    found.codes = self.squares(scene, &with([*option]))?.sqrt();
                }
                program::interrupt::check()?;
            }
        }
        measured.pairs.clear();
        self.learn_pairs(measured)
    }

    /// Returns median times of frames in ms, over three rounds in different orders. The finest option of a group is the
    /// reference, so each group has its own. Within a round, each frame is drawn until it is warm and timed. One
    /// executor is used at a time, since drivers cache compiled code per executor, which would take gigabytes.
    fn timed(&mut self, frames: &[(&'static str, FrameSettings)]) -> Outcome<Vec<f64>> {
        const ROUNDS: u32 = 3;
        let (gpu, Rounds { warm_up, timed }) = (self.studio.gpu, self.studio.rounds);
        let mut took = vec![Vec::new(); frames.len()];
        for round in 0..ROUNDS {
            for step in 0..frames.len() {
                // Each round starts with another frame, and every other round runs backward.
                let at = (step + round as usize) % frames.len();
                let at = if round % 2 == 1 { frames.len() - 1 - at } else { at };
                let (scene, frame) = &frames[at];
                let ready = self.ready(scene, frame)?;
                for index in 0..warm_up.div_ceil(ROUNDS) + timed.div_ceil(ROUNDS) {
                    let ms = ready.draw(gpu)?;
                    took[at].extend((index >= warm_up.div_ceil(ROUNDS)).then_some(ms));
                }
                program::interrupt::check()?;
            }
        }
        let median = |mut took: Vec<f64>| {
            took.sort_by(f64::total_cmp);
            quantile(&took, 0.5)
        };
        Ok(took.into_iter().map(median).collect())
    }

    /// Returns the options that the device supports.
    fn options(&self, group: &'static Group) -> Vec<&'static FrameOption> {
        group.options.iter().filter(|option| self.has(option)).collect()
    }

    fn has(&self, option: &FrameOption) -> bool {
        let mut frame = finest();
        (option.apply)(&mut frame);
        frame.settings.shading.precision.check(self.studio.gpu).is_ok()
    }

    fn learn_pairs(&mut self, measured: &mut Measured) -> Outcome<()> {
        let choices = self.choices(SCENES[0], measured)?;
        let mut offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
        let most = offers.front().first().map_or(0.0, |set| set.codes());
        for step in 0..TRIED {
            let bound = most * (step as f64 + 0.5) / TRIED as f64;
            let asked = offers.clone();
            settle(&mut offers, Bound::Codes(bound), |set| {
                let squares = self.squares(SCENES[0], &with(chosen(&choices, set)))?;
                // Times are predicted from measurements.
                Ok::<_, Box<dyn std::error::Error>>(Trial { ms: asked.predicted(set).ms, squares })
            })?;
        }
        let name =
            |[group, option]: [usize; 2]| [choices[group].0.name.to_owned(), choices[group].1[option].name.to_owned()];
        let pairs = offers.pairs.iter();
        measured.pairs =
            pairs.map(|pair| MeasuredPair { options: pair.at.map(name), squares: pair.beyond.squares }).collect();
        Ok(())
    }
}

/// Verification of sets that were chosen for random budgets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verified {
    /// Number of budgets.
    pub budgets: usize,
    /// Number of budgets that the chosen frame met when drawn and timed again.
    pub within: usize,
    /// Number of chosen sets.
    pub sets: usize,
    /// Number of changes of one option that also fit the budget.
    pub swaps: usize,
    /// Descriptions of changes whose error is more than 5 % below that of the chosen set.
    pub better: Vec<String>,
}

/// Measures the time of a frame, or predicts it in tests; `None` if it cannot be timed.
pub type Clock<'c> = dyn FnMut(&mut Bench<'_>, &FrameSettings, &Offers, &[usize]) -> Outcome<f64> + 'c;

/// Chooses sets for `count` random budgets between the fastest frame and the reference. Draws each chosen set, and
/// every change of one option that fits the budget.
///
/// # Errors
/// Any error of the device.
pub fn verify(
    bench: &mut Bench<'_>,
    measured: &Measured,
    count: usize,
    clock: &mut Clock<'_>,
    progress: &mut dyn FnMut(usize),
) -> Outcome<Verified> {
    let choices = bench.choices(SCENES[0], measured)?;
    let given = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
    let frame_of = |set: &[usize]| with(chosen(&choices, set));
    let mut known: Vec<(Vec<usize>, f64)> = Vec::new();
    let mut squares = |bench: &mut Bench<'_>, set: &[usize]| -> Outcome<f64> {
        if let Some((_, found)) = known.iter().find(|(own, _)| own == set) {
            return Ok(*found);
        }
        let found = bench.squares(SCENES[0], &frame_of(set))?;
        known.push((set.to_vec(), found));
        Ok(found)
    };
    let [low, high] = [given.fastest(), given.finest()].map(|set| clock(bench, &frame_of(&set), &given, &set));
    let (low, high) = (low?, high?);
    let mut offers = measured.offers(&choices, low, high);
    let mut verified = Verified { budgets: count, ..Verified::default() };
    let mut sets: Vec<Vec<usize>> = Vec::new();
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for index in 0..count {
        progress(index);
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Budgets start above the fastest frame, since no frame is faster.
        let budget = 1.1 * low + (high - 1.1 * low).max(0.0) * ((state >> 40) as f64 / (1_u64 << 24) as f64);
        let settled = settle(&mut offers, Bound::Ms(budget), |set| {
            let ms = clock(bench, &frame_of(set), &given, set)?;
            Ok::<_, Box<dyn std::error::Error>>(Trial { ms, squares: squares(bench, set)? })
        })?;
        let set = settled.chosen.options;
        verified.within += usize::from(clock(bench, &frame_of(&set), &given, &set)? <= budget);
        if sets.contains(&set) {
            continue;
        }
        let error = squares(bench, &set)?.sqrt();
        for group in 0..set.len() {
            for option in (0..choices[group].1.len()).filter(|option| *option != set[group]) {
                let mut swapped = set.clone();
                swapped[group] = option;
                if offers.predicted(&swapped).ms > budget {
                    continue;
                }
                verified.swaps += 1;
                let other = squares(bench, &swapped)?.sqrt();
                if other < 0.95 * error && clock(bench, &frame_of(&swapped), &given, &swapped)? <= budget {
                    let (group, options) = &choices[group];
                    verified.better.push(format!(
                        "{budget:.1} ms: {} `{}` errs by {other:.3} codes, the chosen set by {error:.3}",
                        group.name, options[option].name
                    ));
                }
            }
        }
        sets.push(set);
        verified.sets = sets.len();
    }
    Ok(verified)
}
