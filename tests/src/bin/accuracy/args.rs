//! The command line of `accuracy`.

use framegraph_passes::budget::Bound;
use framegraph_scene::builtin;
use lexopt::prelude::*;
use std::path::PathBuf;

/// What `--help` prints.
pub const HELP: &str = "\
Measures what each approximation of the frame errs by and costs on this adapter.

    accuracy [--quick] [--technique NAME]… [--scene NAME] [--again] [--out DIR]
    accuracy [--out DIR] --budget-ms MS | --max-error CODES | --verify N
    accuracy [--out DIR] --document | --presets FILE.rs

Writes accuracy.json after each technique (an interrupted run goes on where it
was), then accuracy.md and accuracy.html. Each option is timed 31 times after 10
that do not count. Times say something about this adapter alone; nothing else
should run beside it.

  --quick            pictures of 96 × 64 pixels instead of 192 × 128, each
                     option timed 11 times after 3 that do not count
  --technique NAME   only this one, measured anew; may be given several times.
                     `budget` is what options take as parts of one frame
  --scene NAME       a built-in scene for all pictures, instead of one that calls
                     for what is compared
  --again            measure all anew
  --out DIR          where to; target/accuracy without it
  --budget-ms MS     of what was measured, the most accurate frame in that time
  --max-error CODES  the fastest frame that is no farther from the reference,
                     root mean square in codes of 255
  --verify N         choose for N random budgets, draw and time what was chosen,
                     and each swap of one option: must the chosen frames fit?
  --document         print accuracy.md of the accuracy.json that is there
  --presets FILE.rs  write what presets have, chosen from the record, as the source
                     text that `framegraph-passes` is built with
  -h, --help         print this
";

/// What says how and what is measured.
const MEASURING: [&str; 4] = ["quick", "technique", "scene", "again"];

/// What to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// Print how it is called.
    Help,
    /// Measure.
    Measure,
    /// Print the document of the record.
    Document,
    /// Write what presets have, as source text.
    Presets(PathBuf),
    /// Choose within a time or an error.
    Budget(Bound),
    /// Choose for so many random budgets, and draw what was chosen.
    Verify(usize),
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Args {
    /// What to do.
    pub wanted: Wanted,
    /// The short run.
    pub quick: bool,
    /// Whether what is there is measured anew.
    pub again: bool,
    /// Names; all where there are none.
    pub techniques: Vec<String>,
    /// Scene of all pictures; none for that of each technique.
    pub scene: Option<&'static str>,
    /// Folder.
    pub out: PathBuf,
}

impl Args {
    /// From the command line.
    ///
    /// # Errors
    /// In a sentence.
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
                Long("presets") => args.wanted = Wanted::Presets(parser.value()?.into()),
                Long("help") | Short('h') => args.wanted = Wanted::Help,
                other => return Err(other.unexpected()),
            }
        }
        let other =
            |among: &[&str]| given.iter().filter(|name| among.contains(&name.as_str())).cloned().collect::<Vec<_>>();
        let (kinds, of_measuring) =
            (other(&["budget-ms", "max-error", "verify", "document", "presets"]), other(&MEASURING));
        match (&kinds[..], &of_measuring[..]) {
            _ if args.wanted == Wanted::Help => {}
            ([kind, second, ..], _) => {
                return Err(format!("--{second} does not go together with --{kind}: a run does one of both").into());
            }
            ([kind], [option, ..]) => {
                return Err(format!("--{option} does not go together with --{kind}: nothing is measured anew").into());
            }
            _ => {}
        }
        Ok(args)
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| *x >= 0.0 && x.is_finite());
    number.ok_or_else(|| format!("{text:?} is no number from 0 on"))
}

fn scene(name: &str) -> Result<&'static str, String> {
    let known = builtin::NAMES.into_iter().find(|known| *known == name);
    known.ok_or_else(|| {
        format!("--scene {name}: there is no such built-in scene; there are {}", builtin::NAMES.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_that_would_do_nothing_are_refused() {
        let parsed = |line: &str| Args::of(lexopt::Parser::from_args(line.split_whitespace()));
        for (line, named) in [
            ("--document --presets a.rs", "--presets does not go together with --document"),
            ("--max-error 3 --budget-ms 9", "--budget-ms does not go together with --max-error"),
            ("--document --quick", "--quick does not go together with --document"),
            ("--scene glass --verify 3", "--scene does not go together with --verify"),
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
