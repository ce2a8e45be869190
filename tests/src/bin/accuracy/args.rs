//! The command line of `accuracy`.

use lexopt::prelude::*;
use std::path::PathBuf;

/// What `--help` prints.
pub const HELP: &str = "\
Measures what each approximation of the frame errs by and costs on this adapter.

    accuracy [--quick] [--technique NAME]… [--again] [--out DIR]
    accuracy [--out DIR] --budget-ms MS | --max-error CODES | --document

Writes accuracy.json after each technique (an interrupted run goes on where it
was), then accuracy.md and accuracy.html. Times say something about this adapter
alone; nothing else should run beside it.

  --quick            small pictures, 9 repeats: some minutes
  --technique NAME   only this one, measured anew; may be given several times
  --again            measure all anew
  --out DIR          where to; target/accuracy without it
  --budget-ms MS     of what was measured, the most accurate set of options that
                     takes at most so much more than the fastest
  --max-error CODES  the fastest set whose errors add up to no more
  --document         print accuracy.md of the accuracy.json that is there
  -h, --help         print this
";

/// What to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// Print how it is called.
    Help,
    /// Measure.
    Measure,
    /// Print the document of the record.
    Document,
    /// Choose within a time.
    Budget(f64),
    /// Choose within an error.
    MostError(f64),
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
    /// Folder.
    pub out: PathBuf,
}

impl Args {
    /// From the command line.
    ///
    /// # Errors
    /// In a sentence.
    pub fn parse() -> Result<Self, lexopt::Error> {
        let mut args = Self {
            wanted: Wanted::Measure,
            quick: false,
            again: false,
            techniques: Vec::new(),
            out: PathBuf::from("target/accuracy"),
        };
        let mut parser = lexopt::Parser::from_env();
        while let Some(arg) = parser.next()? {
            match arg {
                Long("quick") => args.quick = true,
                Long("again") => args.again = true,
                Long("technique") => args.techniques.push(parser.value()?.string()?),
                Long("out") => args.out = parser.value()?.into(),
                Long("budget-ms") => args.wanted = Wanted::Budget(positive(&parser.value()?.string()?)?),
                Long("max-error") => args.wanted = Wanted::MostError(positive(&parser.value()?.string()?)?),
                Long("document") => args.wanted = Wanted::Document,
                Long("help") | Short('h') => args.wanted = Wanted::Help,
                other => return Err(other.unexpected()),
            }
        }
        Ok(args)
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| *x >= 0.0 && x.is_finite());
    number.ok_or_else(|| format!("{text:?} is no number from 0 on"))
}
