//! Command line of `prove`.

use program::clap;
use program::cli::{self, Parsed, flag, option};
use std::ffi::OsString;
use std::path::PathBuf;

/// Returns the declaration of all options.
fn command() -> clap::Command {
    cli::command("prove", "Verifies the compiler's claims and prints docs/measurements/proofs.md.", "").args([
        flag("quick", "Only the parts that take seconds and are machine-independent"),
        option("dsa", "DIR", "Folder of offset-assignment instances NAME.CAPACITY.csv").conflicts_with("quick"),
        option("out", "FILE", "Output file; default: standard output"),
    ])
}

/// Parsed command line.
#[derive(Debug, PartialEq, Eq)]
pub enum Command {
    /// Print the help.
    Help(String),
    /// Verify.
    Run(Args),
}

/// Parsed options.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Args {
    /// True to run only the parts that take seconds.
    pub quick: bool,
    /// Folder of the offset-assignment instances.
    pub dsa: Option<PathBuf>,
    /// Output file; standard output if `None`.
    pub out: Option<PathBuf>,
}

/// Parses the command line, without the program's name.
///
/// # Errors
/// One line that names the wrong option.
pub fn parse(words: impl Iterator<Item = OsString>) -> Result<Command, String> {
    let given = match cli::parse(command(), words)? {
        Parsed::Help(text) => return Ok(Command::Help(text)),
        Parsed::Given(given) => given,
    };
    let path = |name| given.values(name).next().map(PathBuf::from);
    let args = Args { quick: given.has("quick"), dsa: path("dsa"), out: path("out") };
    if let Some(folder) = args.dsa.as_deref().filter(|f| !f.is_dir()) {
        return Err(format!("--dsa: {}: no such folder", folder.display()));
    }
    Ok(Command::Run(args))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_and_mistakes_named() {
        let read = |line: &str| parse(line.split_whitespace().map(OsString::from));
        let expected = Args { quick: false, dsa: Some("src".into()), out: Some("b".into()) };
        assert_eq!(read("--dsa src --out b"), Ok(Command::Run(expected)));
        assert!(matches!(read("--quick --help"), Ok(Command::Help(_))));
        for (line, named) in
            [("--fast", "--fast"), ("--dsa", "--dsa"), ("--quick --dsa a", "--quick"), ("--dsa nowhere", "nowhere")]
        {
            assert!(read(line).is_err_and(|error| error.contains(named)), "{line}");
        }
    }
}
