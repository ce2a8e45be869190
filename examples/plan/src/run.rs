//! Reads the input files, compiles the plan, and prints the requested output.

use crate::args::{Args, Format};
use crate::{output, queues};
use framegraph::file::{self, GraphFile, Included, Registry};
use framegraph::{Alias, Caps, Graph, Options, Plan, Scratch, diff, dump};
use framegraph_check::{Budget, golden};
use program::input;
use std::path::Path;

/// Reason for a non-zero exit code.
#[derive(Debug)]
pub enum Failure {
    /// Exceeded limits with the decisions that caused them, or the diff with the expected output.
    Assertion(String),
    /// Invalid input, one line per error.
    Input(String),
}

/// Frame size in texels if neither the file nor the command line sets one.
const FRAME: [u32; 2] = [1920, 1080];

/// Compiles, prints, and checks budgets and the expected output.
///
/// # Errors
/// Invalid input, or a failed assertion. In the second case the output is written nevertheless.
pub fn run(args: &Args, registry: &Registry<'_, Graph>) -> Result<(), Failure> {
    let source = |path: &Path| {
        let (path, text) = (path.display().to_string(), read(path)?);
        let included = Included::load(&path, &text, |path| read(Path::new(path))).map_err(|e| e.to_string())?;
        Ok((path, text, included))
    };
    let sources: Result<Vec<_>, _> =
        [Some(args.frame.as_path()), args.diff.as_deref()].into_iter().flatten().map(source).collect();
    let sources = sources.map_err(Failure::Input)?;
    let read = sources.iter().flat_map(|(path, _, included)| [path.as_str()].into_iter().chain(included.paths()));
    let device = args.caps.ends_with(".ron").then_some(args.caps.as_str());
    let costs = args.queues.as_ref().and_then(|queues| queues.costs.as_deref());
    let golden = args.golden.as_deref();
    let (made, compared) = if golden::is_updating() { (golden, None) } else { (None, golden) };
    let read = read.chain(device).map(Path::new).chain(costs).chain(args.limits.as_deref()).chain(compared);
    let outputs = output::prepare([args.out.as_deref(), made], read).map_err(Failure::Input)?;
    let limits = args.limits.as_deref().map(limits).transpose().map_err(Failure::Input)?;
    let committed = compared.map(crate::run::read).transpose().map_err(Failure::Input)?;
    let parsed = sources
        .iter()
        .map(|(path, text, included)| GraphFile::parse_with(path, text, included).map_err(|e| e.to_string()));
    let mut parsed = parsed.collect::<Result<Vec<_>, _>>().map_err(Failure::Input)?.into_iter();
    let (Some(frame), other) = (parsed.next(), parsed.next()) else { unreachable!("the frame is the first source") };
    let plan = planned(args, registry, &frame, other.as_ref()).map_err(Failure::Input)?;
    let text = match (&other, &args.queues) {
        (None, Some(own)) => queues::shown(own, args.format, &plan).map_err(Failure::Input)?,
        (None, None) => shown(&plan, frame.name(), args.format),
        (Some(other), _) => {
            let other = planned(args, registry, other, Some(&frame)).map_err(Failure::Input)?;
            differences(&plan, &other, args.format)
        }
    };
    output::write(outputs, args.out.as_deref(), made, &text).map_err(Failure::Input)?;
    let mut failed: Vec<String> = Vec::new();
    for budget in [Some(&args.budget), limits.as_ref()].into_iter().flatten() {
        failed.extend(budget.check(&plan).err().map(|error| error.to_string()));
    }
    if let (Some(path), Some(committed)) = (compared, committed) {
        let compared = golden::compare(&path.display().to_string(), &committed, &text);
        failed.extend(compared.err().map(|error| error.to_string()));
    }
    if failed.is_empty() { Ok(()) } else { Err(Failure::Assertion(failed.join("\n"))) }
}

/// Reads a file with limits.
fn limits(path: &Path) -> Result<Budget, String> {
    Budget::parse(&read(path)?).map_err(|error| format!("{}: {error}", path.display()))
}

/// Compiles the plan of one file. Each switched feature must exist in `file` or in `other`, the file it is compared
/// with.
fn planned(
    args: &Args,
    registry: &Registry<'_, Graph>,
    file: &GraphFile<'_>,
    other: Option<&GraphFile<'_>>,
) -> Result<Plan, String> {
    let knows = |file: &GraphFile<'_>, name: &str| file.features().iter().any(|(f, _)| f == name);
    let elsewhere = |name: &str| !knows(file, name) && other.is_some_and(|other| knows(other, name));
    let switches = args.switches.iter().filter(|(name, _)| !elsewhere(name));
    let switches: Vec<_> = switches.cloned().collect();
    let options = Options {
        frame: args.size_texels.or(file.frame()).unwrap_or(FRAME),
        order: args.order,
        alias: Alias::Heap,
        ..Options::default()
    };
    let (mut graph, mut plan) = (Graph::new(), Plan::new());
    let device = (&caps(&args.caps)?, &options);
    file.plan(&switches, registry, &mut graph, device, &mut Scratch::new(), &mut plan).map_err(|e| e.to_string())?;
    for warning in plan.warnings() {
        program::note(format_args!("{}: warning: {}", file.path(), warning.sentence()));
    }
    Ok(plan)
}

/// Returns the capabilities of a preset or of a device file.
fn caps(which: &str) -> Result<Caps, String> {
    if let Some(preset) = Caps::preset(which) {
        return Ok(preset);
    }
    if !which.ends_with(".ron") {
        let presets = Caps::PRESETS.join(", ");
        return Err(format!("--caps: invalid value `{which}`; expected {presets} or a FILE.ron"));
    }
    let text = read(Path::new(which))?;
    file::caps(which, &text).map_err(|e| e.to_string())
}

/// Reads a text file.
///
/// # Errors
/// One line that names the file and the reason.
pub fn read(path: &Path) -> Result<String, String> {
    input::text(path, input::MAX_TEXT_BYTES)
}

fn shown(plan: &Plan, name: &str, format: Format) -> String {
    match format {
        Format::Text => dump::text(plan),
        Format::Json => dump::json(plan, name),
        Format::Dot => dump::dot(plan),
        Format::Mermaid => dump::mermaid(plan),
        Format::Svg => dump::svg(plan),
    }
}

fn differences(before: &Plan, after: &Plan, format: Format) -> String {
    let diff = diff(before, after);
    match format {
        Format::Json => diff.json(),
        _ => diff.to_string(),
    }
}
