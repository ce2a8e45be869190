//! Options that inspect or bisect the frame, and their output.

use crate::args::Args;
use crate::name::{short_name, with_ending};
use crate::pick;
use crate::run::{Failure, Frames, Prepared, WARM_UP, device, input, prepare, render};
use crate::table::{aligned, mebibytes};
use framegraph::{Join, Options, Plan, Scratch, compile, recompile};
use framegraph_scene::picture::{encode_exr, encode_png};
use framegraph_wgpu::debug::{Modes, Outcome, bisect};
use framegraph_wgpu::inspect::{
    DisplayImage, DisplayMode, InspectTarget, Inspection, Inspector, Request, all_targets, find,
};
use framegraph_wgpu::{Executor, ExecutorOptions, ObjectCounts, Summary, read_texture};
use program::clap::Arg;
use program::cli::{Item, flag, option};
use program::interrupt;
use program::outputs::Outputs;
use program::progress::Shown;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = vec![
        option(
            "inspect",
            "TEXTURE",
            "Write a texture of the frame: NAME[@PASS|@vN|@sN][:MIP[:LAYER]], such as hdr@color. Selects the newest \
             version, the version that a pass wrote, a version by number, or the state after a step. A second plan \
             is compiled for it; the plan of the frame is unchanged",
        ),
        option("inspect-out", "FILE", ".png to look at, .exr for exact values (inspect.png)"),
        option(
            "inspect-mode",
            "MODE",
            "auto, color[:STOPS], depth[:NEAR_M], stretch[:r|g|b|a], plain[:r|g|b|a] or false[:r|g|b|a][:LOW,HIGH]; \
             NaN and infinity are magenta (auto)",
        ),
        option("inspect-sample", "N", "Sample of a multisampled texture; default: the average, for depth the first"),
        option("inspect-all", "DIR", "Write every version of every texture as a picture"),
        option("trace", "FILE.json", "Times of every frame and step on CPU and GPU, for chrome://tracing or Perfetto"),
        flag(
            "timing",
            "Print minima, quartiles and medians, the share of wgpu, created and reused objects, memory, and the \
             latency with one to three frames queued",
        ),
        option(
            "debug",
            "MODE,...",
            "no-cull, no-merge, no-inline, no-alias, immediate (all of these, in declared order, without memoryless \
             attachments), poison (fill uninitialized memory with NaN or magenta)",
        ),
        option(
            "pick",
            "X,Y[:X,Y...]",
            "Print the frontmost opaque object at pixels, counted from the left and the top, with its number, depth \
             and position",
        ),
        flag("bisect", "Render under each debug mode and print the modes that change the picture"),
    ];
    all.into_iter().map(|option| option.help_heading("Debugging")).collect()
}

/// Options of inspection, tracing and debug modes.
#[derive(Clone, Debug)]
pub struct Debugging {
    inspect: Option<Request>,
    inspect_out: PathBuf,
    inspect_mode: DisplayMode,
    inspect_all: Option<PathBuf>,
    trace: Option<PathBuf>,
    pub timing: bool,
    modes: Modes,
    /// Compares debug modes instead of rendering a picture.
    pub bisect: bool,
    sample: Option<u8>,
    /// Pixels of which the object is printed.
    pub picks: Vec<[u32; 2]>,
}

impl Default for Debugging {
    fn default() -> Self {
        Self {
            inspect: None,
            inspect_out: PathBuf::from("inspect.png"),
            inspect_mode: DisplayMode::Auto,
            inspect_all: None,
            trace: None,
            timing: false,
            modes: Modes::default(),
            bisect: false,
            sample: None,
            picks: Vec::new(),
        }
    }
}

impl Debugging {
    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, item: &Item) -> Result<bool, String> {
        let option = format!("--{}", item.name());
        let failed = |error: &dyn std::fmt::Display| format!("{option}: {error}");
        match item.name() {
            "inspect" => self.inspect = Some(item.text()?.parse().map_err(|e| failed(&e))?),
            "inspect-out" => self.inspect_out = with_ending(item.raw().into(), &option, &["png", "exr"])?,
            "inspect-mode" => self.inspect_mode = item.text()?.parse().map_err(|e| failed(&e))?,
            "inspect-sample" => {
                self.sample = Some(item.parse("a number from 0 to 255", |text| text.parse().ok())?);
            }
            "inspect-all" => self.inspect_all = Some(item.raw().into()),
            "trace" => self.trace = Some(with_ending(item.raw().into(), &option, &["json"])?),
            "timing" => self.timing = true,
            "debug" => self.modes = item.text()?.parse().map_err(|e| failed(&e))?,
            "bisect" => self.bisect = true,
            "pick" => self.picks = pick::pixels(&item.text()?)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Applies the debug modes and enables the trace.
    pub fn apply(&self, plan: &mut Options, execute: &mut ExecutorOptions) {
        self.modes.apply(plan, execute);
        execute.trace = self.trace.is_some();
    }

    /// Resolves the textures to inspect before the frame is rendered, each with its output file.
    ///
    /// # Errors
    /// Names the unknown texture, version or subresource and lists the existing ones.
    pub fn wanted(&self, plan: &Plan) -> Result<Vec<(PathBuf, InspectTarget)>, Failure> {
        let mut wanted = Vec::new();
        if let Some(request) = &self.inspect {
            let request = Request { sample: self.sample, ..request.clone() };
            let found = find(plan, &request).map_err(|e| input(format!("--inspect {request}: {e}")))?;
            wanted.push((self.inspect_out.clone(), found));
        }
        if let Some(folder) = &self.inspect_all {
            let named = |(index, seen): (usize, InspectTarget)| {
                (folder.join(short_name(&format!("{index:03}.{}", seen.file_stem()), ".png")), seen)
            };
            wanted.extend(all_targets(plan).into_iter().enumerate().map(named));
        }
        Ok(wanted)
    }

    /// Returns the output files that are independent of the plan.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.trace.as_deref().into_iter()
    }

    /// Returns the existing folder for the pictures of all textures.
    pub fn folder(&self) -> Option<&Path> {
        self.inspect_all.as_deref()
    }
}

/// Prints and writes the results of debugging options, and returns a description of each written file.
///
/// `before` holds the object counts before the measured frames.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn report(
    args: &Args,
    prepared: &mut Prepared,
    plan: &Plan,
    executor: &Executor,
    before: ObjectCounts,
    inspections: &[(PathBuf, InspectTarget)],
    outputs: &mut Outputs,
) -> Result<Vec<(PathBuf, String)>, Failure> {
    let asked = &args.debug;
    if asked.timing {
        program::print(times(plan, executor));
        program::print(format_args!("\n{}", cpu_table(args, prepared, executor)?));
        program::line(format_args!("\n{}", made_line(args, executor, before)));
    }
    if let Some(path) = &asked.trace {
        let json = executor.timing().trace().map(framegraph_wgpu::Trace::chrome_json);
        let json = json.ok_or_else(|| device("no frame was traced"))?;
        outputs.write(path, |file| file.write_all(json.as_bytes())).map_err(input)?;
    }
    let Prepared { gpu, frame, world, imports, near_m, .. } = prepared;
    let mut inspector = Inspector::new(gpu);
    let mut notes = Vec::new();
    let mut shown = Shown::default();
    for (done, (path, seen)) in inspections.iter().enumerate() {
        let found = inspector.inspect_target(executor, plan, frame, world, imports, seen.clone());
        let found = found.map_err(|e| input(format!("{}: {e}", path.display())))?;
        notes.push((path.clone(), write_inspection(&found, asked.inspect_mode, *near_m, path, outputs)?));
        shown.step("inspecting textures", done + 1, inspections.len(), &path.display().to_string());
        interrupt::check().map_err(device)?;
    }
    shown.clear();
    Ok(notes)
}

/// Writes an inspected texture and returns its description.
fn write_inspection(
    found: &Inspection,
    mode: DisplayMode,
    near_m: f32,
    path: &Path,
    outputs: &mut Outputs,
) -> Result<String, Failure> {
    let Inspection { texels, .. } = found;
    let DisplayImage { rgba8, range: [low, high], non_finite } = texels.display(mode, near_m);
    let as_numbers = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr"));
    let written = outputs.write(path, |file| match as_numbers {
        true => encode_exr(file, texels.size, &texels.numbers()),
        false => encode_png(file, texels.size, &rgba8),
    });
    written.map_err(input)?;
    let [width, height] = texels.size;
    // `cargo xtask corpus` parses this number.
    let bad = if non_finite > 0 { format!(", {non_finite} texels not finite") } else { String::new() };
    Ok(format!(": {}, {width}x{height} {:?}, {low} to {high}{bad}", found.title(), texels.format))
}

/// Formats minimum, first quartile and median of each step and of the frame, on CPU and GPU.
fn times(plan: &Plan, executor: &Executor) -> String {
    let head = ["step", "passes", "CPU min", "p25", "median", "GPU min", "p25", "median", "frames"];
    let mut rows = vec![head.map(String::from)];
    let cells = |times: framegraph_wgpu::Times| {
        let of = |summary: Option<Summary>| {
            summary
                .map_or(["-"; 3].map(String::from), |s| [s.min_ms, s.p25_ms, s.median_ms].map(|ms| format!("{ms:.3}")))
        };
        let count = times.cpu.map_or(0, |s| s.count);
        (of(times.cpu), of(times.gpu), count.to_string())
    };
    let mut push = |step: String, passes: String, times| {
        let ([a, b, c], [d, e, f], count) = cells(times);
        rows.push([step, passes, a, b, c, d, e, f, count]);
    };
    for step in plan.step_ids() {
        let names = plan.passes_of(step).iter().map(|member| {
            let name = plan.graph().pass_name(member.pass);
            if member.join == Join::Inlined { format!("({name})") } else { name.to_owned() }
        });
        push(step.index().to_string(), names.collect::<Vec<_>>().join(" + "), executor.timing().step(step));
    }
    push("frame".into(), String::new(), executor.timing().frame());
    format!("\nmilliseconds, after warm-up\n{}", aligned(&rows, 2))
}

/// Formats the CPU time of a frame: declaring and compiling, measured here, and executing, with the share of wgpu.
fn cpu_table(args: &Args, prepared: &mut Prepared, executor: &Executor) -> Result<String, Failure> {
    const REPEATS: usize = 201;
    let caps = prepared.gpu.caps();
    let options = prepared.options(args).0;
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let mut taken = [const { Vec::new() }; 3];
    for _ in 0..REPEATS {
        let begun = Instant::now();
        let (frame, ..) = prepared.declare(args)?;
        taken[0].push(begun.elapsed());
        let begun = Instant::now();
        compile(frame.graph(), &caps, &options, &mut scratch, &mut plan).map_err(device)?;
        taken[1].push(begun.elapsed());
        let begun = Instant::now();
        recompile(frame.graph(), &caps, &options, &mut scratch, &mut plan).map_err(device)?;
        taken[2].push(begun.elapsed());
    }
    let [declared, compiled, unchanged] = taken.map(|mut all| {
        all.sort_unstable();
        all[REPEATS / 2].as_secs_f64() * 1e6
    });
    let median = |summary: Option<Summary>| summary.map_or(0.0, |s| s.median_ms * 1e3);
    let (whole, inside) = (median(executor.timing().frame().cpu), median(executor.timing().wgpu()));
    let rows = [
        ["CPU time of a frame", "median, µs"].map(String::from),
        ["declare".into(), format!("{declared:.2}")],
        ["compile".into(), format!("{compiled:.2}")],
        ["compile, unchanged".into(), format!("{unchanged:.2}")],
        ["execute".into(), format!("{whole:.2}")],
        ["inside wgpu: passes, submit, uploads, poll, error scopes".into(), format!("{inside:.2}")],
    ];
    Ok(aligned(&rows, 1))
}

/// Formats the objects that the measured frames created, and those they reused.
fn made_line(args: &Args, executor: &Executor, before: ObjectCounts) -> String {
    let made = executor.objects().since(&before);
    let rows: Vec<_> = made.rows().into_iter().map(|(name, count)| format!("{count} {name}")).collect();
    let pool = executor.texture_pool();
    let caches: Vec<_> =
        executor.caches().into_iter().map(|(name, counts)| format!("{} {name}", counts.hits)).collect();
    let mut pools = vec![("textures", pool), ("buffers", executor.buffer_pool())];
    let blocks = executor.placed_blocks();
    if blocks.created > 0 {
        pools.push(("memory blocks for placed resources", blocks));
    }
    let memory = pools.into_iter().map(|(name, pool)| {
        let [held, used, peak, budget] =
            [pool.bytes, pool.used_bytes, pool.peak_bytes, pool.budget_bytes].map(mebibytes);
        format!("{} {name}, {held} ({used} used by the last frame, peak {peak}, budget {budget})", pool.objects)
    });
    let memory: Vec<_> = memory.collect();
    format!(
        "created in {} frames: {}; reused since the start: {} textures, {}\nheld by pools: {}; by histories: {}",
        args.frames,
        rows.join(", "),
        pool.hits,
        caches.join(", "),
        memory.join(", "),
        mebibytes(executor.history_bytes())
    )
}

/// Renders with every debug mode and prints the modes that change the picture.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn run_bisect(args: &Args) -> Result<(), Failure> {
    let mut prepared = prepare(args, &mut Outputs::default())?;
    let outcomes = bisect(|mode| {
        let (mut options, mut execute) = prepared.options(args);
        mode.iter().for_each(|mode| mode.apply(&mut options, &mut execute));
        let mut plan = Plan::new();
        let mut executor = prepared.executor(args, execute)?;
        executor.compile(prepared.frame.graph(), &options, &mut Scratch::new(), &mut plan).map_err(input)?;
        render(&mut prepared, &plan, &mut executor, 0..WARM_UP, &mut Frames::new(WARM_UP))?;
        let texture = executor.texture(&plan, prepared.io.output).ok_or_else(|| device("the frame has no picture"))?;
        Ok(read_texture(&prepared.gpu, texture).map_err(device)?.rgba8())
    })?;
    let mut rows = vec![["mode", "picture", "pixels", "worst"].map(String::from)];
    rows.extend(outcomes.iter().map(|o| {
        let same = if o.is_same() { "same" } else { "different" };
        [o.name().into(), same.into(), o.pixels.to_string(), o.max_difference.to_string()]
    }));
    program::print(aligned(&rows, 2));
    match outcomes.iter().find(|o| !o.is_same()) {
        Some(first) => {
            let (name, suspect) = (Outcome::name(first), first.likely_cause());
            program::line(format_args!("{name} is the first mode that changes the picture: {suspect}"));
        }
        None => program::line("no mode changes the picture"),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(words: &[&str]) -> Result<Debugging, String> {
        let mut asked = Debugging::default();
        crate::parse::taken(options(), words, |item| asked.take(item))?;
        Ok(asked)
    }

    #[test]
    fn options_set_what_they_name() {
        let asked = taken(&["--inspect", "hdr@color:1", "--debug=no-merge,poison", "--trace", "a/t.json", "--timing"]);
        let asked = asked.expect("a sound command line");
        assert_eq!(asked.inspect, "hdr@color:1".parse().ok());
        let (mut plan, mut execute) = (Options::default(), ExecutorOptions::default());
        asked.apply(&mut plan, &mut execute);
        assert!(!plan.merge && execute.poison && execute.trace && asked.timing && !asked.bisect);
        let files: Vec<_> = asked.files().collect();
        assert_eq!(files, [Path::new("a/t.json")]);
    }

    #[test]
    fn invalid_options_are_reported() {
        let cases: [(&[&str], &str); 8] = [
            (&["--inspect", "@"], "--inspect: `@`"),
            (&["--inspect-out", "a.jpg"], "--inspect-out a.jpg: the file must end in .png or .exr"),
            (&["--inspect-mode", "sepia"], "--inspect-mode: `sepia`"),
            (&["--inspect-sample", "-1"], "--inspect-sample -1"),
            (&["--trace", "t.txt"], "--trace t.txt: the file must end in .json"),
            (&["--debug", "fast"], "--debug: `fast` is not a debug mode"),
            (&["--inspect"], "--inspect: missing TEXTURE"),
            (&["--no-such"], "--no-such: unknown"),
        ];
        for (words, named) in cases {
            let error = taken(words).expect_err("the command line is invalid");
            assert!(error.contains(named) && !error.contains('\n'), "{words:?}: {error}");
        }
    }
}
