//! Command line of `accuracy`.

use framegraph_passes::quality::Bound;
use framegraph_scene::builtin;
use program::clap::{self, Arg, ArgAction};
use program::cli::{self, Item, Parsed, flag, option};
use std::ffi::OsString;
use std::path::PathBuf;

const ABOUT: &str = "Measures the error and cost of each approximation of the frame on this adapter.";

const AFTER: &str = "\
Writes accuracy.json after each technique, so that an interrupted run can resume, then accuracy.md and accuracy.html.
Each option is timed in 31 frames after 10 warm-up frames. Times are valid for this adapter only, on an otherwise idle
machine.";

/// Options of which a run takes one.
const KINDS: [&str; 6] = ["budget-ms", "max-error", "verify", "document", "presets", "errors"];

/// Returns the declaration of all options.
fn command() -> clap::Command {
    let kind = |option: Arg| {
        let own = option.get_id().as_str().to_owned();
        let others = KINDS.into_iter().filter(move |kind| *kind != own);
        option.conflicts_with_all(others.chain(["quick", "technique", "scene", "again"]).collect::<Vec<_>>())
    };
    cli::command("accuracy", ABOUT, AFTER).args([
        flag(
            "quick",
            "Pictures of 96 × 64 pixels instead of 192 × 128, 11 timed frames after 3 warm-up frames",
        ),
        option(
            "technique",
            "NAME",
            "Measure only this technique again; can be repeated. `budget` measures options as parts of one frame",
        )
        .action(ArgAction::Append),
        option("scene", "NAME", "Use this built-in scene for all pictures, instead of a scene that shows the technique"),
        flag("again", "Measure everything again"),
        option("out", "DIR", "Output folder (target/accuracy)"),
        kind(option("budget-ms", "MS", "Print the most accurate settings within this time, by the record")),
        kind(option(
            "max-error",
            "X",
            "Print the fastest settings whose root mean square error is at most X 8-bit steps, by the record",
        )),
        kind(option(
            "verify",
            "N",
            "Choose settings for N random budgets, then draw and time them and each change of one option; fails if budgets \
             are missed",
        )),
        kind(flag("document", "Print accuracy.md from the existing accuracy.json")),
        kind(flag("errors", "Measure the errors of the options for budgets again, and keep their times in accuracy.json")),
        kind(option(
            "presets",
            "FILE.rs",
            "Write the presets chosen from the record as the source file that `framegraph-passes` is built with",
        )),
    ])
}

/// Action to perform.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// Print the help.
    Help(String),
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
    pub fn parse(words: impl IntoIterator<Item = OsString>) -> Result<Self, String> {
        let mut args = Self {
            wanted: Wanted::Measure,
            quick: false,
            again: false,
            techniques: Vec::new(),
            scene: None,
            out: PathBuf::from("target/accuracy"),
        };
        let given = match cli::parse(command(), words)? {
            Parsed::Help(text) => return Ok(Self { wanted: Wanted::Help(text), ..args }),
            Parsed::Given(given) => given,
        };
        for item in given {
            match item.name() {
                "quick" => args.quick = true,
                "again" => args.again = true,
                "technique" => args.techniques.push(item.text()?),
                "out" => args.out = item.raw().into(),
                "budget-ms" => args.wanted = Wanted::Budget(Bound::Ms(positive(&item)?)),
                "max-error" => args.wanted = Wanted::Budget(Bound::Codes(positive(&item)?)),
                "verify" => args.wanted = Wanted::Verify(item.parse("a whole number", |text| text.parse().ok())?),
                "scene" => args.scene = Some(item.parse(&builtin::NAMES.join(", "), scene)?),
                "document" => args.wanted = Wanted::Document,
                "errors" => args.wanted = Wanted::Errors,
                _ => args.wanted = Wanted::Presets(item.raw().into()),
            }
        }
        Ok(args)
    }
}

fn positive(item: &Item) -> Result<f64, String> {
    item.parse("a number of at least 0", |text| text.parse().ok().filter(|x: &f64| *x >= 0.0 && x.is_finite()))
}

fn scene(name: &str) -> Option<&'static str> {
    builtin::NAMES.into_iter().find(|known| *known == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_that_would_do_nothing_are_refused() {
        let parsed = |line: &str| Args::parse(line.split_whitespace().map(OsString::from));
        for (line, named) in [
            ("--document --presets a.rs", "cannot be used with"),
            ("--max-error 3 --budget-ms 9", "cannot be used with"),
            ("--document --quick", "cannot be used with"),
            ("--scene glass --verify 3", "cannot be used with"),
        ] {
            let told = parsed(line).map_err(|told| told.to_string());
            assert!(told.as_ref().is_err_and(|told| told.contains(named)), "{line}: {told:?}");
        }
        for line in
            ["--quick --technique budget --technique fog --again", "--verify 3 --out d", "--document --quick --help"]
        {
            assert!(parsed(line).is_ok(), "{line}");
        }
    }
}
