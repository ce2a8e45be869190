//! Options that look into the frame or bisect it, and what they print and write.

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
use lexopt::Parser;
use program::interrupt;
use program::outputs::Outputs;
use program::progress::Shown;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What `render --help` prints of them.
pub const HELP: &str = "
  --inspect WHAT       look at a texture of the frame: NAME[@PASS|@vN|@sN][:MIP[:LAYER]], such as hdr@color: the newest
                       version, that of a pass, by number, or after a step; a second plan is made for that, the frame's
                       own stays as it is
  --inspect-out FILE   .png to look at, .exr for the numbers (inspect.png)
  --inspect-mode MODE  auto, color[:STOPS], depth[:NEAR_M], stretch[:r|g|b|a], plain[:r|g|b|a] or
                       false[:r|g|b|a][:LOW,HIGH]; what is not finite is magenta (auto)
  --inspect-sample N   one sample of a multisampled texture; default: the average, of depth the first
  --inspect-all DIR    every version of every texture as a picture
  --trace FILE.json    every frame with its steps on CPU and GPU, for chrome://tracing or Perfetto
  --timing             a table of least times, quartiles and medians, wgpu's share, what was made and found, and memory;
                       and latency, with one to three frames queued
  --debug MODE,...     no-cull, no-merge, no-inline, no-alias, immediate (all of these, in declared order, nothing
                       memoryless), poison (what nobody wrote is NaN or magenta)
  --pick X,Y[:X,Y...]  print what opaque object the picture shows at a pixel from the left and the top, with its number, depth
                       and position
  --bisect             render under each debug mode, and say which changes the picture
";

/// What was asked for.
#[derive(Clone, Debug)]
pub struct Debugging {
    inspect: Option<Request>,
    inspect_out: PathBuf,
    inspect_mode: DisplayMode,
    inspect_all: Option<PathBuf>,
    trace: Option<PathBuf>,
    pub timing: bool,
    modes: Modes,
    /// Compare debug modes instead of rendering a picture.
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
    /// Takes the option `--name`, if it is one of these.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let option = format!("--{name}");
        let mut text = || {
            let value = parser.value().map_err(|_| format!("{option}: a value is missing"))?;
            value.into_string().map_err(|v| format!("{option} {v:?}: the value is not Unicode"))
        };
        let told = |error: &dyn std::fmt::Display| format!("{option}: {error}");
        match name {
            "inspect" => self.inspect = Some(text()?.parse().map_err(|e| told(&e))?),
            "inspect-out" => self.inspect_out = with_ending(text()?.into(), &option, &["png", "exr"])?,
            "inspect-mode" => self.inspect_mode = text()?.parse().map_err(|e| told(&e))?,
            "inspect-sample" => {
                let given = text()?;
                self.sample = Some(given.parse().map_err(|_| format!("{option} {given}: a small number is needed"))?);
            }
            "inspect-all" => self.inspect_all = Some(PathBuf::from(text()?)),
            "trace" => self.trace = Some(with_ending(text()?.into(), &option, &["json"])?),
            "timing" => self.timing = true,
            "debug" => self.modes = text()?.parse().map_err(|e| told(&e))?,
            "bisect" => self.bisect = true,
            "pick" => self.picks = pick::pixels(&text()?)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Sets what the modes and the trace need.
    pub fn apply(&self, plan: &mut Options, execute: &mut ExecutorOptions) {
        self.modes.apply(plan, execute);
        execute.trace = self.trace.is_some();
    }

    /// What is to be looked at, before any work is done, with the file that each goes to.
    ///
    /// # Errors
    /// When there is no such texture, version or part; the line says what there is.
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

    /// The files that will be written, whatever the plan is.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.trace.as_deref().into_iter()
    }

    /// The folder that pictures go into: it must be there.
    pub fn folder(&self) -> Option<&Path> {
        self.inspect_all.as_deref()
    }
}

/// Prints and writes what was asked for beside the picture; `before` is what had been made before the measured frames.
/// Returns what there is to say of each file.
///
/// # Errors
/// One line, by whose fault it is.
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
        let json = json.ok_or_else(|| device("no frame was written down"))?;
        outputs.write(path, |file| file.write_all(json.as_bytes())).map_err(input)?;
    }
    let Prepared { gpu, frame, world, imports, near_m, .. } = prepared;
    let mut inspector = Inspector::new(gpu);
    let mut told = Vec::new();
    let mut shown = Shown::default();
    for (done, (path, seen)) in inspections.iter().enumerate() {
        let found = inspector.inspect_target(executor, plan, frame, world, imports, seen.clone());
        let found = found.map_err(|e| input(format!("{}: {e}", path.display())))?;
        told.push((path.clone(), write_inspection(&found, asked.inspect_mode, *near_m, path, outputs)?));
        shown.step("inspecting textures", done + 1, inspections.len(), &path.display().to_string());
        interrupt::check().map_err(device)?;
    }
    shown.clear();
    Ok(told)
}

/// Writes what was seen, and returns what there is to say of it.
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
    let bad = if non_finite > 0 { format!(", {non_finite} texels not finite") } else { String::new() };
    Ok(format!(": {}, {width}x{height} {:?}, {low} to {high}{bad}", found.title(), texels.format))
}

/// Least, first quartile and median of each step and of the frame, on both sides.
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
    format!("\nmilliseconds, after warming up\n{}", aligned(&rows, 2))
}

/// What the CPU does in a frame: the graph's part, measured here, and the executor's with wgpu's share.
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
        ["a frame on the CPU", "median, us"].map(String::from),
        ["declare".into(), format!("{declared:.2}")],
        ["compile".into(), format!("{compiled:.2}")],
        ["compile, unchanged".into(), format!("{unchanged:.2}")],
        ["execute".into(), format!("{whole:.2}")],
        ["of which inside wgpu: passes, submit, uploads, poll, error scopes".into(), format!("{inside:.2}")],
    ];
    Ok(aligned(&rows, 1))
}

/// What the measured frames made, and what they found made.
fn made_line(args: &Args, executor: &Executor, before: ObjectCounts) -> String {
    let made = executor.objects().since(&before);
    let rows: Vec<_> = made.rows().into_iter().map(|(name, count)| format!("{count} {name}")).collect();
    let pool = executor.texture_pool();
    let caches: Vec<_> =
        executor.caches().into_iter().map(|(name, counts)| format!("{} {name}", counts.hits)).collect();
    let mut pools = vec![("textures", pool), ("buffers", executor.buffer_pool())];
    let blocks = executor.placed_blocks();
    if blocks.created > 0 {
        pools.push(("blocks of memory in which they are placed", blocks));
    }
    let memory = pools.into_iter().map(|(name, pool)| {
        let [held, used, peak, budget] =
            [pool.bytes, pool.used_bytes, pool.peak_bytes, pool.budget_bytes].map(mebibytes);
        format!(
            "{} {name}, {held} ({used} used by the last frame, at most {peak} so far, budget {budget})",
            pool.objects
        )
    });
    let memory: Vec<_> = memory.collect();
    format!(
        "made in {} frames: {}; found made since the beginning: {} textures, {}\nheld by the pools: {}; by histories: {}",
        args.frames,
        rows.join(", "),
        pool.hits,
        caches.join(", "),
        memory.join(", "),
        mebibytes(executor.history_bytes())
    )
}

/// Renders under every mode and prints which changes the picture.
///
/// # Errors
/// One line, by whose fault it is.
pub fn run_bisect(args: &Args) -> Result<(), Failure> {
    let mut prepared = prepare(args, &mut Outputs::default())?;
    let outcomes = bisect(|mode| {
        let (mut options, mut execute) = prepared.options(args);
        mode.iter().for_each(|mode| mode.apply(&mut options, &mut execute));
        let mut plan = Plan::new();
        let mut executor = prepared.executor(args, execute)?;
        executor.compile(prepared.frame.graph(), &options, &mut Scratch::new(), &mut plan).map_err(input)?;
        render(&mut prepared, &plan, &mut executor, 0..WARM_UP, &mut Frames::new(WARM_UP))?;
        let texture = executor.texture(&plan, prepared.io.output).ok_or_else(|| device("the frame left no picture"))?;
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
            program::line(format_args!("{name} is the first to change the picture: {suspect}"));
        }
        None => program::line("no mode changes the picture"),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    fn taken(words: &[&str]) -> Result<Debugging, String> {
        let mut asked = Debugging::default();
        let mut parser = Parser::from_args(words.iter().map(OsString::from));
        while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
            let lexopt::Arg::Long(name) = arg else { return Err("no option".into()) };
            let name = name.to_owned();
            if !asked.take(&name, &mut parser)? {
                return Err(format!("--{name}: unknown"));
            }
        }
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
    fn wrong_words_are_named() {
        let cases: [(&[&str], &str); 8] = [
            (&["--inspect", "@"], "--inspect: `@`"),
            (&["--inspect-out", "a.jpg"], "--inspect-out a.jpg: the file must end in .png or .exr"),
            (&["--inspect-mode", "sepia"], "--inspect-mode: `sepia`"),
            (&["--inspect-sample", "-1"], "--inspect-sample -1"),
            (&["--trace", "t.txt"], "--trace t.txt: the file must end in .json"),
            (&["--debug", "fast"], "--debug: `fast` is not a debug mode"),
            (&["--inspect"], "--inspect: a value is missing"),
            (&["--no-such"], "--no-such: unknown"),
        ];
        for (words, named) in cases {
            let error = taken(words).expect_err("the command line is wrong");
            assert!(error.contains(named) && !error.contains('\n'), "{words:?}: {error}");
        }
    }
}
