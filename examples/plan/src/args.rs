//! Command line of `plan`.

use crate::queues;
use framegraph::{Caps, Order};
use framegraph_check::Budget;
use framegraph_queues::QueueLayout;
use program::clap::{self, ArgAction};
use program::cli::{self, Given, Parsed, argument, flag, option};
use std::ffi::OsString;
use std::path::PathBuf;

/// Options of a run that plans a frame.
#[derive(Clone, Debug)]
pub struct Args {
    /// Path of the graph file.
    pub frame: PathBuf,
    /// Name of a device preset, or path of a device file.
    pub caps: String,
    /// Frame width and height in texels; `None` for the size in the file.
    pub size_texels: Option<[u32; 2]>,
    /// Features to enable (`true`) or disable.
    pub switches: Vec<(String, bool)>,
    /// Order of passes.
    pub order: Order,
    /// Output format.
    pub format: Format,
    /// Graph file to compare with.
    pub diff: Option<PathBuf>,
    /// Limits on the cost of the plan.
    pub budget: Budget,
    /// File with further limits.
    pub limits: Option<PathBuf>,
    /// File with the expected output.
    pub golden: Option<PathBuf>,
    /// Output file; `None` for standard output.
    pub out: Option<PathBuf>,
    /// Options of the schedule on several queues.
    pub queues: Option<QueuesArgs>,
}

/// Options of `--queues`.
#[derive(Clone, Debug)]
pub struct QueuesArgs {
    /// Queue layout; `None` for the queues of the device.
    pub layout: Option<QueueLayout>,
    /// File with the costs of passes.
    pub costs: Option<PathBuf>,
}

/// Options of `--offsets`.
#[derive(Clone, Debug)]
pub struct OffsetsArgs {
    /// File with the intervals to pack.
    pub file: PathBuf,
    /// Maximum number of search steps.
    pub budget_steps: u64,
    /// Time limit of the search in seconds.
    pub seconds: Option<u32>,
    /// Output file; `None` for standard output.
    pub out: Option<PathBuf>,
}

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Complete plan as text.
    Text,
    /// JSON for other tools.
    Json,
    /// Graphviz.
    Dot,
    /// Mermaid, for browsers and code-hosting sites.
    Mermaid,
    /// SVG picture.
    Svg,
}

/// Parsed command line.
#[derive(Clone, Debug)]
pub enum Command {
    /// Print the help.
    Help(String),
    /// List plugin kinds.
    Plugins,
    /// Plan a frame.
    Plan(Box<Args>),
    /// Pack intervals.
    Offsets(OffsetsArgs),
}

/// Default of `--budget-steps`.
const BUDGET_STEPS: u64 = 150_000_000;

const ABOUT: &str = "Compiles a frame graph from a file without a GPU and prints the plan.";

const USAGE: &str = "\
plan FRAME.ron [OPTIONS]
       plan --offsets FILE.csv [--budget-steps N] [--seconds S] [--out FILE]";

const AFTER: &str = "Exit codes: 0 success, 1 budget exceeded or golden differs, 2 invalid input or output, 128 + N stopped by signal N.";

/// Returns the declaration of all options.
fn command() -> clap::Command {
    cli::command("plan", ABOUT, AFTER).override_usage(USAGE).args([
        argument("FRAME.ron", "A graph; docs/reference/graph-format.md documents its fields"),
        option(
            "caps",
            "DEVICE",
            format!("{}, or a FILE.ron that describes a device (wgpu)", Caps::PRESETS.join(", ")),
        ),
        option("size", "WxH", "Frame size in texels; default: the size in the file, else 1920x1080"),
        option("set", "FEATURE=on|off", "Enable or disable a feature of the file; repeatable").action(ArgAction::Append),
        option("order", "ORDER", "declared (default) or optimized"),
        option("format", "FORMAT", "text (default), json (docs/reference/plan-json.md), dot, mermaid or svg"),
        option(
            "diff",
            "OTHER.ron",
            "Print the changes from FRAME.ron to OTHER.ron for the same device, size and features, as text or json; a \
             feature that only one file has is set in that file",
        ),
        option(
            "budget",
            "LIMITS",
            "Exit with code 1 and list the responsible decisions if a limit is exceeded. LIMITS is NAME=MAX,... with the \
             names loads (attachments loaded from memory: unresolves), stores (attachments stored to memory: resolves), \
             multisample_resolves, full_screen_resolves, steps, culled (passes), bytes (memory of transient resources), \
             own_bytes (exports and histories), loaded_bytes, stored_bytes and traffic (both). Bytes accept B, kB, MB, GB (powers of 1000), KiB, MiB and GiB (powers of 1024): --budget \
             loads=0,stores=3,bytes=200MB",
        ),
        option(
            "assert",
            "FILE",
            "Like --budget, with limits from a file: NAME=MAX, one a line or separated by commas; # starts a comment",
        ),
        option(
            "golden",
            "FILE",
            "Exit with code 1 and print a diff unless the output equals FILE. UPDATE_GOLDENS=1 writes FILE instead",
        ),
        option(
            "queues",
            "LAYOUT",
            "Schedule the frame on several queues where that is faster: one, async-compute, async-compute-and-copy, or \
             device for the queues of --caps. Prints the queue of each step, the waits and the frame time, as text or svg",
        ),
        option(
            "costs",
            "FILE",
            "Cost of each pass for --queues, in lines `PASS,MICROSECONDS`; default: estimated from bytes",
        ),
        option("out", "FILE", "Write to FILE instead of standard output"),
        option(
            "offsets",
            "FILE.csv",
            "Pack intervals `id,lower,upper,size` (MiniMalloc's format) into one heap and print them with an `offset` \
             column. `start` and `begin` are synonyms of `lower`; `end` is an inclusive `upper`. Top and lower bound go to \
             standard error, every second during the search. A signal stops the search and prints the best offsets found \
             so far",
        )
        .conflicts_with_all(["FRAME.ron", "caps", "size", "set", "order", "format", "diff", "budget", "assert", "golden", "queues", "costs"]),
        option("budget-steps", "N", "Maximum number of search steps for --offsets (150000000)"),
        option("seconds", "S", "Time limit of the search in seconds (none)"),
        flag("plugins", "List the plugin kinds that files can name, with their slots"),
    ])
}

/// Parses the command line; `args` excludes the program name.
///
/// # Errors
/// One line that names the option and the expected value.
pub fn parse(args: impl Iterator<Item = OsString>) -> Result<Command, String> {
    let given = match cli::parse(command(), args)? {
        Parsed::Help(text) => return Ok(Command::Help(text)),
        Parsed::Given(given) => given,
    };
    if given.has("plugins") {
        return Ok(Command::Plugins);
    }
    for (name, other) in [("budget-steps", "offsets"), ("seconds", "offsets"), ("costs", "queues")] {
        if given.has(name) && !given.has(other) {
            return Err(format!("--{name}: requires --{other}"));
        }
    }
    let file = given.values("offsets").next().map(PathBuf::from);
    if let Some(file) = file {
        return offsets(file, given).map(Command::Offsets);
    }
    let mut found = Args {
        frame: PathBuf::new(),
        caps: "wgpu".into(),
        size_texels: None,
        switches: Vec::new(),
        order: Order::default(),
        format: Format::Text,
        diff: None,
        budget: Budget::default(),
        limits: None,
        golden: None,
        out: None,
        queues: None,
    };
    if !given.has("FRAME.ron") {
        return Err("FRAME.ron: missing argument; see --help".into());
    }
    let mut costs = None;
    for item in given {
        match item.name() {
            "FRAME.ron" => found.frame = item.raw().into(),
            "caps" => found.caps = item.text()?,
            "size" => found.size_texels = Some(item.parse("WxH, each from 1 to 65536 texels", size)?),
            "set" => found.switches.push(item.parse("FEATURE=on or FEATURE=off", switch)?),
            "order" => found.order = item.parse("declared or optimized", order)?,
            "format" => found.format = item.parse("text, json, dot, mermaid or svg", format)?,
            "diff" => found.diff = Some(item.raw().into()),
            "budget" => found.budget = Budget::parse(&item.text()?).map_err(|error| format!("--budget: {error}"))?,
            "assert" => found.limits = Some(item.raw().into()),
            "golden" => found.golden = Some(item.raw().into()),
            "queues" => found.queues = Some(QueuesArgs { layout: queues::layout(&item.text()?)?, costs: None }),
            "costs" => costs = Some(item.raw().into()),
            _ => found.out = Some(item.raw().into()),
        }
    }
    if let Some(queues) = &mut found.queues {
        queues.costs = costs;
        if found.diff.is_some() || !matches!(found.format, Format::Text | Format::Svg) {
            return Err("--queues: available with --format text or svg and without --diff".into());
        }
    }
    if found.diff.is_some() && !matches!(found.format, Format::Text | Format::Json) {
        return Err("--diff: requires --format text or json".into());
    }
    Ok(Command::Plan(Box::new(found)))
}

fn offsets(file: PathBuf, given: Given) -> Result<OffsetsArgs, String> {
    let mut found = OffsetsArgs { file, budget_steps: BUDGET_STEPS, seconds: None, out: None };
    for item in given {
        match item.name() {
            "budget-steps" => found.budget_steps = item.parse("a whole number of steps", |text| text.parse().ok())?,
            "seconds" => found.seconds = Some(item.parse("a whole number of seconds", |text| text.parse().ok())?),
            "out" => found.out = Some(item.raw().into()),
            _ => {}
        }
    }
    Ok(found)
}

fn order(text: &str) -> Option<Order> {
    match text {
        "declared" => Some(Order::Declared),
        "optimized" => Some(Order::Optimized),
        _ => None,
    }
}

fn format(text: &str) -> Option<Format> {
    match text {
        "text" => Some(Format::Text),
        "json" => Some(Format::Json),
        "dot" => Some(Format::Dot),
        "mermaid" => Some(Format::Mermaid),
        "svg" => Some(Format::Svg),
        _ => None,
    }
}

fn size(value: &str) -> Option<[u32; 2]> {
    let (w, h) = value.split_once('x')?;
    let side = |s: &str| s.parse().ok().filter(|side| (1..=65536).contains(side));
    Some([side(w)?, side(h)?])
}

fn switch(value: &str) -> Option<(String, bool)> {
    let (feature, state) = value.split_once('=')?;
    let on = match state {
        "on" => true,
        "off" => false,
        _ => return None,
    };
    (!feature.is_empty()).then(|| (feature.to_owned(), on))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Command, String> {
        parse(line.split_whitespace().map(OsString::from))
    }

    #[test]
    fn the_whole_command_line_is_read() {
        let line = "a.ron --caps tiler --size 640x360 --set msaa=on --set fxaa=off --order optimized \
                    --format json --diff b.ron --budget loads=0 --assert d --golden e --out c.json";
        let Ok(Command::Plan(args)) = parsed(line) else {
            panic!("the line is sound");
        };
        assert_eq!((args.frame, args.caps.as_str()), ("a.ron".into(), "tiler"));
        assert_eq!(args.size_texels, Some([640, 360]));
        assert_eq!(args.switches, [("msaa".into(), true), ("fxaa".into(), false)]);
        assert_eq!((args.order, args.format), (Order::Optimized, Format::Json));
        assert_eq!((args.limits, args.golden), (Some("d".into()), Some("e".into())));
        assert_eq!((args.diff, args.out), (Some("b.ron".into()), Some("c.json".into())));
        assert!(matches!(parsed("--help a b c"), Ok(Command::Help(_))));
        assert!(matches!(parsed("--plugins"), Ok(Command::Plugins)));
        let Ok(Command::Offsets(args)) = parsed("--offsets a.csv --budget-steps 7") else {
            panic!("the line is sound");
        };
        assert_eq!((args.file, args.budget_steps), ("a.csv".into(), 7));
    }

    #[test]
    fn every_mistake_is_one_line_that_names_it() {
        for (line, named) in [
            ("", "FRAME.ron"),
            ("a.ron b.ron", "b.ron: unexpected argument"),
            ("a.ron --capz tiler", "--capz: unknown option; did you mean `--caps`?"),
            ("a.ron -x", "-x"),
            ("a.ron --caps", "--caps"),
            ("a.ron --size 0x4", "--size 0x4: expected WxH"),
            ("a.ron --size 4", "--size 4: expected"),
            ("a.ron --size 4x99999999999", "--size"),
            ("a.ron --set msaa", "--set msaa: expected"),
            ("a.ron --set =on", "--set =on: expected"),
            ("a.ron --order best", "declared or optimized"),
            ("a.ron --format png", "--format png: expected"),
            ("a.ron --budget loads=-1", "--budget: loads"),
            ("a.ron --caps a --caps b", "--caps: specified twice"),
            ("a.ron --diff b.ron --format svg", "--diff"),
            ("a.ron --budget-steps 3", "--offsets"),
            ("a.ron --queues many", "`many`; expected device, one, async-compute"),
            ("a.ron --queues one --format dot", "--queues: available"),
            ("a.ron --costs b.csv", "--costs: requires --queues"),
            ("a.ron --offsets b.csv", "cannot be used with"),
            ("--offsets b.csv --budget-steps x", "--budget-steps x: expected"),
        ] {
            let error = parsed(line).expect_err(line);
            assert!(error.contains(named) && !error.contains('\n'), "{line}: {error}");
        }
    }
}
