//! Command line of `plan`.

use crate::queues;
use framegraph::Order;
use framegraph_queues::QueueLayout;
use lexopt::{Arg, Parser, ValueExt};
use program::budget::Budget;
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
    Help,
    /// List plugin kinds.
    Plugins,
    /// Plan a frame.
    Plan(Box<Args>),
    /// Pack intervals.
    Offsets(OffsetsArgs),
}

/// Options as specified, before defaults apply.
#[derive(Debug, Default)]
struct ExplicitOptions {
    frame: Option<PathBuf>,
    caps: Option<String>,
    size_texels: Option<[u32; 2]>,
    switches: Vec<(String, bool)>,
    order: Option<Order>,
    format: Option<Format>,
    diff: Option<PathBuf>,
    budget: Option<Budget>,
    out: Option<PathBuf>,
    offsets: Option<PathBuf>,
    budget_steps: Option<u64>,
    seconds: Option<u32>,
    queues: Option<Option<QueueLayout>>,
    costs: Option<PathBuf>,
}

/// Default of `--budget-steps`.
const BUDGET_STEPS: u64 = 150_000_000;

/// Parses the command line; `args` excludes the program name.
///
/// # Errors
/// One line that names the option and the expected value.
pub fn parse(args: impl Iterator<Item = OsString>) -> Result<Command, String> {
    let mut parser = Parser::from_args(args);
    let mut explicit = ExplicitOptions::default();
    while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
        let option = match &arg {
            Arg::Long(name) => (*name).to_owned(),
            Arg::Short(letter) => {
                return Err(format!("unknown option `-{letter}`; see --help"));
            }
            Arg::Value(value) => {
                let value = PathBuf::from(value);
                set(&mut explicit.frame, value, "FRAME.ron")?;
                continue;
            }
        };
        if option == "help" {
            return Ok(Command::Help);
        }
        if option == "plugins" {
            return Ok(Command::Plugins);
        }
        take(&mut parser, &option, &mut explicit)?;
    }
    finish(explicit)
}

/// Parses the value of one option.
fn take(parser: &mut Parser, option: &str, explicit: &mut ExplicitOptions) -> Result<(), String> {
    const KNOWN: [&str; 13] = [
        "caps",
        "size",
        "set",
        "order",
        "format",
        "diff",
        "budget",
        "out",
        "offsets",
        "budget-steps",
        "seconds",
        "queues",
        "costs",
    ];
    if !KNOWN.contains(&option) {
        return Err(format!("unknown option `--{option}`; see --help"));
    }
    let value = parser.value().map_err(|_| format!("--{option}: missing value; see --help"))?;
    if matches!(option, "diff" | "out" | "offsets" | "costs") {
        let place = match option {
            "diff" => &mut explicit.diff,
            "out" => &mut explicit.out,
            "costs" => &mut explicit.costs,
            _ => &mut explicit.offsets,
        };
        return set(place, value.into(), &format!("--{option}"));
    }
    let value = value.string().map_err(|_| format!("--{option}: the value is not UTF-8"))?;
    let wrong = |expected: &str| format!("--{option}: invalid value `{value}`; expected {expected}");
    let name = format!("--{option}");
    match option {
        "caps" => set(&mut explicit.caps, value, &name),
        "size" => {
            let size = size(&value).ok_or_else(|| wrong("WxH, each from 1 to 65536 texels"))?;
            set(&mut explicit.size_texels, size, &name)
        }
        "set" => {
            explicit.switches.push(switch(&value).ok_or_else(|| wrong("FEATURE=on or FEATURE=off"))?);
            Ok(())
        }
        "order" => {
            let order = match value.as_str() {
                "declared" => Order::Declared,
                "optimized" => Order::Optimized,
                _ => return Err(wrong("declared or optimized")),
            };
            set(&mut explicit.order, order, &name)
        }
        "format" => {
            let format = match value.as_str() {
                "text" => Format::Text,
                "json" => Format::Json,
                "dot" => Format::Dot,
                "mermaid" => Format::Mermaid,
                "svg" => Format::Svg,
                _ => return Err(wrong("text, json, dot, mermaid or svg")),
            };
            set(&mut explicit.format, format, &name)
        }
        "budget" => {
            let budget = Budget::parse(&value).map_err(|e| format!("--budget: {e}"))?;
            set(&mut explicit.budget, budget, &name)
        }
        "queues" => set(&mut explicit.queues, queues::layout(&value)?, &name),
        "seconds" => {
            let seconds = value.parse().map_err(|_| wrong("a whole number of seconds"))?;
            set(&mut explicit.seconds, seconds, &name)
        }
        _ => {
            let steps = value.parse().map_err(|_| wrong("a whole number of steps"))?;
            set(&mut explicit.budget_steps, steps, &name)
        }
    }
}

/// Stores a value and rejects a second one.
fn set<T>(place: &mut Option<T>, value: T, name: &str) -> Result<(), String> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(format!("{name}: specified twice; remove one")),
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

/// Checks combinations of options and applies defaults.
fn finish(explicit: ExplicitOptions) -> Result<Command, String> {
    let ExplicitOptions {
        frame,
        caps,
        size_texels,
        switches,
        order,
        format,
        diff,
        budget,
        out,
        offsets,
        queues,
        costs,
        ..
    } = explicit;
    if let Some(file) = offsets {
        let alone = [
            (frame.is_some(), "FRAME.ron"),
            (caps.is_some(), "--caps"),
            (size_texels.is_some(), "--size"),
            (!switches.is_empty(), "--set"),
            (order.is_some(), "--order"),
            (format.is_some(), "--format"),
            (diff.is_some(), "--diff"),
            (budget.is_some(), "--budget"),
            (queues.is_some(), "--queues"),
            (costs.is_some(), "--costs"),
        ];
        if let Some((_, other)) = alone.into_iter().find(|(present, _)| *present) {
            return Err(format!("{other}: not available with --offsets; remove one of both"));
        }
        let budget_steps = explicit.budget_steps.unwrap_or(BUDGET_STEPS);
        return Ok(Command::Offsets(OffsetsArgs { file, budget_steps, seconds: explicit.seconds, out }));
    }
    for (present, name) in
        [(explicit.budget_steps.is_some(), "--budget-steps"), (explicit.seconds.is_some(), "--seconds")]
    {
        if present {
            return Err(format!("{name}: requires --offsets"));
        }
    }
    let format = format.unwrap_or(Format::Text);
    if costs.is_some() && queues.is_none() {
        return Err("--costs: requires --queues".into());
    }
    if queues.is_some() && (diff.is_some() || !matches!(format, Format::Text | Format::Svg)) {
        return Err("--queues: available with --format text or svg and without --diff".into());
    }
    if diff.is_some() && !matches!(format, Format::Text | Format::Json) {
        return Err("--diff: requires --format text or json".into());
    }
    Ok(Command::Plan(Box::new(Args {
        frame: frame.ok_or("FRAME.ron: missing argument; see --help")?,
        caps: caps.unwrap_or_else(|| "wgpu".into()),
        size_texels,
        switches,
        order: order.unwrap_or_default(),
        format,
        diff,
        budget: budget.unwrap_or_default(),
        out,
        queues: queues.map(|layout| QueuesArgs { layout, costs }),
    })))
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
                    --format json --diff b.ron --budget loads=0 --out c.json";
        let Ok(Command::Plan(args)) = parsed(line) else {
            panic!("the line is sound");
        };
        assert_eq!((args.frame, args.caps.as_str()), ("a.ron".into(), "tiler"));
        assert_eq!(args.size_texels, Some([640, 360]));
        assert_eq!(args.switches, [("msaa".into(), true), ("fxaa".into(), false)]);
        assert_eq!((args.order, args.format), (Order::Optimized, Format::Json));
        assert_eq!((args.diff, args.out), (Some("b.ron".into()), Some("c.json".into())));
        assert!(matches!(parsed("--help a b c"), Ok(Command::Help)));
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
            ("a.ron b.ron", "FRAME.ron: specified twice"),
            ("a.ron --capz tiler", "--capz"),
            ("a.ron -x", "-x"),
            ("a.ron --caps", "--caps"),
            ("a.ron --size 0x4", "--size: invalid value `0x4`"),
            ("a.ron --size 4", "--size: invalid value `4`"),
            ("a.ron --size 4x99999999999", "--size"),
            ("a.ron --set msaa", "--set: invalid value `msaa`"),
            ("a.ron --set =on", "--set: invalid value `=on`"),
            ("a.ron --order best", "declared or optimized"),
            ("a.ron --format png", "--format: invalid value `png`"),
            ("a.ron --budget loads=-1", "--budget: loads"),
            ("a.ron --caps a --caps b", "--caps: specified twice"),
            ("a.ron --diff b.ron --format svg", "--diff"),
            ("a.ron --budget-steps 3", "--offsets"),
            ("a.ron --queues many", "`many`; expected device, one, async-compute"),
            ("a.ron --queues one --format dot", "--queues: available"),
            ("a.ron --costs b.csv", "--costs: requires --queues"),
            ("a.ron --offsets b.csv", "FRAME.ron: not available"),
            ("--offsets b.csv --budget-steps x", "--budget-steps: invalid value `x`"),
        ] {
            let error = parsed(line).expect_err(line);
            assert!(error.contains(named) && !error.contains('\n'), "{line}: {error}");
        }
    }
}
