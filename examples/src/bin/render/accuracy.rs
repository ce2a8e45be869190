//! Accuracy of a frame: `--explain-error` and `--compare-with`.

use crate::args::{self, Args, Command};
use crate::budget::{draw_candidate, rms, squares};
use crate::run::{Failure, Frames, Prepared, WARM_UP, device, input, prepare, render};
use crate::table::aligned;
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::FrameSettings;
use framegraph_passes::quality::{Group, reference};
use framegraph_scene::picture::encode_png;
use framegraph_wgpu::{Executor, read_texture};
use program::clap::Arg;
use program::cli::{OPTIONS, option};
use program::outputs::{Outputs, check_folder};
use std::ffi::OsString;
use std::path::Path;
use std::time::Instant;

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = [
        option(
            "explain-error",
            "DIR",
            "Estimate the error of this frame by source (edges, shadows, ambient occlusion, tables, half floats, …): \
             print a table, and write a heat map of each source into the existing folder DIR",
        ),
        option(
            "compare-with",
            OPTIONS,
            "Compare time and error with this frame under other options, for example --ao sao:quality=high; both are \
             drawn alternately on this device",
        ),
    ];
    all.into_iter().map(|option| option.help_heading("Budget")).collect()
}

/// Source of error: its name, and a function that copies its finest settings into a frame.
type Source = (&'static str, fn(&FrameSettings, &mut FrameSettings));

fn finest(name: &str, frame: &mut FrameSettings) {
    let options = Group::of(name).map_or(&[][..], |group| group.options);
    options.iter().last().into_iter().for_each(|option| (option.apply)(frame));
}

const SOURCES: [Source; 9] = [
    ("anti-aliasing", |_, frame| finest("edges", frame)),
    ("sun-shadows", |_, frame| finest("sun-shadows", frame)),
    ("ambient-occlusion", |_, frame| finest("occlusion", frame)),
    ("shading-terms", |finest, frame| {
        let precision = frame.settings.shading.precision;
        frame.settings.shading = finest.settings.shading;
        frame.settings.shading.precision = precision;
    }),
    ("harmonics-and-tables", |finest, frame| frame.quality = finest.quality),
    ("half-floats", |_, frame| finest("precision", frame)),
    ("radiance-format", |_, frame| finest("radiance", frame)),
    ("reflections", |_, frame| finest("reflections", frame)),
    ("glass-layers", |_, frame| finest("glass-layers", frame)),
];

/// Prints the error of each source and writes heat maps. The error of a source is the root mean square difference
/// between the frame and the same frame with the finest option of this source alone. Sources interact, so the sum
/// of squares differs from the total, which is the difference from the finest frame.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn explain(args: &Args, folder: &Path) -> Result<(), Failure> {
    check_folder(folder).map_err(|error| input(format!("--explain-error: {error}")))?;
    let mut outputs = Outputs::default();
    let own = args.frame();
    let best = reference(&own);
    let picture = |frame: &FrameSettings| Ok::<_, Failure>(draw_candidate(&args.with(frame))?.picture);
    let (ours, truth) = (picture(&own)?, picture(&best)?);
    let mut rows = vec![["source", "error", "share of squares", "greatest"].map(String::from)];
    let total = squares(&ours, &truth);
    let mut sum = 0.0;
    let mut found = Vec::new();
    for (name, refine) in SOURCES {
        let mut refined = own;
        refine(&best, &mut refined);
        let better = if refined == own { ours.clone() } else { picture(&refined)? };
        sum += squares(&ours, &better);
        found.push((name, better));
    }
    found.sort_by(|a, b| squares(&ours, &b.1).total_cmp(&squares(&ours, &a.1)));
    found.push(("all, against the finest frame", truth));
    for (name, better) in &found {
        let most = ours.iter().zip(better).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        let share = if sum > 0.0 { 100.0 * squares(&ours, better) / sum } else { 0.0 };
        rows.push([(*name).into(), format!("{:.2}", rms(&ours, better)), format!("{share:.0} %"), most.to_string()]);
        if most > 0 {
            let file = folder.join(format!("error-{}.png", name.split(',').next().unwrap_or(name)));
            let heat = heat_map(&ours, better);
            outputs.write(&file, |file| encode_png(file, args.size_px, &heat)).map_err(input)?;
        }
    }
    program::print(aligned(&rows, 1));
    program::line(format_args!(
        "errors are root mean squares in 8-bit steps; the root of the sum of squares is {:.2}, the total {:.2}; heat \
         maps show black for 0, red for 4, yellow for 12 and white for 32 steps or more",
        sum.sqrt(),
        total.sqrt()
    ));
    for path in outputs.commit().map_err(input)? {
        program::line(format_args!("wrote {}", path.display()));
    }
    Ok(())
}

/// Returns the difference of two pictures as colors: black, red, yellow, white at 0, 4, 12 and 32 steps.
fn heat_map(ours: &[u8], truth: &[u8]) -> Vec<u8> {
    let stops = [(0.0, [0.0, 0.0, 0.0]), (4.0, [200.0, 0.0, 0.0]), (12.0, [255.0, 220.0, 0.0]), (32.0, [255.0; 3])];
    let color = |(a, b): (&[u8], &[u8])| {
        let steps = (0..3).map(|c| f64::from(a[c].abs_diff(b[c]))).fold(0.0, f64::max).min(32.0);
        let at = stops.iter().position(|stop| steps <= stop.0).unwrap_or(3).max(1);
        let ([from, to], [low, high]) = ([stops[at - 1].0, stops[at].0], [stops[at - 1].1, stops[at].1]);
        let share = (steps - from) / (to - from);
        let [r, g, b] = [0, 1, 2].map(|c| (low[c] + share * (high[c] - low[c])).round() as u8);
        [r, g, b, 255]
    };
    ours.chunks_exact(4).zip(truth.chunks_exact(4)).flat_map(color).collect()
}

/// A frame that is drawn repeatedly.
struct Side {
    prepared: Prepared,
    plan: Plan,
    executor: Executor,
    times_ms: Vec<f64>,
}

impl Side {
    fn new(args: &Args) -> Result<Self, Failure> {
        let prepared = prepare(args, &mut Outputs::default())?;
        let (options, execute) = prepared.options(args);
        let mut plan = Plan::new();
        let caps = prepared.gpu.caps();
        compile(prepared.frame.graph(), &caps, &options, &mut Scratch::new(), &mut plan).map_err(input)?;
        let executor = prepared.executor(args, execute)?;
        Ok(Self { prepared, plan, executor, times_ms: Vec::new() })
    }

    fn picture(&self) -> Result<Vec<u8>, Failure> {
        let texture = self.executor.texture(&self.plan, self.prepared.io.output);
        let texture = texture.ok_or_else(|| device("the frame has no picture"))?;
        Ok(read_texture(&self.prepared.gpu, texture).map_err(device)?.rgba8())
    }

    /// Returns the median with the 95 % interval from ranks, which assumes no distribution of times.
    fn median(&mut self) -> [f64; 3] {
        self.times_ms.sort_by(f64::total_cmp);
        let count = self.times_ms.len() as f64;
        let at = |rank: f64| self.times_ms[(rank.round().max(0.0) as usize).min(self.times_ms.len() - 1)];
        let aside = 0.98 * count.sqrt();
        [at(0.5 * (count - 1.0)), at(0.5 * count - aside - 1.0), at(0.5 * count + aside)]
    }
}

/// Draws the frame and the frame with other options alternately, at least 31 times each, and prints both times and errors.
///
/// # Errors
/// An input or device failure with a one-line message; invalid options in `other`.
pub fn compare(args: &Args, other: &str) -> Result<(), Failure> {
    let asked = other_frame(args, other).map_err(input)?;
    let truth = draw_candidate(&args.with(&reference(&args.frame())))?.picture;
    let quiet = |args: &Args| Args { trial: true, ..args.clone() };
    let mut sides = [Side::new(args)?, Side::new(&quiet(&asked))?];
    let rounds = WARM_UP + args.frames.max(31);
    let mut shown = Frames::new(2 * rounds);
    for round in 0..rounds {
        for turn in 0..2 {
            let side = &mut sides[(turn + round as usize) % 2];
            let begun = Instant::now();
            render(&mut side.prepared, &side.plan, &mut side.executor, round..round + 1, &mut shown)?;
            side.times_ms.extend((round >= WARM_UP).then(|| 1e3 * begun.elapsed().as_secs_f64()));
        }
    }
    let [ours, theirs] = [sides[0].picture()?, sides[1].picture()?];
    let [a, b] = [sides[0].median(), sides[1].median()];
    let mut rows = vec![["frame", "median ms", "95 % interval", "error"].map(String::from)];
    for (name, [median, low, high], picture) in [("as given", a, &ours), (other, b, &theirs)] {
        let interval = format!("{low:.2} to {high:.2}");
        rows.push([name.into(), format!("{median:.2}"), interval, format!("{:.3}", rms(picture, &truth))]);
    }
    program::print(aligned(&rows, 1));
    let apart = ours.iter().zip(&theirs).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    let times = if a[1] > b[2] || b[1] > a[2] {
        format!("{other}: {:+.2} ms ({:+.1} %)", b[0] - a[0], 100.0 * (b[0] / a[0] - 1.0))
    } else {
        "the times are not distinguishable: their intervals overlap".into()
    };
    program::line(format_args!(
        "{times}; the pictures differ by {:.3} 8-bit steps (root mean square), {apart} at most; errors are against the \
         finest frame of this scene",
        rms(&ours, &theirs)
    ));
    Ok(())
}

/// Parses the frame to compare with. Pictures of another size, scene or camera are not comparable.
///
/// # Errors
/// One line that names the invalid option.
fn other_frame(args: &Args, other: &str) -> Result<Args, String> {
    let mut words = exchanged(&args.words, other);
    // Options that conflict with --compare-with conflict with it in `other` too.
    words.push("--compare-with=".into());
    let asked = match args::parse(words) {
        Ok(Command::Render(asked)) => *asked,
        Ok(Command::Help(_)) => return Err("--compare-with: help is not an option of a frame".into()),
        Err(error) => return Err(format!("--compare-with {other}: {error}")),
    };
    let views = [
        ("--size", args.size_px == asked.size_px),
        ("SCENE", args.scene == asked.scene),
        ("--camera", (&args.camera, args.camera_from_gltf) == (&asked.camera, asked.camera_from_gltf)),
    ];
    match views.iter().find(|(_, same)| !same) {
        Some((name, _)) => Err(format!("--compare-with {other}: {name} differs; both frames need the same one")),
        None => Ok(asked),
    }
}

/// Returns the command line with the options of `other` instead of their earlier values, and without `--compare-with`.
fn exchanged(words: &[OsString], other: &str) -> Vec<OsString> {
    let more: Vec<&str> = other.split_whitespace().collect();
    let named = |word: &str| word.starts_with("--").then(|| word.split('=').next().unwrap_or(word).to_owned());
    // Names, each with true if its value is another word.
    let mut replaced = vec![("--compare-with".to_owned(), true)];
    for (at, word) in more.iter().enumerate() {
        let separate = word.contains('=') || more.get(at + 1).is_some_and(|next| !next.starts_with("--"));
        replaced.extend(named(word).map(|name| (name, separate)));
    }
    let mut kept = Vec::new();
    let mut rest = words.iter();
    while let Some(word) = rest.next() {
        let text = word.to_string_lossy();
        match replaced.iter().find(|(name, _)| named(&text).as_ref() == Some(name)) {
            Some((_, true)) if !text.contains('=') => drop(rest.next()),
            Some(_) => {}
            None => kept.push(word.clone()),
        }
    }
    kept.extend(more.into_iter().map(OsString::from));
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_options_replace_those_of_the_command_line() {
        let words = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        let made = |line: &str, other: &str| exchanged(&words(line), other);
        let line = "spheres --ao sao --compare-with x --no-fxaa --size=9x9";
        assert_eq!(made(line, "--ao gtao"), words("spheres --no-fxaa --size=9x9 --ao gtao"));
        assert_eq!(made(line, "--size 8x8 --no-fxaa"), words("spheres --ao sao --size 8x8 --no-fxaa"));
        assert_eq!(made("spheres --ao gtao", "--ao=sao"), words("spheres --ao=sao"));
    }

    #[test]
    fn both_frames_show_the_same_view() {
        let checked = |line: &str, other: &str| {
            let words = line.split(' ').map(OsString::from).chain([format!("--compare-with={other}").into()]);
            match args::parse(words) {
                Ok(Command::Render(args)) => other_frame(&args, other).map(|asked| asked.frame.settings.fxaa),
                other => panic!("{line}: {other:?}"),
            }
        };
        assert_eq!(checked("spheres --size 9x9", "--no-fxaa --size=9x9"), Ok(false));
        for (other, named) in [
            ("--size 8x8", "--size differs"),
            ("columns", "columns: unexpected argument"),
            ("--camera orbit", "--camera differs"),
            ("--out a.png", "--out: cannot be used with --compare-with"),
            ("--help", "help is not an option"),
        ] {
            let found = checked("spheres --size 9x9", other);
            assert!(found.as_ref().is_err_and(|error| error.contains(named)), "{other}: {found:?}");
        }
        let found = checked("--size 9x9", "columns");
        assert!(found.as_ref().is_err_and(|error| error.contains("SCENE differs")), "{found:?}");
    }

    #[test]
    fn heat_maps_show_differences() {
        let map = heat_map(&[0, 0, 0, 255, 9, 9, 9, 255, 0, 0, 0, 255], &[0, 0, 0, 255, 9, 13, 9, 255, 99, 0, 0, 255]);
        assert_eq!(map, [0, 0, 0, 255, 200, 0, 0, 255, 255, 255, 255, 255]);
    }
}
