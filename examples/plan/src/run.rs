//! From files to a plan, and from the plan to what was asked for.

use crate::args::{Args, Format};
use crate::output;
use framegraph::file::{self, GraphFile, Included, Registry};
use framegraph::{Alias, Caps, Graph, Options, Plan, Scratch, diff, dump};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Why there is nothing to show for it.
#[derive(Debug)]
pub enum Failure {
    /// A budget is broken: the decisions to blame, a line each.
    Budget(String),
    /// Bad input: a line an error.
    Input(String),
}

/// The frame size when neither the file nor the command line says one, in texels.
const FRAME: [u32; 2] = [1920, 1080];

/// Files larger than this are refused, in bytes.
const MOST_BYTES: u64 = 64 << 20;

/// Plans, prints, and checks the budget.
///
/// # Errors
/// Bad input, or a broken budget; the output is written in the second case.
pub fn run(args: &Args, registry: &Registry<'_, Graph>) -> Result<(), Failure> {
    let device = Path::new(&args.caps);
    let inputs = [Some(args.frame.as_path()), args.diff.as_deref(), args.caps.ends_with(".ron").then_some(device)];
    let outputs = output::prepare(args.out.as_deref(), inputs.into_iter().flatten()).map_err(Failure::Input)?;
    let text = read(&args.frame).map_err(Failure::Input)?;
    let shown_path = args.frame.display().to_string();
    let includes = included(&shown_path, &text).map_err(Failure::Input)?;
    let frame = GraphFile::parse_with(&shown_path, &text, &includes).map_err(|e| Failure::Input(e.to_string()))?;
    let other = args.diff.as_deref().map(|path| {
        let (path, text) = (path.display().to_string(), read(path)?);
        let included = included(&path, &text)?;
        Ok((path, text, included))
    });
    let other = other.transpose().map_err(Failure::Input)?;
    let other = other
        .as_ref()
        .map(|(path, text, included)| GraphFile::parse_with(path, text, included).map_err(|e| e.to_string()));
    let other = other.transpose().map_err(Failure::Input)?;
    let plan = planned(args, registry, &frame, other.as_ref()).map_err(Failure::Input)?;
    let text = match &other {
        None => shown(&plan, frame.name(), args.format),
        Some(other) => {
            compared(&plan, &planned(args, registry, other, Some(&frame)).map_err(Failure::Input)?, args.format)
        }
    };
    output::write(outputs, args.out.as_deref(), &text).map_err(Failure::Input)?;
    match args.budget.broken(&plan) {
        None => Ok(()),
        Some(broken) => Err(Failure::Budget(broken)),
    }
}

/// The plan of one file. A feature that is switched must be known here, or to the file that this one is compared with.
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
<<<<<<< HEAD
        program::note(format_args!("{}: warning: {}", file.path(), warning.sentence()));
=======
        program::note(format_args!("{}: warning: {}", args.frame.display(), warning.sentence()));
>>>>>>> programs
    }
    Ok(plan)
}

/// The files that a file includes.
fn included(path: &str, text: &str) -> Result<Included, String> {
    Included::load(path, text, |path| read(Path::new(path))).map_err(|e| e.to_string())
}

/// A preset, or the device that a file describes.
fn caps(which: &str) -> Result<Caps, String> {
    if let Some(preset) = Caps::preset(which) {
        return Ok(preset);
    }
    if !which.ends_with(".ron") {
        let presets = Caps::PRESETS.join(", ");
        return Err(format!("--caps: `{which}` is neither {presets} nor a FILE.ron"));
    }
    let text = read(Path::new(which))?;
    file::caps(which, &text).map_err(|e| e.to_string())
}

/// The text of a file.
///
/// # Errors
/// One line that names the file and what is wrong with it.
pub fn read(path: &Path) -> Result<String, String> {
    let shown = path.display();
    let unreadable = |e: std::io::Error| format!("{shown}: cannot be read: {e}");
    // Some files have no end, and say that they have no length.
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("{shown}: more than {MOST_BYTES} bytes; files of that size are not read"));
    }
    String::from_utf8(bytes).map_err(|e| {
        let before = &e.as_bytes()[..e.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|b| **b == b'\n').count();
        format!("{shown}:{line}:1: the line is not UTF-8; save the file as UTF-8")
    })
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
