//! Frame within a budget: `--budget-ms` and `--max-error`.

use crate::args::Args;
use crate::run::{Failure, Frames, Prepared, WARM_UP, device, input, prepare, render};
use crate::table::aligned;
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::FrameSettings;
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::feature_culling::{Decision, Facts};
use framegraph_passes::quality::{
    Bound, Choices, GROUPS, Measured, Offers, Settled, Trial, guaranteed, reference, settle,
};
use framegraph_wgpu::read_texture;
use program::clap::Arg;
use program::cli::{Item, flag, option};
use program::input::{MAX_TEXT_BYTES, text};
use program::outputs::Outputs;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = vec![
        option(
            "budget-ms",
            "X",
            "Choose the most accurate frame within X ms on this device. Candidates for edges, shadows, ambient \
             occlusion, shading, precision, HDR format, reflections and glass come from measured costs and errors \
             (docs/measurements/accuracy.md), and are verified on this scene against the reference frame",
        ),
        option(
            "max-error",
            "X",
            "Choose the fastest frame whose root-mean-square error against the reference frame is at most X 8-bit \
             steps",
        ),
        flag(
            "guaranteed",
            "With --max-error, choose only among options whose error is proved to be small in this scene, and print the \
             proofs. The limit then holds for every channel of every pixel",
        ),
        option(
            "record",
            "FILE.json",
            "Measurements of `accuracy --technique budget`; default: docs/measurements/accuracy.json, measured with \
             a software driver. With --preset, the options of the preset are chosen from it",
        ),
    ];
    all.into_iter().map(|option| option.help_heading("Budget")).collect()
}

/// Measurements committed to the repository.
const OWN: &str = include_str!("../../../../docs/measurements/accuracy.json");

/// Limit of the frame and the measurements to choose from.
#[derive(Clone, Debug, Default)]
pub struct Budget {
    /// Time or error limit; `None` disables the search.
    pub bound: Option<Bound>,
    /// Accepts only proved errors.
    pub guaranteed: bool,
    /// Record of measurements; `None` for the record of the repository.
    pub record: Option<PathBuf>,
}

impl Budget {
    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, item: &Item) -> Result<bool, String> {
        let positive = |text: &str| text.parse::<f64>().ok().filter(|x| *x > 0.0 && x.is_finite());
        match item.name() {
            "budget-ms" => self.bound = Some(Bound::Ms(item.parse("a number above 0", positive)?)),
            "max-error" => self.bound = Some(Bound::Codes(item.parse("a number above 0", positive)?)),
            "guaranteed" => self.guaranteed = true,
            "record" => self.record = Some(crate::name::with_ending(item.raw().into(), "--record", &["json"])?),
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// Fields of a record file that the search reads.
#[derive(Deserialize)]
struct Record {
    schema: String,
    version: u32,
    adapter: Option<String>,
    budget: Option<Measured>,
}

/// Reads a record: the measurements and the name of the measured adapter.
pub fn record(file: Option<&Path>) -> Result<(Measured, String), String> {
    let shown = file.map_or_else(|| "docs/measurements/accuracy.json".into(), |file| file.to_string_lossy());
    let failed = |what: &dyn std::fmt::Display| format!("--record {shown}: {what}");
    let text = match file {
        Some(file) => &text(file, MAX_TEXT_BYTES).map_err(|error| format!("--record {error}"))?,
        None => OWN,
    };
    let Record { schema, version, adapter, budget } = serde_json::from_str(text).map_err(|error| failed(&error))?;
    if (schema.as_str(), version) != ("framegraph-accuracy", 2) {
        return Err(failed(&format!(
            "unsupported schema {schema} version {version}; expected framegraph-accuracy version 2"
        )));
    }
    let budget = budget.ok_or_else(|| {
        failed(&"missing `budget`; run `accuracy --technique budget` and pass its record to --record")
    })?;
    Ok((budget, adapter.unwrap_or_default()))
}

/// Result of a candidate frame: its picture, its time in milliseconds, and the dropped effects.
pub struct Candidate {
    pub picture: Vec<u8>,
    ms: f64,
    facts: Facts,
}

/// Chooses the frame, prints the choice and the verified result, and returns the resulting command line.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn choose(args: &Args, bound: Bound) -> Result<Args, Failure> {
    let (measured, adapter) = record(args.budget.record.as_deref()).map_err(input)?;
    let base = args.frame();
    let finest = reference(&base);
    let truth = draw_candidate(&args.with(&finest))?;
    let gpu = crate::run::open()?;
    let has = |option: &framegraph_passes::quality::FrameOption| {
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
    if let (true, Bound::Codes(steps)) = (args.budget.guaranteed, bound) {
        return prove(args, &measured, &choices, steps);
    }
    let fastest = draw_candidate(&args.with(&frame_of(&vec![0; choices.len()])))?;
    let mut offers = measured.offers(&choices, fastest.ms.min(truth.ms), truth.ms);
    let settled = settle(&mut offers, bound, |set| {
        let candidate = draw_candidate(&args.with(&frame_of(set)))?;
        Ok::<_, Failure>(Trial { ms: candidate.ms, squares: squares(&candidate.picture, &truth.picture) })
    })?;
    program::print(table(&choices, &offers, &settled, &truth.facts));
    program::print(verdict(bound, &settled, &adapter, truth.ms));
    Ok(args.with(&frame_of(&settled.chosen.options)))
}

/// Chooses the fastest set whose error is proved to be at most `max_steps`, and prints its proofs.
fn prove(args: &Args, measured: &Measured, choices: &Choices, max_steps: f64) -> Result<Args, Failure> {
    let finest = reference(&args.frame());
    let mut prepared = prepare(&args.with(&finest), &mut Outputs::default())?;
    let offers = measured.offers(choices, measured.fastest_ms, measured.reference_ms);
    let Prepared { culling, loaded, world, seen, asked, .. } = &mut prepared;
    let found = guaranteed(
        &FrameSettings { settings: *asked, ..finest },
        choices,
        &offers,
        max_steps,
        &mut |settings, kept| {
            culling.keeping(kept).facts(loaded, &world.lighting.image, seen, settings, Measurement::Off)
        },
    );
    let mut rows = vec![["group", "chosen", "proof", "steps"].map(String::from)];
    for (group, option, bound) in &found.bounds {
        rows.push([(*group).into(), (*option).into(), bound.proof.clone(), format!("{:.2}", bound.steps)]);
    }
    program::print(aligned(&rows, 3));
    program::line(format_args!(
        "proved: every channel of every pixel is within {:.2} 8-bit steps of the finest frame, with rounding; limit: \
         {max_steps}; groups without a row keep the finest option",
        found.steps
    ));
    let mut frame = finest;
    found.apply(&mut frame);
    Ok(args.with(&frame))
}

/// Renders a frame and returns its median time.
pub fn draw_candidate(args: &Args) -> Result<Candidate, Failure> {
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
    let texture = executor.texture(&plan, io.output).ok_or_else(|| device("the frame has no picture"))?;
    let picture = read_texture(&gpu, texture).map_err(device)?.rgba8();
    Ok(Candidate { picture, ms: took[took.len() / 2], facts })
}

/// Mean squared difference of the color channels, in squared 8-bit steps.
pub fn squares(ours: &[u8], truth: &[u8]) -> f64 {
    let pixels = ours.chunks_exact(4).zip(truth.chunks_exact(4));
    let sum: f64 = pixels.flat_map(|(a, b)| (0..3).map(|c| (f64::from(a[c]) - f64::from(b[c])).powi(2))).sum();
    sum / (0.75 * ours.len() as f64)
}

/// Root mean square difference of the color channels, in 8-bit steps.
pub fn rms(ours: &[u8], truth: &[u8]) -> f64 {
    squares(ours, truth).sqrt()
}

/// Formats a row for each group: the chosen option, its cost over the fastest option, and its error alone.
fn table(choices: &Choices, offers: &Offers, settled: &Settled, facts: &Facts) -> String {
    let mut rows = vec![["group", "chosen", "of", "ms", "error"].map(String::from)];
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
                let why = if why.is_empty() { "not in the scene".to_owned() } else { why };
                [group.name.into(), why, "0".into(), "0.00".into(), "0.00".into()]
            }
        });
    }
    aligned(&rows, 2)
}

/// Formats the predicted and the measured result.
fn verdict(bound: Bound, Settled { chosen, trial, holds }: &Settled, adapter: &str, reference_ms: f64) -> String {
    let asked = match bound {
        Bound::Ms(ms) => format!("at most {ms} ms"),
        Bound::Codes(codes) => format!("at most {codes} 8-bit steps"),
    };
    let kept = if *holds { "met" } else { "not met by any candidate frame; this one is nearest" };
    format!(
        "predicted: {:.1} ms, error {:.2} 8-bit steps, from times measured on {adapter}\n\
         measured: {:.1} ms, error {:.2} 8-bit steps against the reference frame, which takes {reference_ms:.1} ms\n\
         limit: {asked}, {kept}\n",
        chosen.ms,
        chosen.codes(),
        trial.ms,
        trial.squares.sqrt(),
    )
}

impl Args {
    /// Returns the frame settings of the command line.
    pub fn frame(&self) -> FrameSettings {
        let settings = framegraph_passes::Settings { shadows: self.shadows.asked(), ..self.frame.settings };
        FrameSettings { settings, ..self.frame }
    }

    /// Returns the command line with the settings of `frame` that the search chooses.
    pub fn with(&self, frame: &FrameSettings) -> Self {
        let mut args = self.clone();
        let (own, chosen) = (&mut args.frame.settings, frame.settings);
        (own.samples, own.fxaa, own.shading) = (chosen.samples, chosen.fxaa, chosen.shading);
        (own.occlusion, own.reflections, own.glass_layers) =
            (chosen.occlusion, chosen.reflections, chosen.glass_layers);
        own.hdr_format = chosen.hdr_format;
        args.frame.quality = frame.quality;
        args.shadows.hold(chosen.shadows);
        args.trial = true;
        args
    }
}
