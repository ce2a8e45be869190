//! Reads the input files, compiles the plan, and prints the requested output.

use crate::args::{Args, Format};
use crate::{output, queues};
use framegraph::file::{self, GraphFile, Included, Registry};
use framegraph::{Alias, Caps, Graph, Options, Plan, Scratch, diff, dump};
use program::input;
use std::path::Path;

/// Reason for a non-zero exit code.
#[derive(Debug)]
pub enum Failure {
    /// Exceeded budget limits with the decisions that caused them, one line each.
    Budget(String),
    /// Invalid input, one line per error.
    Input(String),
}

/// Frame size in texels if neither the file nor the command line sets one.
const FRAME: [u32; 2] = [1920, 1080];

/// Compiles, prints, and checks the budget.
///
/// # Errors
/// Invalid input, or an exceeded budget. In the second case the output is written nevertheless.
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
    let outputs =
        output::prepare(args.out.as_deref(), read.chain(device).map(Path::new).chain(costs)).map_err(Failure::Input)?;
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
            compared(&plan, &other, args.format)
        }
    };
    output::write(outputs, args.out.as_deref(), &text).map_err(Failure::Input)?;
    match args.budget.broken(&plan) {
        None => Ok(()),
        Some(broken) => Err(Failure::Budget(broken)),
    }
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

fn compared(before: &Plan, after: &Plan, format: Format) -> String {
    let diff = diff(before, after);
    match format {
        Format::Json => diff.json(),
        _ => diff.to_string(),
    }
}
