//! Command line of `accuracy`.

use framegraph_passes::quality::Bound;
use framegraph_scene::builtin;
use lexopt::prelude::*;
use std::path::PathBuf;

/// Text of `--help`.
pub const HELP: &str = "\
Measures the error and cost of each approximation of the frame on this adapter.

    accuracy [--quick] [--technique NAME]… [--scene NAME] [--again] [--out DIR]
    accuracy [--out DIR] --budget-ms MS | --max-error X | --verify N
    accuracy [--out DIR] --document | --presets FILE.rs | --errors

Writes accuracy.json after each technique, so that an interrupted run can resume,
then accuracy.md and accuracy.html. Each option is timed in 31 frames after 10
warm-up frames. Times are valid for this adapter only, on an otherwise idle machine.

  --quick            pictures of 96 × 64 pixels instead of 192 × 128, 11 timed
                     frames after 3 warm-up frames
  --technique NAME   measure only this technique again; can be repeated.
                     `budget` measures options as parts of one frame
  --scene NAME       use this built-in scene for all pictures, instead of a scene
                     that shows the technique
  --again            measure everything again
  --out DIR          output folder (target/accuracy)
  --budget-ms MS     print the most accurate settings within this time, by the
                     record
  --max-error X      print the fastest settings whose root mean square error is at
                     most X 8-bit steps, by the record
  --verify N         choose settings for N random budgets, then draw and time them
                     and each change of one option; fails if budgets are missed
  --document         print accuracy.md from the existing accuracy.json
  --presets FILE.rs  write the presets chosen from the record as the source file
                     that `framegraph-passes` is built with
  --errors           measure the errors of the options for budgets again, and
                     keep their times in accuracy.json
  -h, --help         print this help
";

/// Options that apply only to measuring.
const MEASURING: [&str; 4] = ["quick", "technique", "scene", "again"];

/// Action to perform.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// Print the help.
    Help,
    /// Measure techniques.
    Measure,
    /// Print the record as a document.
    Document,
    /// Measure the errors of options for budgets again.
    Errors,
    /// Write the presets as Rust source.
    Presets(PathBuf),
    /// Choose settings within a budget of time or error.
    Budget(Bound),
    /// Choose settings for this many random budgets, and draw them.
    Verify(usize),
}

/// Parsed options.
#[derive(Clone, Debug, PartialEq)]
pub struct Args {
    /// Action to perform.
    pub wanted: Wanted,
    /// True for the short run.
    pub quick: bool,
    /// True to measure recorded techniques again.
    pub again: bool,
    /// Names of techniques; all if empty.
    pub techniques: Vec<String>,
    /// Scene of all pictures; if `None`, each technique uses its own.
    pub scene: Option<&'static str>,
    /// Output folder.
    pub out: PathBuf,
}

impl Args {
    /// Parses the command line.
    ///
    /// # Errors
    /// The option that is wrong, as one sentence.
    pub fn parse() -> Result<Self, lexopt::Error> {
        Self::of(lexopt::Parser::from_env())
    }

    fn of(mut parser: lexopt::Parser) -> Result<Self, lexopt::Error> {
        let mut args = Self {
            wanted: Wanted::Measure,
            quick: false,
            again: false,
            techniques: Vec::new(),
            scene: None,
            out: PathBuf::from("target/accuracy"),
        };
        let mut given: Vec<String> = Vec::new();
        while let Some(arg) = parser.next()? {
            if let Long(name) = arg {
                given.push(name.to_owned());
            }
            match arg {
                Long("quick") => args.quick = true,
                Long("again") => args.again = true,
                Long("technique") => args.techniques.push(parser.value()?.string()?),
                Long("out") => args.out = parser.value()?.into(),
                Long("budget-ms") => {
                    args.wanted = Wanted::Budget(Bound::Ms(positive(&parser.value()?.string()?)?));
                }
                Long("max-error") => {
                    args.wanted = Wanted::Budget(Bound::Codes(positive(&parser.value()?.string()?)?));
                }
                Long("verify") => args.wanted = Wanted::Verify(parser.value()?.parse()?),
                Long("scene") => args.scene = Some(scene(&parser.value()?.string()?)?),
                Long("document") => args.wanted = Wanted::Document,
                Long("errors") => args.wanted = Wanted::Errors,
                Long("presets") => args.wanted = Wanted::Presets(parser.value()?.into()),
                Long("help") | Short('h') => args.wanted = Wanted::Help,
                other => return Err(other.unexpected()),
            }
        }
        let other =
            |among: &[&str]| given.iter().filter(|name| among.contains(&name.as_str())).cloned().collect::<Vec<_>>();
        let (kinds, of_measuring) =
            (other(&["budget-ms", "max-error", "verify", "document", "presets", "errors"]), other(&MEASURING));
        match (&kinds[..], &of_measuring[..]) {
            _ if args.wanted == Wanted::Help => {}
            ([kind, second, ..], _) => {
                return Err(format!("--{second} cannot be combined with --{kind}: a run does one of them").into());
            }
            ([kind], [option, ..]) => {
                return Err(format!("--{option} cannot be combined with --{kind}, which measures nothing").into());
            }
            _ => {}
        }
        Ok(args)
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| *x >= 0.0 && x.is_finite());
    number.ok_or_else(|| format!("{text:?} is not a number of at least 0"))
}

fn scene(name: &str) -> Result<&'static str, String> {
    let known = builtin::NAMES.into_iter().find(|known| *known == name);
    known.ok_or_else(|| format!("--scene {name}: unknown built-in scene; known are {}", builtin::NAMES.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_that_would_do_nothing_are_refused() {
        let parsed = |line: &str| Args::of(lexopt::Parser::from_args(line.split_whitespace()));
        for (line, named) in [
            ("--document --presets a.rs", "--presets cannot be combined with --document"),
            ("--max-error 3 --budget-ms 9", "--budget-ms cannot be combined with --max-error"),
            ("--document --quick", "--quick cannot be combined with --document"),
            ("--scene glass --verify 3", "--scene cannot be combined with --verify"),
        ] {
            let told = parsed(line).map_err(|told| told.to_string());
            assert!(told.as_ref().is_err_and(|told| told.starts_with(named)), "{line}: {told:?}");
        }
        for line in
            ["--quick --technique budget --technique fog --again", "--verify 3 --out d", "--document --quick --help"]
        {
            assert!(parsed(line).is_ok(), "{line}");
        }
    }
}
