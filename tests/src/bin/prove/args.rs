//! Command line of `prove`.

use std::path::PathBuf;

/// Text of `--help`.
pub const HELP: &str = "\
Verifies the compiler's claims and prints docs/measurements/proofs.md.

usage: prove [--quick] [--dsa DIR] [--out FILE]

  --quick    only the parts that take seconds and are machine-independent
  --dsa DIR  folder of offset-assignment instances NAME.CAPACITY.csv
  --out FILE output file; default: standard output
";

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

/// Parses the command line; returns `None` if help is requested.
///
/// # Errors
/// One line that names the wrong option.
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
            _ => return Err(format!("unknown option `{word}`; see --help")),
        }
    }
    if args.quick && args.dsa.is_some() {
        return Err("--dsa cannot be combined with --quick, which skips long runs".into());
    }
    if let Some(folder) = args.dsa.as_deref().filter(|f| !f.is_dir()) {
        return Err(format!("--dsa: {}: no such folder", folder.display()));
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
