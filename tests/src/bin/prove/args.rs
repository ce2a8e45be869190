//! The command line.

use std::path::PathBuf;

/// What `--help` prints.
pub const HELP: &str = "\
Prints docs/proofs.md: what the compiler claims, with the figures that prove it.

usage: prove [--quick] [--dsa DIR] [--out FILE]

  --quick    only what takes seconds and is the same on every machine
  --dsa DIR  offset-assignment instances NAME.CAPACITY.csv; skipped when not given
  --out FILE where to write; default: standard output
";

/// What was asked for.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Args {
    /// Only what takes seconds.
    pub quick: bool,
    /// The instances.
    pub dsa: Option<PathBuf>,
    /// Where to write.
    pub out: Option<PathBuf>,
}

/// Reads the command line; none when help is asked for.
///
/// # Errors
/// One line that names the option.
pub fn parse(words: impl Iterator<Item = String>) -> Result<Option<Args>, String> {
    let mut args = Args::default();
    let mut words = words;
    while let Some(word) = words.next() {
        let mut value = || words.next().map(PathBuf::from).ok_or_else(|| format!("{word} needs a value; see --help"));
        match word.as_str() {
            "--help" => return Ok(None),
            "--quick" => args.quick = true,
            "--dsa" => args.dsa = Some(value()?),
            "--out" => args.out = Some(value()?),
            _ => return Err(format!("there is no option `{word}`; see --help")),
        }
    }
    if args.quick && args.dsa.is_some() {
        return Err("--dsa takes longer than --quick allows; give one of them".into());
    }
    if let Some(folder) = args.dsa.as_deref().filter(|f| !f.is_dir()) {
        return Err(format!("--dsa: there is no folder {}", folder.display()));
    }
    Ok(Some(args))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_and_mistakes_named() {
        let read = |line: &str| parse(line.split_whitespace().map(str::to_owned));
        let expected = Args { quick: false, dsa: Some("src".into()), out: Some("b".into()) };
        assert_eq!(read("--dsa src --out b"), Ok(Some(expected)));
        assert_eq!(read("--quick --help"), Ok(None));
        for (line, named) in
            [("--fast", "--fast"), ("--dsa", "--dsa"), ("--quick --dsa a", "--quick"), ("--dsa nowhere", "nowhere")]
        {
            assert!(read(line).is_err_and(|error| error.contains(named)), "{line}");
        }
    }
}
