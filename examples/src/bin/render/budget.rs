//! The frame within a budget: `--budget-ms`, `--max-error`.

use crate::args::Args;
use crate::run::{Failure, Frames, Prepared, WARM_UP, device, input, prepare, render};
use crate::table::aligned;
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::FrameSettings;
use framegraph_passes::budget::{Bound, Choices, GROUPS, Measured, Offers, Settled, Trial, reference, settle};
use framegraph_passes::facts::{Decision, Facts};
use framegraph_wgpu::read_texture;
use lexopt::Parser;
use program::input::{MOST_TEXT_BYTES, text};
use program::outputs::Outputs;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What `render --help` prints of them.
pub const HELP: &str = "
BUDGET
  --budget-ms X        the most accurate frame that takes at most X ms here: options of edges, shadows, ambient occlusion,
                       shading, precision, radiance, reflections and glass are chosen by what they were measured to take and
                       to err by, tried on this scene, and compared with the finest frame (docs/accuracy.md)
  --max-error X        the fastest frame that is no farther than X from the finest: root mean square in codes of 255
  --record FILE.json   what was measured, by `accuracy --technique budget`; without it, the record of the repository
                       (docs/accuracy.json), which was made with a software driver. With --preset, the preset's options are
                       chosen from it
";

/// What was measured in the repository.
const OWN: &str = include_str!("../../../../docs/accuracy.json");

/// What a frame is held to.
#[derive(Clone, Debug, Default)]
pub struct Budget {
    /// Time or error; none: nothing is chosen.
    pub bound: Option<Bound>,
    /// The record; none for that of the repository.
    pub record: Option<PathBuf>,
}

impl Budget {
    /// Takes an option of this file; false for others.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let mut value = || parser.value().map_err(|_| format!("--{name}: a value is missing"));
        match name {
            "budget-ms" => self.bound = Some(Bound::Ms(positive(name, &value()?.to_string_lossy())?)),
            "max-error" => self.bound = Some(Bound::Codes(positive(name, &value()?.to_string_lossy())?)),
            "record" => self.record = Some(crate::name::with_ending(value()?.into(), "--record", &["json"])?),
            _ => return Ok(false),
        }
        Ok(true)
    }
}

fn positive(name: &str, text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| *x > 0.0 && x.is_finite());
    number.ok_or_else(|| format!("--{name} {text}: a number above 0 is needed"))
}

/// Of a record, what is looked at.
#[derive(Deserialize)]
struct Record {
    schema: String,
    version: u32,
    adapter: Option<String>,
    budget: Option<Measured>,
}

/// What was measured, and on which adapter.
pub fn record(file: Option<&Path>) -> Result<(Measured, String), String> {
    let shown = file.map_or_else(|| "docs/accuracy.json".into(), |file| file.to_string_lossy());
    let told = |what: &dyn std::fmt::Display| format!("--record {shown}: {what}");
    let text = match file {
        Some(file) => &text(file, MOST_TEXT_BYTES).map_err(|error| format!("--record {error}"))?,
        None => OWN,
    };
    let Record { schema, version, adapter, budget } = serde_json::from_str(text).map_err(|error| told(&error))?;
    if (schema.as_str(), version) != ("framegraph-accuracy", 2) {
        return Err(told(&format!(
            "it is {schema} of version {version}, and framegraph-accuracy of version 2 is read"
        )));
    }
    let budget = budget.ok_or_else(|| {
        told(&"it has no `budget`; run `accuracy --technique budget` and give its record with --record")
    })?;
    Ok((budget, adapter.unwrap_or_default()))
}

/// A frame that was tried: its picture's codes, how long it took in ms, and what facts left out of it.
struct Tried {
    picture: Vec<u8>,
    ms: f64,
    facts: Facts,
}

/// Chooses the frame, says which and how it turned out, and returns the command line that has it.
///
/// # Errors
/// One line, by whose fault it is.
pub fn choose(args: &Args, bound: Bound) -> Result<Args, Failure> {
    let (measured, adapter) = record(args.budget.record.as_deref()).map_err(input)?;
    let base = args.frame();
    let finest = reference(&base);
    let truth = attempt(&args.with(&finest))?;
    let gpu = crate::run::open()?;
    let has = |option: &framegraph_passes::budget::FrameOption| {
        let mut frame = finest;
        (option.apply)(&mut frame);
        frame.settings.shading.precision.check(&gpu).is_ok()
    };
    let choices = measured.choices(&truth.facts, has).map_err(|error| input(format!("--record: {error}")))?;
    drop(gpu);
    let frame_of = |set: &[usize]| {
        let mut frame = finest;
        choices.iter().zip(set).for_each(|((_, options), index)| (options[*index].apply)(&mut frame));
        frame
    };
    let fastest = attempt(&args.with(&frame_of(&vec![0; choices.len()])))?;
    let mut offers = measured.offers(&choices, fastest.ms.min(truth.ms), truth.ms);
    let settled = settle(&mut offers, bound, |set| {
        let tried = attempt(&args.with(&frame_of(set)))?;
        Ok::<_, Failure>(Trial { ms: tried.ms, squares: squares(&tried.picture, &truth.picture) })
    })?;
    program::print(table(&choices, &offers, &settled, &truth.facts));
    program::print(verdict(bound, &settled, &adapter, truth.ms));
    Ok(args.with(&frame_of(&settled.chosen.options)))
}

/// Draws a frame as often as is measured.
fn attempt(args: &Args) -> Result<Tried, Failure> {
    let mut prepared = prepare(args, &mut Outputs::default())?;
    let (options, execute) = prepared.options(args);
    let mut plan = Plan::new();
    compile(prepared.frame.graph(), &prepared.gpu.caps(), &options, &mut Scratch::new(), &mut plan).map_err(input)?;
    let mut executor = prepared.executor(args, execute)?;
    let mut shown = Frames::new(WARM_UP + args.frames);
    let mut took = Vec::new();
    for index in 0..WARM_UP + args.frames {
        let start = Instant::now();
        render(&mut prepared, &plan, &mut executor, index..index + 1, &mut shown)?;
        took.extend((index >= WARM_UP).then(|| 1e3 * start.elapsed().as_secs_f64()));
    }
    took.sort_by(f64::total_cmp);
    let Prepared { gpu, io, facts, .. } = prepared;
    let texture = executor.texture(&plan, io.output).ok_or_else(|| device("the frame left no picture"))?;
    let picture = read_texture(&gpu, texture).map_err(device)?.rgba8();
    Ok(Tried { picture, ms: took[took.len() / 2], facts })
}

/// Mean square difference of two pictures, in codes squared; alpha is no color.
fn squares(ours: &[u8], truth: &[u8]) -> f64 {
    let pixels = ours.chunks_exact(4).zip(truth.chunks_exact(4));
    let sum: f64 = pixels.flat_map(|(a, b)| (0..3).map(|c| (f64::from(a[c]) - f64::from(b[c])).powi(2))).sum();
    sum / (0.75 * ours.len() as f64)
}

/// A line for each group: what was chosen, what it takes beyond the fastest option, and how far it alone is off.
fn table(choices: &Choices, offers: &Offers, settled: &Settled, facts: &Facts) -> String {
    let mut rows = vec![["choice", "chosen", "of", "ms", "codes"].map(String::from)];
    for group in &GROUPS {
        let own = choices.iter().position(|(own, _)| own.name == group.name);
        rows.push(match own {
            Some(at) => {
                let (index, options) = (settled.chosen.options[at], &choices[at].1);
                let offer = offers.groups[at][index];
                [
                    group.name.into(),
                    options[index].name.into(),
                    options.len().to_string(),
                    format!("{:.2}", offer.ms),
                    format!("{:.2}", offer.squares.sqrt()),
                ]
            }
            None => {
                let dropped = group.effects.iter().filter_map(|effect| facts.of(*effect));
                let why = dropped.filter(|fact| fact.decision == Decision::Dropped).map(|fact| fact.reason.as_str());
                let why = why.collect::<Vec<_>>().join("; ");
                let why = if why.is_empty() { "the scene has none".to_owned() } else { why };
                [group.name.into(), why, "0".into(), "0.00".into(), "0.00".into()]
            }
        });
    }
    aligned(&rows, 2)
}

/// What was predicted and how it turned out.
fn verdict(bound: Bound, Settled { chosen, trial, holds }: &Settled, adapter: &str, reference_ms: f64) -> String {
    let asked = match bound {
        Bound::Ms(ms) => format!("at most {ms} ms"),
        Bound::Codes(codes) => format!("at most {codes} codes"),
    };
    let kept = if *holds { "which it holds" } else { "which no frame was found to hold; this one is nearest" };
    format!(
        "predicted: {:.1} ms, {:.2} codes from the finest frame, by times of {adapter}\n\
         drawn: {:.1} ms, {:.2} codes from the finest frame, which takes {reference_ms:.1} ms; asked for {asked}, {kept}\n",
        chosen.ms,
        chosen.codes(),
        trial.ms,
        trial.squares.sqrt(),
    )
}

impl Args {
    /// The frame that the command line asks for.
    fn frame(&self) -> FrameSettings {
        let settings = framegraph_passes::Settings {
            samples: self.samples,
            shading: self.shading,
            shadows: self.shadows.asked(),
            occlusion: self.effects.occlusion,
            reflections: self.effects.reflections,
            glass_layers: self.effects.glass_layers,
            transparency: self.effects.transparency,
            fxaa: self.fxaa,
            ..self.base
        };
        FrameSettings {
            quality: self.quality,
            lights: self.lighting.lights,
            lod_error_px: self.effects.lod_error_px,
            visible_layers: self.effects.visible_layers,
            inline: self.inline,
            settings,
        }
    }

    /// The same command line with what groups are about as a frame has it.
    fn with(&self, frame: &FrameSettings) -> Self {
        let mut args = self.clone();
        let settings = frame.settings;
        (args.quality, args.shading) = (frame.quality, settings.shading);
        (args.samples, args.fxaa) = (settings.samples, settings.fxaa);
        args.shadows.hold(settings.shadows);
        args.effects.occlusion = settings.occlusion;
        args.effects.reflections = settings.reflections;
        args.effects.glass_layers = settings.glass_layers;
        args.base.hdr_format = settings.hdr_format;
        args.trial = true;
        args
    }
}
