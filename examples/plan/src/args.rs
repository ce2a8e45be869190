//! The command line of `plan`.

use crate::queues;
use framegraph::Order;
use framegraph_queues::QueueLayout;
use lexopt::{Arg, Parser, ValueExt};
use program::budget::Budget;
use std::ffi::OsString;
use std::path::PathBuf;

/// What `plan --help` prints.
pub const HELP: &str = "\
Plans a frame from a file, without a GPU.

usage: plan FRAME.ron [options]
       plan --offsets FILE.csv [--budget-steps N] [--seconds S] [--out FILE]

FRAME.ron is a graph; docs/graph-format.md documents its fields.

  --caps WHICH        desktop, tiler, wgpu (default), or a FILE.ron that describes a device
  --size WxH          size of the frame in texels; default: what the file says, else 1920x1080
  --set FEATURE=on|off
                      switches a feature of the file; may be given several times
  --order WHICH       declared (default) or optimized
  --format WHICH      text (default), json (docs/plan-json.md), dot, mermaid or svg
  --diff OTHER.ron    what changes from FRAME to OTHER, both for the same device, size and features (of which each takes
                      those that it knows); text or json
  --budget LIMITS     exit with 1 and the decisions to blame when a limit is passed: NAME=MOST,... with the names
                        loads     attachments loaded from memory (unresolves)
                        stores    attachments stored to memory (resolves)
                        steps     steps
                        culled    culled passes
                        bytes     memory that transient resources take
                        traffic   bytes loaded and stored
                      and B, kB, MB, GB (powers of 1000), KiB, MiB or GiB (of 1024) behind bytes:
                        --budget loads=0,stores=3,bytes=200MB
  --queues LAYOUT     runs the frame on several queues where that is shorter: one, async-compute, async-compute-and-copy,
                      or device for those that --caps has;
                      prints what runs where, what waits for what, and the frame's time; text or svg
  --costs FILE        what each pass costs there: lines `PASS,MICROSECONDS`; default: by the bytes that it touches
  --out FILE          where to write; default: standard output
  --offsets FILE.csv  packs intervals `id,lower,upper,size` into one heap and prints `id,lower,upper,size,offset`;
                      (MiniMalloc's form; an `end` in the place of `upper` is the last step itself, `start` and `begin`
                      are `lower`); the top and the bound go to standard error, every second while the search goes on. A
                      signal ends it, and the best offsets so far are printed
  --plugins           prints the kinds of plugins that files can name here, with their slots
  --budget-steps N    steps that the search for offsets may take (150000000)
  --seconds S         seconds that it may take; default: until the steps are taken
  --help              this text

Exit codes: 0 done, 1 a budget is broken, 2 bad input or output, 128 and its number after a signal.
";

/// What was asked for.
#[derive(Clone, Debug)]
pub struct Args {
    /// The graph.
    pub frame: PathBuf,
    /// A preset or a file.
    pub caps: String,
    /// Width and height in texels.
    pub size_texels: Option<[u32; 2]>,
    /// Features with what they are set to.
    pub switches: Vec<(String, bool)>,
    /// In which order passes run.
    pub order: Order,
    /// The form of the output.
    pub format: Format,
    /// The graph to compare with.
    pub diff: Option<PathBuf>,
    /// What the plan may cost.
    pub budget: Budget,
    /// Where to write.
    pub out: Option<PathBuf>,
    /// The frame on several queues.
    pub queues: Option<QueuesArgs>,
}

/// What `--queues` was asked for.
#[derive(Clone, Debug)]
pub struct QueuesArgs {
    /// The queues; none for those of the device.
    pub layout: Option<QueueLayout>,
    /// The costs of passes.
    pub costs: Option<PathBuf>,
}

/// What `--offsets` was asked for.
#[derive(Clone, Debug)]
pub struct OffsetsArgs {
    /// The intervals.
    pub file: PathBuf,
    /// Steps of the search.
    pub budget_steps: u64,
    /// Seconds of the search.
    pub seconds: Option<u32>,
    /// Where to write.
    pub out: Option<PathBuf>,
}

/// The form of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Everything in words.
    Text,
    /// For other tools.
    Json,
    /// For Graphviz.
    Dot,
    /// For browsers and forges.
    Mermaid,
    /// A picture.
    Svg,
}

/// What the command line comes to.
#[derive(Clone, Debug)]
pub enum Command {
    /// Print the help.
    Help,
    /// Print the kinds of plugins.
    Plugins,
    /// Plan a frame.
    Plan(Box<Args>),
    /// Pack intervals.
    Offsets(OffsetsArgs),
}

/// The options as they were given.
#[derive(Debug, Default)]
struct Given {
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

/// Steps of the search for offsets when nothing is said.
const BUDGET_STEPS: u64 = 150_000_000;

/// Reads the command line; `args` without the program's name.
///
/// # Errors
/// One line that names the option and what it takes.
pub fn parse(args: impl Iterator<Item = OsString>) -> Result<Command, String> {
    let mut parser = Parser::from_args(args);
    let mut given = Given::default();
    while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
        let option = match &arg {
            Arg::Long(name) => (*name).to_owned(),
            Arg::Short(letter) => {
                return Err(format!("there is no option `-{letter}`; see --help"));
            }
            Arg::Value(value) => {
                let value = PathBuf::from(value);
                set(&mut given.frame, value, "FRAME.ron")?;
                continue;
            }
        };
        if option == "help" {
            return Ok(Command::Help);
        }
        if option == "plugins" {
            return Ok(Command::Plugins);
        }
        take(&mut parser, &option, &mut given)?;
    }
    finish(given)
}

/// Reads the value of one option.
fn take(parser: &mut Parser, option: &str, given: &mut Given) -> Result<(), String> {
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
        return Err(format!("there is no option `--{option}`; see --help"));
    }
    let value = parser.value().map_err(|_| format!("--{option} needs a value; see --help"))?;
    if matches!(option, "diff" | "out" | "offsets" | "costs") {
        let place = match option {
            "diff" => &mut given.diff,
            "out" => &mut given.out,
            "costs" => &mut given.costs,
            _ => &mut given.offsets,
        };
        return set(place, value.into(), &format!("--{option}"));
    }
    let value = value.string().map_err(|_| format!("--{option}: the value is not UTF-8"))?;
    let wrong = |takes: &str| format!("--{option}: `{value}` is not {takes}");
    let name = format!("--{option}");
    match option {
        "caps" => set(&mut given.caps, value, &name),
        "size" => {
            let size = size(&value).ok_or_else(|| wrong("WxH with 1 to 65536 texels each way"))?;
            set(&mut given.size_texels, size, &name)
        }
        "set" => {
            given.switches.push(switch(&value).ok_or_else(|| wrong("FEATURE=on or FEATURE=off"))?);
            Ok(())
        }
        "order" => {
            let order = match value.as_str() {
                "declared" => Order::Declared,
                "optimized" => Order::Optimized,
                _ => return Err(wrong("declared or optimized")),
            };
            set(&mut given.order, order, &name)
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
            set(&mut given.format, format, &name)
        }
        "budget" => {
            let budget = Budget::parse(&value).map_err(|e| format!("--budget: {e}"))?;
            set(&mut given.budget, budget, &name)
        }
        "queues" => set(&mut given.queues, queues::layout(&value)?, &name),
        "seconds" => {
            let seconds = value.parse().map_err(|_| wrong("a whole number of seconds"))?;
            set(&mut given.seconds, seconds, &name)
        }
        _ => {
            let steps = value.parse().map_err(|_| wrong("a whole number of steps"))?;
            set(&mut given.budget_steps, steps, &name)
        }
    }
}

/// Refuses a second value.
fn set<T>(place: &mut Option<T>, value: T, name: &str) -> Result<(), String> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(format!("{name} is given twice")),
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

/// Checks what goes together.
fn finish(given: Given) -> Result<Command, String> {
    let Given { frame, caps, size_texels, switches, order, format, diff, budget, out, offsets, queues, costs, .. } =
        given;
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
        if let Some((_, other)) = alone.into_iter().find(|(given, _)| *given) {
            return Err(format!("{other} does not go together with --offsets"));
        }
        let budget_steps = given.budget_steps.unwrap_or(BUDGET_STEPS);
        return Ok(Command::Offsets(OffsetsArgs { file, budget_steps, seconds: given.seconds, out }));
    }
    for (given, name) in [(given.budget_steps.is_some(), "--budget-steps"), (given.seconds.is_some(), "--seconds")] {
        if given {
            return Err(format!("{name} goes together with --offsets only"));
        }
    }
    let format = format.unwrap_or(Format::Text);
    if costs.is_some() && queues.is_none() {
        return Err("--costs goes together with --queues only".into());
    }
    if queues.is_some() && (diff.is_some() || !matches!(format, Format::Text | Format::Svg)) {
        return Err("--queues prints --format text or svg, of one frame".into());
    }
    if diff.is_some() && !matches!(format, Format::Text | Format::Json) {
        return Err("--diff prints --format text or json".into());
    }
    Ok(Command::Plan(Box::new(Args {
        frame: frame.ok_or("FRAME.ron is missing; see --help")?,
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
            ("a.ron b.ron", "FRAME.ron is given twice"),
            ("a.ron --capz tiler", "--capz"),
            ("a.ron -x", "-x"),
            ("a.ron --caps", "--caps"),
            ("a.ron --size 0x4", "--size: `0x4`"),
            ("a.ron --size 4", "--size: `4`"),
            ("a.ron --size 4x99999999999", "--size"),
            ("a.ron --set msaa", "--set: `msaa`"),
            ("a.ron --set =on", "--set: `=on`"),
            ("a.ron --order best", "declared or optimized"),
            ("a.ron --format png", "--format: `png`"),
            ("a.ron --budget loads=-1", "--budget: loads"),
            ("a.ron --caps a --caps b", "--caps is given twice"),
            ("a.ron --diff b.ron --format svg", "--diff"),
            ("a.ron --budget-steps 3", "--offsets"),
            ("a.ron --queues many", "`many` is not device, one, async-compute"),
            ("a.ron --queues one --format dot", "--queues prints"),
            ("a.ron --costs b.csv", "--costs goes together with --queues"),
            ("a.ron --offsets b.csv", "FRAME.ron does not go together"),
            ("--offsets b.csv --budget-steps x", "--budget-steps: `x`"),
        ] {
            let error = parsed(line).expect_err(line);
            assert!(error.contains(named) && !error.contains('\n'), "{line}: {error}");
        }
    }
}
